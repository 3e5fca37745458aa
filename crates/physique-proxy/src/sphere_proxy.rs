//! A whole proxy: everything that turns a shape into spheres that follow joints.

use std::collections::BTreeMap;

use glam::Vec3;
use physique_body::{Body, Joint};
use physique_geometry::sia::UnitBall;

use crate::{Error, JointRegressor, PairStatistics, Pairs, SphereBody, SphereRegressor};

/// Four joints that a sphere follows, heaviest first, with weights that sum to 1.
pub type BlendRow = [(u8, f32); 4];

/// A sphere proxy of a body model: regressors from betas to spheres and joints, blend weights, and
/// which spheres the self-intersection loss compares.
///
/// [`SphereProxy::of_body`] gives metres and the body's own joints; [`SphereProxy::normalised`]
/// the paper's unit, without a body model.
#[derive(Clone, Debug)]
pub struct SphereProxy {
    spheres: SphereRegressor,
    joints: JointRegressor,
    blend_weights: Vec<BlendRow>,
    pairs: PairChoice,
    notes: BTreeMap<String, String>,
}

/// What is known about which pairs to compare.
#[derive(Clone, Debug, PartialEq)]
pub enum PairChoice {
    /// How often spheres intersect in real motion: any threshold can be asked for.
    Statistics(PairStatistics),
    /// The pairs themselves, as published proxies store them.
    Chosen(Pairs),
}

impl SphereProxy {
    /// Share of the poses from which on a pair is left out, as in the paper.
    pub const MOST_INTERSECTING: f64 = 0.9;

    /// Puts the parts together.
    ///
    /// # Errors
    /// [`Error::SphereBody`] or [`Error::PairCount`] unless all parts have as many spheres and
    /// possible weights; [`Error::Regressor`] unless both regressors read as many betas.
    pub fn new(
        spheres: SphereRegressor,
        joints: JointRegressor,
        blend_weights: Vec<BlendRow>,
        pairs: PairChoice,
        notes: BTreeMap<String, String>,
    ) -> Result<Self, Error> {
        let found = match &pairs {
            PairChoice::Statistics(statistics) => statistics.sphere_count(),
            PairChoice::Chosen(pairs) => pairs.sphere_count(),
        };
        let expected = spheres.sphere_count();
        if found != expected {
            return Err(Error::PairCount { expected, found });
        }
        if joints.beta_count() != spheres.beta_count() {
            return Err(Error::Regressor {
                array: "the joint regressor".into(),
                expected: format!("{} betas as the spheres", spheres.beta_count()),
                found: joints.beta_count().to_string(),
            });
        }
        let proxy = Self {
            spheres,
            joints,
            blend_weights,
            pairs,
            notes,
        };
        proxy.normalised(&[])?.check()?;
        Ok(proxy)
    }

    /// Number of spheres.
    pub fn sphere_count(&self) -> usize {
        self.spheres.sphere_count()
    }

    /// Number of betas that it reads.
    pub fn beta_count(&self) -> usize {
        self.spheres.beta_count()
    }

    /// Betas to spheres.
    pub fn sphere_regressor(&self) -> &SphereRegressor {
        &self.spheres
    }

    /// Betas to joints.
    pub fn joint_regressor(&self) -> &JointRegressor {
        &self.joints
    }

    /// `[spheres]` joints that each sphere follows.
    pub fn blend_weights(&self) -> &[BlendRow] {
        &self.blend_weights
    }

    /// What is known about which pairs to compare.
    pub fn pair_choice(&self) -> &PairChoice {
        &self.pairs
    }

    /// The same proxy with other statistics.
    ///
    /// # Errors
    /// [`Error::PairCount`] for statistics of another number of spheres.
    pub fn with_statistics(mut self, statistics: PairStatistics) -> Result<Self, Error> {
        let (expected, found) = (self.sphere_count(), statistics.sphere_count());
        if expected != found {
            return Err(Error::PairCount { expected, found });
        }
        self.pairs = PairChoice::Statistics(statistics);
        Ok(self)
    }

    /// What is told of the proxy: body, recipe, licence and the like, by name.
    pub fn notes(&self) -> &BTreeMap<String, String> {
        &self.notes
    }

    /// Tells something more of the proxy.
    pub fn note(&mut self, name: &str, text: impl Into<String>) {
        self.notes.insert(name.to_owned(), text.into());
    }

    /// The pairs that the paper compares: spheres of different joints that intersect in fewer than
    /// [`SphereProxy::MOST_INTERSECTING`] of the poses of real motion.
    ///
    /// # Errors
    /// None in practice: there are at most 4,096 spheres.
    pub fn pairs(&self) -> Result<Pairs, Error> {
        self.pairs_below(Self::MOST_INTERSECTING)
    }

    /// As [`SphereProxy::pairs`] with another threshold. Pairs that were chosen before stay.
    ///
    /// # Errors
    /// As [`SphereProxy::pairs`].
    pub fn pairs_below(&self, most: f64) -> Result<Pairs, Error> {
        match &self.pairs {
            PairChoice::Chosen(pairs) => Ok(pairs.clone()),
            PairChoice::Statistics(statistics) => {
                let dominant = |sphere: usize| self.blend_weights[sphere][0].0;
                let pairs = statistics.pairs_below(most)?;
                Ok(pairs.filtered(|i, j| dominant(i) != dominant(j)))
            }
        }
    }

    /// Spheres and joints of a shape in the paper's unit; missing betas are 0.
    ///
    /// # Errors
    /// [`Error::Betas`] for more betas than it reads, or for one that is not finite.
    pub fn normalised(&self, betas: &[f32]) -> Result<SphereBody, Error> {
        let spheres = self.spheres.spheres(betas)?;
        Ok(SphereBody {
            rest_joints: self.joints.joints(betas)?,
            centres: spheres.centres,
            radii: spheres.radii,
            blend_weights: self.blend_weights.clone(),
        })
    }

    /// Spheres of a body in metres, with the body's own joints.
    ///
    /// The body must be of the model that the proxy was fitted to, or of one with the same betas
    /// (as both resolutions of the open body). Betas that the proxy does not read move no sphere.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a body without extent; [`Error::SphereBody`] where the regressor
    /// leaves the range of numbers, far away from the shapes it was fitted to.
    pub fn of_body(&self, body: &Body) -> Result<SphereBody, Error> {
        let read = body.betas().len().min(self.beta_count());
        let spheres = self.spheres.spheres(&body.betas()[..read])?;
        let ball = UnitBall::around(body.rest_vertices())?;
        let unit = ball.scale.recip();
        let mut rest_joints = [Vec3::ZERO; Joint::COUNT];
        for (joint, &rest) in rest_joints.iter_mut().zip(body.rest_joints()) {
            *joint = rest;
        }
        let body = SphereBody {
            rest_joints,
            centres: spheres
                .centres
                .iter()
                .map(|&centre| centre * unit + ball.centre)
                .collect(),
            radii: spheres.radii.iter().map(|radius| radius * unit).collect(),
            blend_weights: self.blend_weights.clone(),
        };
        body.check()?;
        Ok(body)
    }
}
