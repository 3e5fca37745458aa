//! A person in words: sex, stature, mass and age instead of betas.

use std::sync::Arc;

use crate::{Body, BodyModel, Error};

/// Sex of a mean body; `Neutral` lies half-way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sex {
    /// The mean female body.
    Female,
    /// Half-way between the two.
    #[default]
    Neutral,
    /// The mean male body.
    Male,
}

impl Sex {
    /// +1 for male, -1 for female, 0 for neutral.
    const fn sign(self) -> f64 {
        match self {
            Self::Female => -1.0,
            Self::Neutral => 0.0,
            Self::Male => 1.0,
        }
    }
}

/// What is known of a person; what is missing is taken from the mean body of the sex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attributes {
    /// Sex.
    pub sex: Sex,
    /// Standing height in metres.
    pub stature: Option<f64>,
    /// Mass in kilograms. Where only the stature is given, the body mass index stays that of the
    /// mean body.
    pub mass: Option<f64>,
    /// Age in years.
    pub age: Option<f64>,
}

/// A linear map from attributes to betas, with the mean bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeMap {
    /// Betas of the mean male body.
    pub mean_male: Vec<f32>,
    /// Betas of the mean female body.
    pub mean_female: Vec<f32>,
    /// `[betas][5]`: weights of 1, sex (+1 male, -1 female), stature in metres, the natural
    /// logarithm of the mass in kilograms, and age in years.
    pub betas_from_attributes: Vec<[f32; 5]>,
}

/// Betas beyond this are outside what the model was made from.
const LARGEST_BETA: f32 = 5.0;
/// The fit stops when stature and mass are right to this fraction.
const TOLERANCE: f64 = 1e-5;
const LARGEST_STEPS: usize = 30;

impl AttributeMap {
    /// Mean betas of a sex.
    pub fn mean(&self, sex: Sex) -> Vec<f32> {
        let (male, female) = (&self.mean_male, &self.mean_female);
        match sex {
            Sex::Male => male.clone(),
            Sex::Female => female.clone(),
            Sex::Neutral => male
                .iter()
                .zip(female)
                .map(|(m, f)| (m + f) / 2.0)
                .collect(),
        }
    }

    /// Age at which the map is nearest to the mean betas, given sex, stature and mass.
    fn mean_age(&self, sex: Sex, stature: f64, mass: f64) -> f64 {
        let at_birth = self.betas(sex, stature, mass, 0.0);
        let (mut along, mut squared) = (0.0, 0.0);
        for ((mean, base), row) in self
            .mean(sex)
            .into_iter()
            .zip(at_birth)
            .zip(&self.betas_from_attributes)
        {
            along += f64::from(mean - base) * f64::from(row[4]);
            squared += f64::from(row[4]).powi(2);
        }
        if squared > 0.0 { along / squared } else { 0.0 }
    }

    fn betas(&self, sex: Sex, stature: f64, mass: f64, age: f64) -> Vec<f32> {
        let attributes = [1.0, sex.sign(), stature, mass.ln(), age];
        self.betas_from_attributes
            .iter()
            .map(|row| {
                let terms = row.iter().zip(attributes).map(|(&w, a)| f64::from(w) * a);
                terms.sum::<f64>() as f32
            })
            .collect()
    }
}

impl Body {
    /// The mean body of a sex.
    ///
    /// # Errors
    /// [`Error::Attributes`] when the model does not know mean bodies.
    pub fn mean(model: Arc<BodyModel>, sex: Sex) -> Result<Self, Error> {
        let betas = attribute_map(&model)?.mean(sex);
        Self::new(model, &betas)
    }

    /// The body of a described person: stature and mass are met to 1e-5 of their value.
    ///
    /// # Errors
    /// [`Error::Attributes`] when the model has no attribute map, when an attribute is not a
    /// positive number, or when the person lies outside what the model can represent (a beta
    /// beyond 5).
    pub fn from_attributes(model: Arc<BodyModel>, person: &Attributes) -> Result<Self, Error> {
        let map = attribute_map(&model)?.clone();
        let mean = Self::mean(Arc::clone(&model), person.sex)?;
        for (what, value) in [
            ("the stature in metres", person.stature),
            ("the mass in kilograms", person.mass),
            ("the age in years", person.age),
        ] {
            if let Some(value) = value
                && !(value.is_finite() && value > 0.0)
            {
                return Err(Error::Attributes {
                    what,
                    expected: "a positive number".into(),
                    found: value.to_string(),
                });
            }
        }
        if person.stature.is_none() && person.mass.is_none() && person.age.is_none() {
            return Ok(mean);
        }
        let stature = person.stature.unwrap_or_else(|| mean.stature());
        let mass = person
            .mass
            .unwrap_or_else(|| mean.body_mass_index() * stature.powi(2));
        let age = person
            .age
            .unwrap_or_else(|| map.mean_age(person.sex, mean.stature(), mean.mass()));

        // The map is linear and slightly off: ask for as much more as the last answer fell short.
        let (mut asked_stature, mut asked_mass) = (stature, mass);
        for _ in 0..LARGEST_STEPS {
            let betas = map.betas(person.sex, asked_stature, asked_mass, age);
            if !betas.iter().all(|beta| beta.abs() <= LARGEST_BETA) {
                break;
            }
            let body = Self::new(Arc::clone(&model), &betas)?;
            let (stature_ratio, mass_ratio) = (stature / body.stature(), mass / body.mass());
            if (stature_ratio - 1.0).abs() < TOLERANCE && (mass_ratio - 1.0).abs() < TOLERANCE {
                return Ok(body);
            }
            asked_stature += stature - body.stature();
            asked_mass *= mass_ratio;
        }
        Err(Error::Attributes {
            what: "the person",
            expected: format!(
                "a body that {} can represent (all betas within {LARGEST_BETA})",
                model.name()
            ),
            found: format!(
                "{:?}, {stature:.3} m, {mass:.1} kg, {age:.0} years",
                person.sex
            ),
        })
    }
}

fn attribute_map(model: &BodyModel) -> Result<&AttributeMap, Error> {
    model.attributes().ok_or_else(|| Error::Attributes {
        what: "the body model",
        expected: "one that knows sex, stature and mass, such as the open body".into(),
        found: model.name().to_owned(),
    })
}
