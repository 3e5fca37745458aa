//! Motions made piece by piece.

use burn::tensor::Tensor;

use super::{GenerateRequest, Mdm, generate};
use crate::Error;
use crate::diffusion::Sampler;
use crate::tensors::{numbers, tensor};

/// Makes motions of any length by a network that plans: each piece goes on from the last frames of what
/// there is. For each motion its normalised features `[frames][columns]`, flat, without the `context`
/// that the first piece goes on from, `[batch][context][columns]`, normalised.
///
/// `observe` is told the number of steps that are left of all pieces. Cost: that of [`generate`] for
/// every piece. CLoSD's models are guided by 7.5.
///
/// # Errors
/// Those of [`generate`]; [`Error::Input`] for networks that make whole motions, for a context of
/// another shape, and for requests with an edit or a context of their own.
pub fn plan_motions(
    network: &Mdm,
    sampler: &Sampler,
    request: GenerateRequest<'_>,
    context: &Tensor<3>,
    mut observe: impl FnMut(usize),
) -> Result<Vec<Vec<f32>>, Error> {
    let config = network.config();
    let Some(planner) = config.planner else {
        let found = "one that makes whole motions";
        return Err(Error::input("Network", "one that plans", found));
    };
    if request.edit.is_some() || request.context.is_some() {
        let found = "one for a piece";
        return Err(Error::input("Request", "no edit and no context", found));
    }
    let shape = [request.lengths.len(), planner.context, config.columns];
    if context.dims() != shape {
        let found = format!("{:?}", context.dims());
        return Err(Error::input("Context", format!("{shape:?}"), found));
    }
    let in_front = planner.context * config.columns;
    let device = context.device();
    // Each motion with its context in front.
    let motions = numbers(context.clone())?;
    let motions = motions.chunks_exact(in_front).map(<[f32]>::to_vec);
    let mut motions: Vec<Vec<f32>> = motions.collect();
    let longest = request.lengths.iter().copied().max().unwrap_or(0);
    let pieces = longest.div_ceil(planner.prediction);
    let lengths = vec![planner.prediction; motions.len()];
    for piece in 0..pieces {
        let last = motions
            .iter()
            .flat_map(|motion| &motion[motion.len() - in_front..]);
        let context = tensor(last.copied().collect(), shape, &device);
        let seeds: Vec<u64> = request
            .seeds
            .iter()
            .map(|&seed| of_piece(seed, piece))
            .collect();
        let request = GenerateRequest {
            lengths: &lengths,
            seeds: &seeds,
            context: Some(&context),
            ..request
        };
        let later = (pieces - piece - 1) * sampler.schedule().len();
        let made = generate(network, sampler, request, |left| observe(later + left))?;
        for (motion, made) in motions.iter_mut().zip(made) {
            motion.extend(made);
        }
    }
    for (motion, &length) in motions.iter_mut().zip(request.lengths) {
        motion.drain(..in_front);
        motion.truncate(length * config.columns);
    }
    Ok(motions)
}

/// Every piece has noise of its own; the first that of its motion.
const fn of_piece(seed: u64, piece: usize) -> u64 {
    seed ^ (piece as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
}
