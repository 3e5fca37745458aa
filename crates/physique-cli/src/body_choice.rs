//! Which body the flags ask for.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use clap::{Args, ValueEnum};
use physique::body::{
    Attributes, Body, BodyModel, BodyOptions, JointSet, Sex, open_body, open_body_low, read_body,
};

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Body")]
pub(crate) struct BodyArguments {
    /// Body model: `open`, `open-low`, or a file: SMPL, SMPL-H or SMPL-X as .npz or .pkl, or a
    /// compact body.
    #[arg(long, value_name = "FILE", default_value = "open")]
    pub(crate) body: String,
    /// Sex of the mean body.
    #[arg(long, value_enum)]
    pub(crate) sex: Option<SexName>,
    /// Stature in metres.
    #[arg(long, value_name = "METRES")]
    pub(crate) stature: Option<f64>,
    /// Mass in kilograms.
    #[arg(long, value_name = "KG")]
    pub(crate) mass: Option<f64>,
    /// Age in years.
    #[arg(long, value_name = "YEARS")]
    pub(crate) age: Option<f64>,
    /// Shape coefficients of the model, separated by commas, instead of a description.
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true,
          conflicts_with_all = ["sex", "stature", "mass", "age"])]
    pub(crate) betas: Option<Vec<f32>>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SexName {
    Female,
    Neutral,
    Male,
}

impl BodyArguments {
    /// The body that is asked for.
    pub(crate) fn body(&self) -> Result<Body> {
        let model = model(&self.body)?;
        if let Some(betas) = &self.betas {
            return Ok(Body::new(model, betas)?);
        }
        // Licensed models have a mean body, but do not know how people map to betas.
        if model.attributes().is_none() && self.describes_nobody() {
            return Ok(Body::new(model, &[])?);
        }
        let person = Attributes {
            sex: match self.sex {
                Some(SexName::Female) => Sex::Female,
                Some(SexName::Male) => Sex::Male,
                Some(SexName::Neutral) | None => Sex::Neutral,
            },
            stature: self.stature,
            mass: self.mass,
            age: self.age,
        };
        Ok(Body::from_attributes(model, &person)?)
    }

    const fn describes_nobody(&self) -> bool {
        self.sex.is_none() && self.stature.is_none() && self.mass.is_none() && self.age.is_none()
    }
}

/// The body model of a `--body` flag.
pub(crate) fn model(name: &str) -> Result<Arc<BodyModel>> {
    match name {
        "open" => Ok(open_body()?),
        "open-low" => Ok(open_body_low()?),
        file => {
            // Motions have no hands and faces: fingers, jaw and eyes stay at rest.
            let options = BodyOptions {
                joints: JointSet::Body22,
                ..BodyOptions::default()
            };
            let model = read_body(Path::new(file), &options)?;
            let surface = model.surface();
            if surface.open_edges > 0 || surface.components > 1 {
                eprintln!(
                    "{file}: the mesh has {} open edges and {} parts; volumes are those of closed surfaces in one part.",
                    surface.open_edges, surface.components
                );
            }
            Ok(Arc::new(model))
        }
    }
}
