//! What legs do, and what trunk and arms do meanwhile.

use physique_learn::mdm::TextToMotion;
use physique_text::BodyPartTexts;

use super::arguments::GenerateArguments;

/// What a motion is to show.
pub(crate) struct Parts {
    /// All of it, or path and legs.
    pub(crate) text: String,
    /// Trunk and arms, where they do something else.
    pub(crate) upper_body: Option<String>,
}

impl Parts {
    /// A text that may tell two things at once.
    pub(crate) fn divided(text: &str) -> Self {
        match BodyPartTexts::of(text) {
            Some(parts) => Self {
                text: parts.legs,
                upper_body: Some(parts.upper_body),
            },
            None => Self {
                text: text.to_owned(),
                upper_body: None,
            },
        }
    }
}

/// What a text of the flags asks for. Tells where it was divided, and where it is about something that
/// the network was not trained with.
pub(super) fn of(text: &str, arguments: &GenerateArguments, network: &TextToMotion) -> Parts {
    // What is kept of a motion divides the body already, and planners go on with all of it.
    let given = arguments.edit.from.is_some() || arguments.edit.after.is_some();
    let undivided = arguments.undivided || given;
    let parts = match &arguments.upper_body {
        None if !undivided => Parts::divided(text),
        upper_body => Parts {
            text: text.to_owned(),
            upper_body: upper_body.clone(),
        },
    };
    if let (Some(upper_body), None) = (&parts.upper_body, &arguments.upper_body) {
        eprintln!(
            "note: two things at once: legs as {:?}, trunk and arms as {upper_body:?} (--undivided takes the text as \
             it stands)",
            parts.text
        );
    }
    for text in [Some(&parts.text), parts.upper_body.as_ref()]
        .into_iter()
        .flatten()
    {
        if let Some(nearest) = network.nearest(text).filter(|nearest| nearest.unusual) {
            eprintln!(
                "note: {text:?} is unlike what the network was trained with (distance {:.2}); nearest is {:?}",
                nearest.distance, nearest.text
            );
        }
    }
    parts
}
