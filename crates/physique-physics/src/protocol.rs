//! The field's own metrics, each by its published definition, side by side.
//!
//! Each protocol looks at a motion at the frame rate that its definition assumes
//! ([`Protocol::frame_rate`]): the motion is resampled to it, because thresholds and displacements
//! "per frame" mean nothing otherwise. Two floor conventions matter: height 0
//! ([`Floor::AsGiven`]), and the lowest point of the clip ([`Floor::Lowest`]), which hides every
//! clip that sinks as a whole.
//!
//! Figures are comparable with published ones only on the same motions and bodies.

mod gmd;
mod humor;
mod humos;
mod ipman;
mod joints;
mod kimodo;
mod parts;
mod physdiff;
mod reindiffuse;
mod resample;
mod track;

use std::fmt;
use std::str::FromStr;

use physique_motion::{FrameRate, Motion};

pub use resample::resampled;

use crate::{Error, Physics};
use track::Track;

/// A published set of metrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Protocol {
    /// HUMOS (arXiv 2409.03944) as its released pipeline computes it, errors included: 20 fps.
    HumosReleased,
    /// HUMOS with the right sign of the vertical acceleration, a Savitzky-Golay derivative,
    /// airborne frames left out and counted, unconditional means: 20 fps.
    HumosCorrected,
    /// PhysDiff (ICCV 2023): penetrate, float, skate and their sum in mm: 20 fps.
    PhysDiff,
    /// GMD and OmniControl: foot skating ratio of the toe joints: 20 fps.
    Gmd,
    /// ReinDiffuse (WACV 2025): skate, float, penetrate and clip: 20 fps.
    ReinDiffuse,
    /// Kimodo (arXiv 2603.15546): toe skating: 30 fps.
    Kimodo,
    /// EDGE (CVPR 2023): physical foot contact score: 30 fps.
    EdgePfc,
    /// MANN and NeMF: skating weighted by height: 60 fps.
    Mann,
    /// HuMoR (ICCV 2021): ground penetration of the toe joints and joint acceleration: 30 fps.
    Humor,
    /// IPMAN (CVPR 2023): centre of mass against centre of pressure and base of support; single
    /// frames, any frame rate.
    Ipman,
}

impl Protocol {
    /// All protocols.
    pub const ALL: [Self; 10] = [
        Self::HumosReleased,
        Self::HumosCorrected,
        Self::PhysDiff,
        Self::Gmd,
        Self::ReinDiffuse,
        Self::Kimodo,
        Self::EdgePfc,
        Self::Mann,
        Self::Humor,
        Self::Ipman,
    ];

    /// The name by which commands and reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HumosReleased => "humos-released",
            Self::HumosCorrected => "humos-corrected",
            Self::PhysDiff => "physdiff",
            Self::Gmd => "gmd",
            Self::ReinDiffuse => "reindiffuse",
            Self::Kimodo => "kimodo",
            Self::EdgePfc => "edge-pfc",
            Self::Mann => "mann",
            Self::Humor => "humor",
            Self::Ipman => "ipman",
        }
    }

    /// Names of its measures, in the order of [`measure`].
    pub const fn measure_names(self) -> &'static [&'static str] {
        match self {
            Self::HumosReleased => &[
                "penetrate_cm",
                "float_cm",
                "skate_cm_s",
                "skate_percent",
                "dyn_stability_percent",
                "bos_dist_cm",
            ],
            Self::HumosCorrected => &[
                "penetrate_cm",
                "float_cm",
                "skate_cm_s",
                "skate_percent",
                "dyn_stability_percent",
                "bos_dist_cm",
                "unjudged_percent",
            ],
            Self::PhysDiff => &[
                "penetrate_mm",
                "float_mm",
                "skate_mm_per_frame",
                "phys_err_mm",
            ],
            Self::Gmd => &["skating_ratio"],
            Self::ReinDiffuse => &[
                "skate_2_5_cm_ratio",
                "skate_5_cm_ratio",
                "float_m",
                "penetrate_m",
                "clip_ratio",
            ],
            Self::Kimodo => &[
                "skating_contact_ratio",
                "toe_speed_in_contact_m_s",
                "labelled_contact_speed_mean_m_s",
                "labelled_contact_speed_max_m_s",
            ],
            Self::EdgePfc => &["pfc"],
            Self::Mann => &["skate_cm_per_frame"],
            Self::Humor => &[
                "toes_below_0_cm_percent",
                "toes_below_3_cm_percent",
                "toes_below_6_cm_percent",
                "toes_below_9_cm_percent",
                "toes_below_12_cm_percent",
                "toes_below_15_cm_percent",
                "penetration_depth_cm",
                "joint_acceleration_m_s2",
            ],
            Self::Ipman => &[
                "com_cop_distance_mm",
                "com_in_base_of_support_percent",
                "frames_with_contact_percent",
            ],
        }
    }

    /// Frames a second that the definition assumes; `None` where frames stand alone.
    pub const fn frame_rate(self) -> Option<f64> {
        match self {
            Self::HumosReleased
            | Self::HumosCorrected
            | Self::PhysDiff
            | Self::Gmd
            | Self::ReinDiffuse => Some(20.0),
            Self::Kimodo | Self::EdgePfc | Self::Humor => Some(30.0),
            Self::Mann => Some(60.0),
            Self::Ipman => None,
        }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Protocol {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.into_iter().find(|known| known.name() == name);
        known.ok_or_else(|| Error::Protocol { found: name.into() })
    }
}

/// Where a protocol takes the floor to be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Floor {
    /// At height 0 of the motion.
    #[default]
    AsGiven,
    /// At the lowest skin of the whole clip.
    Lowest,
    /// So that the lowest skin of the clip is 2 cm below: how HUMOS prepares its data.
    HumosSink,
}

/// A measure by its published name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProtocolMeasure {
    /// Name with unit, such as `penetrate_mm`.
    pub name: &'static str,
    /// Value; `None` where no frame meets the definition's condition.
    pub value: Option<f64>,
}

impl ProtocolMeasure {
    const fn new(name: &'static str, value: Option<f64>) -> Self {
        Self { name, value }
    }
}

/// Measures a motion by a published protocol.
///
/// # Errors
/// [`Error::NoFrames`] for an empty motion.
pub fn measure(
    physics: &Physics,
    motion: &Motion,
    protocol: Protocol,
    floor: Floor,
) -> Result<Vec<ProtocolMeasure>, Error> {
    if motion.frame_count() == 0 {
        return Err(Error::NoFrames);
    }
    let sampled;
    let motion = match protocol.frame_rate() {
        Some(rate) => {
            sampled = resampled(motion, FrameRate::new(rate)?)?;
            &sampled
        }
        None => motion,
    };
    let track = Track::new(physics, motion, floor)?;
    Ok(match protocol {
        Protocol::HumosReleased => humos::released(physics, motion, &track)?,
        Protocol::HumosCorrected => humos::corrected(physics, motion, &track)?,
        Protocol::PhysDiff => physdiff::measure(&track),
        Protocol::Gmd => gmd::measure(&track),
        Protocol::ReinDiffuse => reindiffuse::measure(&track),
        Protocol::Kimodo => kimodo::measure(&track),
        Protocol::EdgePfc => joints::edge_pfc(&track),
        Protocol::Mann => joints::mann(&track),
        Protocol::Humor => humor::measure(&track),
        Protocol::Ipman => ipman::measure(physics, motion, &track)?,
    })
}
