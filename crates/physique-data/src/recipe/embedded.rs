//! Recipes of public archives. They hold our own words only; users bring the recordings.

use super::Recipe;
use crate::Error;

/// A recipe that comes with the crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmbeddedRecipe {
    /// Its name, which commands take in place of a file.
    pub name: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// Its text, to start an own one from.
    pub text: &'static str,
}

impl EmbeddedRecipe {
    /// All of them.
    pub const ALL: [Self; 3] = [
        Self {
            name: "bandai-namco",
            about: "Bandai-Namco-Research-Motiondataset 1 and 2 (CC BY-NC 4.0)",
            text: include_str!("../../recipes/bandai-namco.toml"),
        },
        Self {
            name: "100style",
            about: "100STYLE (CC BY 4.0)",
            text: include_str!("../../recipes/100style.toml"),
        },
        Self {
            name: "cmu",
            about: "CMU: subjects 1 to 7 as iClone BVH and as ASF/AMC, and three dances",
            text: include_str!("../../recipes/cmu.toml"),
        },
    ];

    /// The one of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|recipe| recipe.name == name)
    }

    /// The recipe.
    ///
    /// # Errors
    /// None that a test has not ruled out; the type is [`Recipe::parse`]'s.
    pub fn recipe(&self) -> Result<Recipe, Error> {
        Recipe::parse(self.text, self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::EmbeddedRecipe;

    #[test]
    fn all_embedded_recipes_are_recipes() {
        for embedded in EmbeddedRecipe::ALL {
            let recipe = embedded.recipe().unwrap();
            assert_eq!(recipe.name, embedded.name);
            assert!(!recipe.captions.is_empty());
        }
    }
}
