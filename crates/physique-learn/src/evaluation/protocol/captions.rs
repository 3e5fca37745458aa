//! Captions as points, each embedded once.

use std::cell::RefCell;
use std::collections::HashMap;

use physique_data::{Dataset, Split};

use crate::Error;
use crate::evaluation::{CaptionReading, PairEvaluator, Points};

/// Captions that are embedded at once.
const TOGETHER: usize = 32;

/// Embeds the captions of a split as they are asked for.
///
/// Captions are embedded in groups that do not depend on what is asked for: their points are the
/// same to the bit, whichever repetitions are made.
#[derive(Debug)]
pub(super) struct CaptionPoints {
    /// Numbers of captions, sorted.
    captions: Vec<usize>,
    known: RefCell<HashMap<(usize, bool), Points>>,
}

impl CaptionPoints {
    pub(super) fn new(dataset: &Dataset, split: Split) -> Self {
        let index = dataset.index();
        let mut captions: Vec<usize> = dataset
            .clips_of(split)
            .flat_map(|clip| &index.caption_sets[index.clips[clip].captions].training)
            .copied()
            .collect();
        captions.sort_unstable();
        captions.dedup();
        Self {
            captions,
            known: RefCell::default(),
        }
    }

    /// Points of captions.
    ///
    /// # Errors
    /// Those of the evaluator; [`Error::Input`] for a caption of another split.
    pub(super) fn points(
        &self,
        dataset: &Dataset,
        evaluator: &dyn PairEvaluator,
        captions: impl Iterator<Item = usize>,
        reading: CaptionReading,
    ) -> Result<Points, Error> {
        let (mut values, mut width) = (Vec::new(), 1);
        let mut known = self.known.borrow_mut();
        for caption in captions {
            let Ok(place) = self.captions.binary_search(&caption) else {
                return Err(Error::input("Caption", "one of the split", caption));
            };
            let group = (place / TOGETHER, reading == CaptionReading::WithPadding);
            let points = match known.entry(group) {
                std::collections::hash_map::Entry::Occupied(points) => points.into_mut(),
                std::collections::hash_map::Entry::Vacant(vacant) => {
                    let numbers = self.captions.chunks(TOGETHER).nth(group.0);
                    let texts: Vec<_> = numbers
                        .unwrap_or_default()
                        .iter()
                        .map(|&caption| &dataset.index().captions[caption])
                        .collect();
                    vacant.insert(evaluator.embed_captions(&texts, reading)?)
                }
            };
            width = points.width();
            values.extend_from_slice(points.point(place % TOGETHER));
        }
        Points::new(width, values)
    }
}
