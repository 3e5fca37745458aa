//! Sampling motions from a network.

use burn::tensor::Tensor;

use super::{Condition, Mdm, MdmQuery};
use crate::Error;
use crate::diffusion::{BatchEdit, NoiseStreams, Sampler, descend, guide};
use crate::layers::Dropout;
use crate::motion_loss::WeightedLoss;
use crate::tensors::numbers;

/// A batch of motions to be.
#[derive(Clone, Copy, Debug)]
pub struct GenerateRequest<'a> {
    /// What they are to be.
    pub condition: &'a Condition,
    /// Frames of each.
    pub lengths: &'a [usize],
    /// A seed for each; the same seed and condition give the same motion.
    pub seeds: &'a [u64],
    /// Scale of classifier-free guidance: 2.5 as published, 1 for networks without captions.
    pub guidance: f64,
    /// What is known of them, as many frames as the longest has; see
    /// [`Edit`](crate::diffusion::Edit).
    pub edit: Option<&'a BatchEdit>,
    /// Losses that the motions are moved against while they are made, see
    /// [`GuideWeights`](crate::diffusion::GuideWeights): the more, the less noise is left. None
    /// changes nothing, on any network.
    pub guides: &'a [WeightedLoss],
    /// Clean frames that they go on from, normalised, `[batch][context][columns]`; planners only, which
    /// make a piece: see [`plan_motions`](super::plan_motions).
    pub context: Option<&'a Tensor<3>>,
}

/// Generates a batch of motions: for each its normalised features `[frames][columns]`, flat.
///
/// All are sampled with the frames of the longest, rounded up to whole tokens of the network, and
/// cut to their own. `observe` is told the number of steps that are left. Cost: a forward pass a
/// step, two with guidance.
///
/// # Errors
/// [`Error::Input`] when counts disagree or the condition does not fit the network; those of the
/// guides.
pub fn generate(
    network: &Mdm,
    sampler: &Sampler,
    request: GenerateRequest<'_>,
    observe: impl FnMut(usize),
) -> Result<Vec<Vec<f32>>, Error> {
    let columns = network.config().columns;
    let mut motions = generate_whole(network, sampler, request, 0, observe)?;
    for (motion, length) in motions.iter_mut().zip(request.lengths) {
        motion.truncate(length * columns);
    }
    Ok(motions)
}

/// As [`generate`], with at least so many frames, and with what lies behind each motion's length: the
/// published evaluation samples those of the data set's longest window, and sees some of them.
///
/// # Errors
/// As [`generate`].
pub fn generate_whole(
    network: &Mdm,
    sampler: &Sampler,
    request: GenerateRequest<'_>,
    frames: usize,
    mut observe: impl FnMut(usize),
) -> Result<Vec<Vec<f32>>, Error> {
    let GenerateRequest {
        condition,
        lengths,
        seeds,
        guidance,
        edit,
        guides,
        context,
    } = request;
    if seeds.len() != lengths.len() || lengths.is_empty() {
        let expected = format!("{}, one a motion", lengths.len().max(1));
        return Err(Error::input("Seeds", expected, seeds.len()));
    }
    let config = network.config();
    let longest = lengths.iter().copied().max().unwrap_or(0);
    let frames = longest.max(frames);
    let frames = frames.next_multiple_of(config.frames_per_token);
    let columns = config.columns;
    let noise = NoiseStreams::new(seeds, frames, columns, &network.device());
    let unconditioned = vec![false; lengths.len()];
    let mut left = sampler.schedule().len();
    let motions = sampler.sample(&noise, |noisy, step| {
        let steps = vec![step; lengths.len()];
        let clean = guide(guidance, |conditioned| {
            let query = MdmQuery {
                noisy: noisy.clone(),
                steps: &steps,
                condition,
                conditioned: (!conditioned).then_some(unconditioned.as_slice()),
                lengths: Some(lengths),
                context: context.cloned(),
            };
            network.forward(query, &Dropout::none())
        })?;
        left -= 1;
        observe(left);
        let edited = |clean: Tensor<3>| match edit {
            Some(edit) => edit.apply(clean),
            None => clean,
        };
        let clean = edited(clean);
        if guides.is_empty() {
            return Ok(clean);
        }
        // What is guessed from noise is not worth moving.
        let strength = sampler.schedule().kept()[left];
        Ok(edited(descend(clean, lengths, guides, strength, edit)?))
    })?;
    let motions = numbers(motions)?;
    let motions = motions.chunks_exact((frames * columns).max(1));
    Ok(motions.map(<[f32]>::to_vec).collect())
}
