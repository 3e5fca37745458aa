//! Conditions on measures, for gates in continuous integration.

use std::str::FromStr;

use crate::measures::{measure_names, measures};
use crate::{Error, Group, MotionScore, Protocol};

/// A condition such as `self_intersection_mean_cm3>20 or self_intersection_worst_cm3>300`.
///
/// Comparisons (`<`, `<=`, `>`, `>=`) of a measure with a number, joined by `and` and `or`; `and`
/// binds tighter.
///
/// ```
/// use physique::Condition;
///
/// let condition: Condition = "self_intersection_mean_cm3 > 20".parse()?;
/// assert!("self_intersection>20".parse::<Condition>().is_err());
/// # Ok::<(), physique::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Any of these, each all of those.
    alternatives: Vec<Vec<Comparison>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Comparison {
    measure: String,
    operator: Operator,
    number: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// Longer operators first, so that `<=` is not read as `<`.
const OPERATORS: [(&str, Operator); 4] = [
    ("<=", Operator::LessOrEqual),
    (">=", Operator::GreaterOrEqual),
    ("<", Operator::Less),
    (">", Operator::Greater),
];

impl Condition {
    /// Whether the score meets the condition; `None` when it lacks a measure that decides.
    pub fn holds(&self, score: &MotionScore) -> Option<bool> {
        let measures = measures(score);
        let compare = |comparison: &Comparison| {
            let &(_, value) = measures
                .iter()
                .find(|(name, _)| *name == comparison.measure)?;
            Some(match comparison.operator {
                Operator::Less => value < comparison.number,
                Operator::LessOrEqual => value <= comparison.number,
                Operator::Greater => value > comparison.number,
                Operator::GreaterOrEqual => value >= comparison.number,
            })
        };
        let mut any = false;
        for alternative in &self.alternatives {
            let mut all = true;
            for comparison in alternative {
                all &= compare(comparison)?;
            }
            any |= all;
        }
        Some(any)
    }
}

impl FromStr for Condition {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let alternatives = text.split(" or ").map(|alternative| {
            alternative
                .split(" and ")
                .map(|comparison| {
                    parse_comparison(comparison).map_err(|found| Error::Condition {
                        condition: text.to_owned(),
                        found,
                    })
                })
                .collect::<Result<Vec<_>, _>>()
        });
        Ok(Self {
            alternatives: alternatives.collect::<Result<_, _>>()?,
        })
    }
}

fn parse_comparison(text: &str) -> Result<Comparison, String> {
    let (name, operator, number) = OPERATORS
        .into_iter()
        .find_map(|(symbol, operator)| {
            let (name, number) = text.split_once(symbol)?;
            Some((name.trim(), operator, number.trim()))
        })
        .ok_or_else(|| format!("no comparison in `{}`", text.trim()))?;
    let known = measure_names(&Protocol::ALL, &Group::ALL);
    let measure = known.iter().find(|&known| known == name).ok_or_else(|| {
        format!(
            "the unknown measure `{name}`; known are {}",
            known.join(", ")
        )
    })?;
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(Comparison {
            measure: measure.to_string(),
            operator,
            number,
        }),
        _ => Err(format!("`{number}`, which is not a number")),
    }
}

#[cfg(test)]
mod tests {
    use physique_motion::FrameRate;

    use super::*;

    fn score(frames: usize, duration_s: f64) -> MotionScore {
        let frame_rate = FrameRate::new(frames as f64 / duration_s).unwrap();
        MotionScore::unmeasured(frames, frame_rate)
    }

    fn holds(condition: &str, score: &MotionScore) -> Option<bool> {
        condition.parse::<Condition>().unwrap().holds(score)
    }

    #[test]
    fn compares_measures_with_numbers() {
        let score = score(10, 2.5);
        assert_eq!(holds("frames>10", &score), Some(false));
        assert_eq!(holds("frames >= 10", &score), Some(true));
        assert_eq!(holds("frames<=10 and duration_s<2.5", &score), Some(false));
        assert_eq!(
            holds("duration_s<2 or duration_s>2 and frames<11", &score),
            Some(true)
        );
    }

    #[test]
    fn what_was_not_measured_decides_nothing() {
        assert_eq!(holds("self_intersection_mean_cm3<1", &score(1, 1.0)), None);
    }

    #[test]
    fn nonsense_is_refused_with_a_reason() {
        for (text, reason) in [
            ("", "no comparison"),
            ("frames", "no comparison"),
            ("volume>3", "unknown measure"),
            ("frames>many", "not a number"),
            ("frames>NaN", "not a number"),
            ("frames>3 or", "not a number"),
        ] {
            let error = text.parse::<Condition>().unwrap_err().to_string();
            assert!(error.contains(reason), "{text}: {error}");
        }
    }
}
