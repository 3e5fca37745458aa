//! Motions that parts are kept of, or that are gone on with.

use std::path::Path;

use anyhow::{Result, bail};
use physique::body::Body;
use physique::load::load;
use physique::motion::features::{
    FeatureSkeleton, JointPositions, MotionFeatures, canonicalise_window, extract_window,
};
use physique::motion::mapping::BodyRest;
use physique_learn::diffusion::Edit;
use physique_learn::mdm::{KnownMotion, TextToMotion};

use super::arguments::{EditArguments, KeptPart};
use crate::arguments::ReadArguments;
use crate::view::load_options;

/// What there is before a motion is generated.
pub(super) enum Given {
    /// Nothing.
    Nothing,
    /// Parts of a motion stay.
    Known(KnownMotion),
    /// A motion is gone on with.
    After(MotionFeatures),
}

/// The motion of the flags in the network's terms, and what it is for.
pub(super) fn read(
    arguments: &EditArguments,
    read: &ReadArguments,
    network: &TextToMotion,
    body: &Body,
) -> Result<Given> {
    let plans = network.folder().network.config().planner.is_some();
    match (&arguments.from, &arguments.after) {
        (None, None) if plans => {
            bail!("the network goes on with a motion; say which: --after FILE")
        }
        (None, None) => Ok(Given::Nothing),
        (_, Some(_)) if !plans => {
            bail!("--after: the network makes whole motions; use --from and --keep")
        }
        (_, Some(path)) => Ok(Given::After(features(
            "--after", path, read, network, body,
        )?)),
        (Some(_), None) if plans => bail!("--from: the network goes on with motions; use --after"),
        (Some(path), None) => {
            let features = features("--from", path, read, network, body)?;
            let edit = kept(&arguments.keep, &features, features.skeleton());
            Ok(Given::Known(KnownMotion { features, edit }))
        }
    }
}

/// A motion as the network has motions.
fn features(
    flag: &str,
    path: &Path,
    read: &ReadArguments,
    network: &TextToMotion,
    body: &Body,
) -> Result<MotionFeatures> {
    let skeleton = network.folder().statistics.skeleton();
    if skeleton != FeatureSkeleton::HumanMl3d {
        bail!("{flag}: expected a network of 22 joints, found one of KIT's 21");
    }
    // Statistics of the flags are the network's, not the file's.
    let plain = ReadArguments {
        mean: None,
        std: None,
        ..read.clone()
    };
    let loaded = load(path, body, &load_options(&plain)?)?;
    let motion = loaded.motion.resampled(network.frame_rate())?;
    let positions = JointPositions::from_motion(&motion, &BodyRest::from(body))?;
    Ok(extract_window(&canonicalise_window(&positions)?)?)
}

fn kept(parts: &[KeptPart], features: &MotionFeatures, skeleton: FeatureSkeleton) -> Edit {
    let (frames, columns) = (features.frame_count(), skeleton.feature_count());
    let legs = [0, 1, 2, 4, 5, 7, 8, 10, 11];
    let upper: Vec<usize> = (0..skeleton.joint_count())
        .filter(|joint| !legs.contains(joint))
        .collect();
    let edit = Edit::all_new(frames, columns);
    parts.iter().fold(edit, |edit, part| match part {
        KeptPart::Ends => edit
            .keep(0..frames / 4, 0..columns)
            .keep(frames * 3 / 4..frames, 0..columns),
        KeptPart::Start => edit.keep(0..frames / 4, 0..columns),
        KeptPart::Legs => edit.keep_joints(0..frames, &legs, skeleton),
        KeptPart::UpperBody => edit.keep_joints(0..frames, &upper, skeleton),
    })
}
