//! Segment masses of five bodies beside de Leva's table, in per cent:
//! `cargo run --release -p physique-physics --example segment_masses`.

use physique_body::{Attributes, Body, Sex, open_body};
use physique_physics::{MassPoints, Segment};

/// Name, sex, and stature and mass where they are not the mean.
type Person = (&'static str, Sex, Option<(f64, f64)>);

const PEOPLE: [Person; 5] = [
    ("mean woman", Sex::Female, None),
    ("mean man", Sex::Male, None),
    ("woman, 1.53 m, 46 kg", Sex::Female, Some((1.53, 46.0))),
    ("man, 1.93 m, 90 kg", Sex::Male, Some((1.93, 90.0))),
    ("man, 1.75 m, 110 kg", Sex::Male, Some((1.75, 110.0))),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (name, sex, size) in PEOPLE {
        let person = Attributes {
            sex,
            stature: size.map(|(stature, _)| stature),
            mass: size.map(|(_, mass)| mass),
            age: None,
        };
        let body = Body::from_attributes(open_body()?, &person)?;
        let points = MassPoints::new(&body, 0.02)?;
        println!(
            "{name}: {:.1} kg in {} points",
            body.mass(),
            points.masses().len()
        );
        for segment in Segment::ALL {
            let percent = 100.0 * points.segment_mass(segment) / body.mass();
            let table = segment.de_leva_percent(sex);
            println!("  {:16}{percent:7.2}{table:7.2}", segment.name());
        }
    }
    Ok(())
}
