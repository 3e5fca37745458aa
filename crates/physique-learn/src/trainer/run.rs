//! The loop.

use std::path::{Path, PathBuf};
use std::time::Instant;

use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::gradient::{tensors_of, update};
use super::log::RunLog;
use super::parallel::{Part, differentiate};
use super::{AdamW, TrainerConfig, state};
use crate::Error;
use crate::tensors::numbers;

/// What a trainer trains.
pub trait Task: Sync {
    /// The network.
    type Network: Module;

    /// The loss of a step. It depends on its arguments only.
    ///
    /// # Errors
    /// Those of data and network.
    fn loss(&self, network: &Self::Network, seed: u64, step: u64) -> Result<Loss, Error>;

    /// The loss of a part of the step's batch, for a network on one of several devices: the mean over
    /// all parts is the step's loss, but for what is drawn for dropout.
    ///
    /// # Errors
    /// As [`Task::loss`]; [`Error::Setting`] where a batch cannot be shared: by default, any.
    fn part(
        &self,
        network: &Self::Network,
        seed: u64,
        step: u64,
        part: Part,
    ) -> Result<Loss, Error> {
        match part {
            Part::WHOLE => self.loss(network, seed, step),
            Part { of, .. } => Err(Error::setting("devices", "1 for this task", of)),
        }
    }
}

/// A loss and what it is the sum of.
#[derive(Clone, Debug)]
pub struct Loss {
    /// One number, which the network is differentiated by.
    pub total: Tensor<1>,
    /// Parts by name, for the log.
    pub parts: Vec<(&'static str, Tensor<1>)>,
}

/// What happened in a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// Steps that are done, this one included.
    pub step: u64,
    /// Steps of the whole run.
    pub steps: u64,
    /// The loss.
    pub loss: f64,
    /// Its parts by name.
    pub parts: Vec<(&'static str, f64)>,
    /// Norm of the gradient, before it was clipped.
    pub gradient_norm: f64,
    /// Learning rate.
    pub rate: f64,
    /// Seconds that the step took.
    pub seconds: f64,
}

/// A run of training in a folder.
#[derive(Debug)]
pub struct Trainer<T: Task> {
    task: T,
    config: TrainerConfig,
    folder: PathBuf,
    network: T::Network,
    average: Option<T::Network>,
    optimiser: AdamW,
    log: RunLog,
    /// Where parts of a batch are differentiated; none: where the network is.
    devices: Vec<Device>,
}

impl<T: Task> Trainer<T> {
    /// Starts a run in a folder, or goes on with the one that is there.
    ///
    /// `network` is what an untrained run starts with; it must be on a device that differentiates.
    ///
    /// # Errors
    /// [`Error::Setting`]; [`Error::File`]; [`Error::Checkpoint`] where the folder holds a run of
    /// another network or another config.
    pub fn open(
        task: T,
        network: T::Network,
        config: TrainerConfig,
        folder: &Path,
    ) -> Result<Self, Error> {
        config.check()?;
        let average = config.average.map(|_| network.valid());
        let mut trainer = Self {
            task,
            folder: folder.into(),
            average,
            optimiser: AdamW::new(config.optimiser),
            log: RunLog::new(folder)?,
            devices: Vec::new(),
            network,
            config,
        };
        if let Some((path, _)) = state::newest(folder)? {
            trainer.restore(&path)?;
        }
        trainer.log.go_on_after(trainer.optimiser.steps)?;
        Ok(trainer)
    }

    /// Shares the batch of every step among devices, which must differentiate. Each gets a copy of
    /// the network and as many motions; their gradients are averaged on the network's own device,
    /// where the optimiser works. The same device may be given more than once.
    #[must_use]
    pub fn on_devices(mut self, devices: Vec<Device>) -> Self {
        self.devices = devices;
        self
    }

    /// What is trained, and how.
    pub const fn task(&self) -> &T {
        &self.task
    }

