//! `physique data`: motions with captions as one file to learn from.

pub(crate) mod arguments;
mod build;
mod join;
mod show;
mod table;

use anyhow::{Result, bail};
use physique_data::recipe::embedded::EmbeddedRecipe;

use crate::exit::Exit;
use crate::text_table::{Column, render};
use arguments::DataVerb;

pub(crate) fn run(verb: &DataVerb) -> Result<Exit> {
    match verb {
        DataVerb::Build(arguments) => build::run(arguments),
        DataVerb::Join(arguments) => join::run(arguments),
        DataVerb::Show(arguments) => show::run(arguments),
        DataVerb::Recipe { name } => recipe(name.as_deref()),
    }
}

/// Prints an embedded recipe, or which there are.
fn recipe(name: Option<&str>) -> Result<Exit> {
    let Some(name) = name else {
        let columns = [Column::words(&["recipe"]), Column::words(&["for"])];
        let recipes = EmbeddedRecipe::ALL.into_iter();
        let mut rows: Vec<Vec<String>> = recipes
            .map(|recipe| vec![recipe.name.to_owned(), recipe.about.to_owned()])
            .collect();
        let published = [
            (
                "humanml3d",
                "a HumanML3D folder: new_joint_vecs, texts and lists",
            ),
            ("kit", "a KIT-ML folder: new_joint_vecs, texts and lists"),
        ];
        rows.extend(published.map(|(name, about)| vec![name.to_owned(), about.to_owned()]));
        print!("{}", render(&columns, &rows));
        return Ok(Exit::Done);
    };
    let Some(recipe) = EmbeddedRecipe::named(name) else {
        bail!("no recipe is called {name:?}; `physique data recipe` lists them");
    };
    print!("{}", recipe.text);
    Ok(Exit::Done)
}
