//! Caption files.

use std::path::Path;

use physique_files::read_file;

use crate::{Caption, DataLimits, Error};

/// A caption, and the seconds it is about where it is not about the whole clip.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) caption: Caption,
    pub(super) span: Option<(f64, f64)>,
}

pub(super) fn read(path: &Path, limits: &DataLimits) -> Result<String, Error> {
    let bytes = read_file(path, limits.text_bytes)?;
    String::from_utf8(bytes).map_err(|problem| Error::Table {
        path: path.into(),
        place: format!("byte {}", problem.utf8_error().valid_up_to()),
        expected: "UTF-8",
        found: "other bytes".into(),
    })
}

/// The captions of a file; place, expectation and finding where it is broken.
pub(super) fn lines(content: &str) -> Result<Vec<Line>, String> {
    let lines = content.lines().enumerate();
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(number, text)| {
            line(text.trim()).map_err(|found| {
                format!(
                    "line {}: expected caption#words#from#to, found {found}",
                    number + 1
                )
            })
        })
        .collect()
}

fn line(text: &str) -> Result<Line, String> {
    let mut fields = text.split('#');
    let (caption, tokens, from, to) =
        match (fields.next(), fields.next(), fields.next(), fields.next()) {
            (Some(caption), Some(tokens), Some(from), Some(to)) => (caption, tokens, from, to),
            _ => return Err(format!("{} fields", text.split('#').count())),
        };
    // `nan` is how the data set says that there is no time; as published, it counts as 0.
    let seconds = |field: &str| match field.trim().parse::<f64>() {
        Ok(seconds) if seconds.is_nan() => Ok(0.0),
        Ok(seconds) if (0.0..1e6).contains(&seconds) => Ok(seconds),
        _ => Err(format!("the time {field:?}")),
    };
    let (from, to) = (seconds(from)?, seconds(to)?);
    Ok(Line {
        caption: Caption {
            text: caption.trim().to_owned(),
            tokens: Some(tokens.trim().to_owned()),
        },
        span: (from != 0.0 || to != 0.0).then_some((from, to)),
    })
}

#[cfg(test)]
mod tests {
    use super::lines;

    #[test]
    fn lines_are_captions_of_the_whole_or_of_a_part() {
        let content = "a man walks.#a/DET man/NOUN walk/VERB#0.0#0.0\n\
                       he turns#he/PRON turn/VERB#nan#nan\nit stops#it/PRON stop/VERB#1.5#4.0\n";
        let found = lines(content).unwrap();
        let spans: Vec<_> = found.iter().map(|line| line.span).collect();
        assert_eq!(spans, [None, None, Some((1.5, 4.0))]);
        assert_eq!(found[0].caption.text, "a man walks.");
        assert_eq!(
            found[2].caption.tokens.as_deref(),
            Some("it/PRON stop/VERB")
        );
    }

    #[test]
    fn broken_lines_are_told() {
        for (content, told) in [
            (
                "a man walks",
                "line 1: expected caption#words#from#to, found 1 fields",
            ),
            (
                "a#b#0#0\na#b#x#0",
                "line 2: expected caption#words#from#to, found the time \"x\"",
            ),
            (
                "a#b#0#-1",
                "line 1: expected caption#words#from#to, found the time \"-1\"",
            ),
        ] {
            assert_eq!(lines(content).unwrap_err(), told);
        }
    }
}
