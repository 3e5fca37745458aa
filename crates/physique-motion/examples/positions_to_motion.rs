//! Turns HumanML3D or KIT files into a motion of the open body:
//! `cargo run --release -p physique-motion --example positions_to_motion -- IN.npy OUT.motion.npz`.

use std::error::Error;

use physique_body::{Body, open_body};
use physique_motion::{
    ReadOptions, Recording, features,
    inverse_kinematics::{IkOptions, solve},
    mapping::BodyRest,
    native,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output] = arguments.as_slice() else {
        return Err("expected IN.npy and OUT.motion.npz".into());
    };
    let body = BodyRest::from(&Body::new(open_body()?, &[])?);
    let positions = features::read(input, &ReadOptions::default())?.into_positions()?;
    let solution = solve(&positions, &body, &IkOptions::default())?;
    println!(
        "{} frames, scale {:.4}, joints within {:.2} cm (mean), {:.2} cm (most)",
        solution.motion.frame_count(),
        solution.scale,
        solution.fit.all.mean_cm,
        solution.fit.all.max_cm
    );
    for (joint, distances) in &solution.fit.by_joint {
        println!(
            "    {joint}: mean {:.2} cm, most {:.2} cm",
            distances.mean_cm, distances.max_cm
        );
    }
    let recording = Recording {
        motion: solution.motion,
        name: input.clone(),
        rest_pelvis: body.joints[0],
        source: None,
        licence: None,
        notes: Vec::new(),
    };
    native::write(output, &recording)?;
    Ok(())
}