    /// Steps that are done.
    pub const fn steps_done(&self) -> u64 {
        self.optimiser.steps
    }

    /// The network to use: the running average where there is one. It does not differentiate.
    pub fn network(&self) -> T::Network {
        let average = self.average.clone();
        average.unwrap_or_else(|| self.network.valid())
    }

    /// Trains until the run's last step, and tells `observe` of every step; a checkpoint is written
    /// when one is due, and at the end. `observe` may stop the run by returning false: that writes
    /// a checkpoint, too.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when the loss or the gradient is no number any more: the newest
    /// checkpoint is of before that. Those of the task; [`Error::File`].
    pub fn run(&mut self, mut observe: impl FnMut(&StepReport) -> bool) -> Result<(), Error> {
        while self.steps_done() < self.config.steps {
            let report = self.step()?;
            let last = report.step == self.config.steps;
            if last || report.step.is_multiple_of(self.config.log_every) {
                self.log.write(&report)?;
            }
            let go_on = observe(&report);
            if last || !go_on || report.step.is_multiple_of(self.config.save_every) {
                self.save()?;
            }
            if !go_on {
                break;
            }
        }
        Ok(())
    }

    /// One step.
    fn step(&mut self) -> Result<StepReport, Error> {
        let (start, done) = (Instant::now(), self.steps_done());
        let step = done + 1;
        let finite = |what: &str, value: f64| {
            if value.is_finite() {
                return Ok(value);
            }
            let what = what.to_owned();
            Err(Error::NotFinite {
                step,
                what,
                found: value,
            })
        };
        let seed = self.config.seed;
        let found = differentiate(&self.task, &self.network, &self.devices, seed, done)?;
        let mut gradients = found.gradients;
        for (name, part) in &found.parts {
            finite(name, *part)?;
        }
        let (parts, value) = (found.parts, finite("loss", found.loss)?);
        let squares = gradients.squares().map_or(Ok(0.0), scalar)?;
        let norm = finite("norm of the gradient", squares.sqrt())?;
        if let Some(most) = self.config.clip.filter(|&most| norm > most) {
            gradients = gradients.scaled(most / (norm + 1e-6));
        }
        let factor = self.config.rate.factor(done, self.config.steps);
        let network = self.network.clone();
        self.network = self.optimiser.step(network, gradients, factor);
        self.follow();
        Ok(StepReport {
            step,
            steps: self.config.steps,
            loss: value,
            parts,
            gradient_norm: norm,
            rate: self.config.optimiser.rate * factor,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Lets the running average follow the network.
    fn follow(&mut self) {
        let (Some(decay), Some(average)) = (self.config.average, self.average.take()) else {
            return;
        };
        let step = self.steps_done() as f64;
        let decay = decay.min((1.0 + step) / (10.0 + step));
        let mut current = tensors_of(&self.network.valid());
        self.average = Some(update(average, |path, old| match current.remove(path) {
            Some(new) => old * decay + new * (1.0 - decay),
            None => old,
        }));
    }

    /// Writes a checkpoint, whole or not at all.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn save(&self) -> Result<(), Error> {
        let path = state::path(&self.folder, self.steps_done());
        let networks = (&self.network, self.average.as_ref());
        state::write(&path, networks, &self.optimiser, &self.config)?;
        match self.config.keep {
            Some(count) => state::keep_newest(&self.folder, count),
            None => Ok(()),
        }
    }

    fn restore(&mut self, path: &Path) -> Result<(), Error> {
        let networks = (self.network.clone(), self.average.clone());
        let restored = state::read(path, networks, &self.config)?;
        (self.network, self.average, self.optimiser) = restored;
        Ok(())
    }
}

pub(super) fn scalar(tensor: Tensor<1>) -> Result<f64, Error> {
    let found = numbers(tensor)?;
    Ok(found.first().copied().map_or(f64::NAN, f64::from))
}
