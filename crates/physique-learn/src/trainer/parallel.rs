//! A step on several devices: each differentiates a part of the batch, gradients are averaged.

use std::ops::Range;
use std::thread;

use burn::module::Module;
use burn::tensor::Device;

use super::Task;
use super::gradient::NamedGradients;
use super::run::scalar;
use crate::Error;

/// A part of a step's batch, for one of several devices. All parts have as many motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Which one.
    pub index: usize,
    /// How many there are.
    pub of: usize,
}

impl Part {
    /// All of the batch.
    pub const WHOLE: Self = Self { index: 0, of: 1 };

    /// The motions of a batch that belong to the part.
    ///
    /// # Errors
    /// [`Error::Setting`] for a batch that cannot be shared evenly.
    pub fn range(self, batch: usize) -> Result<Range<usize>, Error> {
        if self.of == 0 || batch == 0 || !batch.is_multiple_of(self.of) {
            let expected = format!("a multiple of {}, the number of devices", self.of);
            return Err(Error::setting("batch", expected, batch));
        }
        let share = batch / self.of;
        Ok(self.index * share..(self.index + 1) * share)
    }
}

/// The loss of a step and the gradients by the network's parameters.
pub(super) struct Differentiated {
    pub(super) loss: f64,
    pub(super) parts: Vec<(&'static str, f64)>,
    pub(super) gradients: NamedGradients,
}

/// Differentiates a step: on the network's own device, or on all of `devices` at once, in which
/// case loss and gradients are means over them, added up in their order.
pub(super) fn differentiate<T: Task>(
    task: &T,
    network: &T::Network,
    devices: &[Device],
    seed: u64,
    step: u64,
) -> Result<Differentiated, Error> {
    if devices.is_empty() {
        return part(task, network, seed, step, Part::WHOLE);
    }
    let of = devices.len();
    let found: Vec<Result<Differentiated, Error>> = thread::scope(|scope| {
        let running = devices.iter().enumerate().map(|(index, device)| {
            let network = network.clone().fork(device);
            let share = Part { index, of };
            scope.spawn(move || part(task, &network, seed, step, share))
        });
        // All are started before the first is waited for.
        let running: Vec<_> = running.collect();
        let ended = running.into_iter().map(|thread| thread.join());
        let ended = ended.map(|ended| {
            ended.unwrap_or_else(|_| {
                let problem = "its thread ended early".to_owned();
                Err(Error::Device { problem })
            })
        });
        ended.collect()
    });
    let home = network.devices().into_iter().next();
    let home = home.unwrap_or_else(crate::device);
    let mut sum: Option<Differentiated> = None;
    for found in found {
        let found = found?;
        let gradients = found.gradients.on_device(&home);
        sum = Some(match sum {
            None => Differentiated { gradients, ..found },
            Some(sum) => Differentiated {
                loss: sum.loss + found.loss,
                parts: added(sum.parts, &found.parts),
                gradients: sum.gradients.added(gradients),
            },
        });
    }
    let sum = sum.ok_or_else(|| Error::setting("devices", "1 or more", 0))?;
    let share = 1.0 / of as f64;
    let parts = sum.parts.into_iter();
    Ok(Differentiated {
        loss: sum.loss * share,
        parts: parts.map(|(name, part)| (name, part * share)).collect(),
        gradients: sum.gradients.scaled(share),
    })
}

fn part<T: Task>(
    task: &T,
    network: &T::Network,
    seed: u64,
    step: u64,
    part: Part,
) -> Result<Differentiated, Error> {
    let loss = task.part(network, seed, step, part)?;
    let parts = loss.parts.into_iter();
    let parts = parts.map(|(name, part)| Ok((name, scalar(part)?)));
    Ok(Differentiated {
        parts: parts.collect::<Result<_, Error>>()?,
        loss: scalar(loss.total.clone())?,
        gradients: NamedGradients::of(network, loss.total.backward()),
    })
}

fn added(
    mut sum: Vec<(&'static str, f64)>,
    parts: &[(&'static str, f64)],
) -> Vec<(&'static str, f64)> {
    for ((_, sum), (_, part)) in sum.iter_mut().zip(parts) {
        *sum += part;
    }
    sum
}
