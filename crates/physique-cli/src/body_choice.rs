//! Which body the flags ask for.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use physique::body::{Attributes, Body, BodyModel, Sex, compact, open_body, open_body_low};

/// No compact body file is larger.
const LARGEST_BODY_FILE: u64 = 64 << 20;

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Body")]
pub(crate) struct BodyArguments {
    /// Body model: `open`, `open-low`, or a compact body file.
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
        let model = self.model()?;
        if let Some(betas) = &self.betas {
            return Ok(Body::new(model, betas)?);
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

    fn model(&self) -> Result<Arc<BodyModel>> {
        match self.body.as_str() {
            "open" => Ok(open_body()?),
            "open-low" => Ok(open_body_low()?),
            file => read_body(Path::new(file)),
        }
    }
}

fn read_body(path: &Path) -> Result<Arc<BodyModel>> {
    let shown = path.display();
    let size = std::fs::metadata(path)
        .with_context(|| format!("body {shown}"))?
        .len();
    if size > LARGEST_BODY_FILE {
        bail!("body {shown}: {size} bytes, above the limit of {LARGEST_BODY_FILE}");
    }
    let bytes = std::fs::read(path).with_context(|| format!("body {shown}"))?;
    Ok(Arc::new(compact::read(&shown.to_string(), &bytes)?))
}
