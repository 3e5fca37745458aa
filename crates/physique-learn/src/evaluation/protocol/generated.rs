//! Rows of generated motions.

use physique_motion::features::MotionFeatures;

use super::draw::{Draw, Pair};
use super::measures::Embedded;
use super::{EvaluationProtocol, PURPOSE, RepetitionMeasures};
use crate::Error;
use crate::evaluation::generator::cut;
use crate::evaluation::{
    CaptionReading, MotionGenerator, Points, Prompt, RETRIEVAL_BATCH, multimodality,
};
use crate::random::Random;

impl EvaluationProtocol<'_> {
    /// A repetition of a generated row; `observe` is told how many motions were generated since the
    /// last time.
    ///
    /// # Errors
    /// [`Error::Input`] for a generator of another skeleton, or one that gives motions shorter than
    /// asked for; those of data set, evaluator and generator.
    pub fn generated(
        &self,
        generator: &dyn MotionGenerator,
        repetition: usize,
        observe: &mut dyn FnMut(usize),
    ) -> Result<RepetitionMeasures, Error> {
        let pairs = self
            .draws
            .pairs(repetition, Draw::Prompts, self.generated_batches())?;
        let batches: Vec<&[Pair]> = pairs.chunks(RETRIEVAL_BATCH).collect();
        let mut random = self.numpy_random(repetition);
        let repeated = self.options.multimodality;
        let repeated = repeated.filter(|of| repetition < of.repetitions);
        let chosen = repeated.map_or_else(Vec::new, |of| {
            random.choice(batches.len(), of.batches.min(batches.len()))
        });
        let (mut points, mut by_caption, mut crossed) = (Vec::new(), Vec::new(), Vec::new());
        for (batch, pairs) in batches.iter().enumerate() {
            let times = match repeated {
                Some(of) if chosen.contains(&batch) => of.motions,
                _ => 1,
            };
            let mut of_captions = vec![Vec::new(); pairs.len()];
            for time in 0..times {
                let prompts = self.prompts(pairs, [repetition, batch, time]);
                let motions = self.generate(generator, &prompts)?;
                observe(prompts.len());
                let embedded = self.generated_points(&prompts, &motions)?;
                for (of_caption, point) in of_captions.iter_mut().zip(embedded.iter()) {
                    of_caption.extend_from_slice(point);
                }
                // The first motion of a caption is the one that all else is measured on.
                if time == 0 {
                    points.extend_from_slice(embedded.values());
                    if let Some(meter) = self.meter {
                        let motions = prompts.iter().zip(&motions);
                        let motions = motions.map(|(prompt, motion)| cut(motion, prompt.frames));
                        crossed.push(meter.mean(&motions.collect::<Result<Vec<_>, _>>()?)?);
                    }
                }
            }
            if times > 1 {
                by_caption.extend(of_captions);
            }
        }
        let reading = match self.options.caption_length_bug {
            true => CaptionReading::WithPadding,
            false => CaptionReading::Whole,
        };
        let captions = self.caption_points(&pairs, reading)?;
        let motions = Points::new(captions.width(), points)?;
        let width = motions.width();
        let row = Embedded { captions, motions };
        let reference = self.reference(repetition)?;
        let mut measures = row.measure(
            repetition,
            &reference,
            self.options.diversity_pairs,
            &mut random,
        )?;
        if let Some(of) = repeated {
            let by_caption = by_caption.into_iter();
            let by_caption = by_caption.map(|motions| Points::new(width, motions));
            let by_caption = by_caption.collect::<Result<Vec<_>, _>>()?;
            measures.multimodality = Some(multimodality(&by_caption, of.pairs, &mut random)?);
        }
        if !crossed.is_empty() {
            let mean = crossed.iter().sum::<f64>() / crossed.len() as f64;
            measures.self_intersection_cm3 = Some(mean);
        }
        Ok(measures)
    }

    fn prompts(&self, pairs: &[Pair], path: [usize; 3]) -> Vec<Prompt> {
        let path = path.map(|number| number as u64);
        let prompts = pairs.iter().enumerate().map(|(place, pair)| {
            let path = [self.options.seed, PURPOSE, path[0], 4, path[1], path[2]];
            let seed = Random::new(&[&path[..], &[place as u64]].concat()).bits();
            Prompt {
                caption: self.dataset.index().captions[pair.caption].clone(),
                frames: pair.window.frames,
                seed,
            }
        });
        prompts.collect()
    }

    /// Motions, checked.
    fn generate(
        &self,
        generator: &dyn MotionGenerator,
        prompts: &[Prompt],
    ) -> Result<Vec<MotionFeatures>, Error> {
        let motions = generator.generate(prompts)?;
        if motions.len() != prompts.len() {
            let expected = format!("{}, one a prompt", prompts.len());
            return Err(Error::input("Generated motions", expected, motions.len()));
        }
        for (motion, prompt) in motions.iter().zip(prompts) {
            let (skeleton, found) = (motion.skeleton(), motion.frame_count());
            if skeleton != self.dataset.skeleton() || found < prompt.frames {
                let expected = format!("{:?}, {} frames", self.dataset.skeleton(), prompt.frames);
                let found = format!("{skeleton:?}, {found} frames");
                return Err(Error::input("Generated motion", expected, found));
            }
        }
        Ok(motions)
    }

    fn generated_points(
        &self,
        prompts: &[Prompt],
        motions: &[MotionFeatures],
    ) -> Result<Points, Error> {
        let rows = motions.iter();
        let rows = rows.flat_map(|motion| self.padded(motion.values().to_vec()));
        let rows: Vec<f32> = rows.collect();
        let lengths: Vec<usize> = prompts.iter().map(|prompt| prompt.frames).collect();
        self.evaluator.embed_motions(&rows, self.frames(), &lengths)
    }
}
