//! How high ankles and toes are above the ground of their clip, in a data file: what the constants of
//! the ground loss are taken from. A foot is as high as the lower of its toes and its ankle, less 6 cm.
//!
//! `cargo run --release -p physique-data --example foot_heights data.pmd [LABEL=VALUE]`

use std::error::Error;

use physique::motion::features::FeatureLayout;
use physique_data::{DataLimits, Dataset};

/// Below this speed, in m/s, a joint stands still.
const STILL: f32 = 0.1;
const ANKLE: f32 = 0.06;
const SHARES: [f64; 7] = [0.0, 0.01, 0.05, 0.5, 0.95, 0.99, 1.0];

/// Heights in metres: all of them, those whose contact column is set, those that stand still.
#[derive(Default)]
struct Heights([Vec<f32>; 3]);

impl Heights {
    fn add(&mut self, height: f32, (contact, still): (bool, bool)) {
        for (heights, counts) in self.0.iter_mut().zip([true, contact, still]) {
            heights.extend(counts.then_some(height));
        }
    }

    fn print(&mut self, joint: &str) {
        for (kind, heights) in ["all", "contact", "still"].iter().zip(&mut self.0) {
            heights.sort_by(f32::total_cmp);
            print!("{joint:<7} {kind:<8} {:>7}", heights.len());
            for share in SHARES {
                let place = (share * heights.len().saturating_sub(1) as f64).round() as usize;
                let height = heights.get(place).copied().unwrap_or(f32::NAN);
                print!(" {:>7.2}", height * 100.0);
            }
            println!();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which data file?")?;
    let label = arguments.next();
    let label = label.as_deref().and_then(|label| label.split_once('='));
    let dataset = Dataset::open(file, &DataLimits::default())?;
    let skeleton = dataset.skeleton();
    let layout = FeatureLayout::of(skeleton);
    let joints = skeleton.foot_joints();
    let metres = skeleton.metres_per_unit() as f32;
    let metres_a_second = metres * dataset.frame_rate().per_second() as f32;
    let [mut ankles, mut toes, mut feet] = <[Heights; 3]>::default();
    for (number, clip) in dataset.index().clips.iter().enumerate() {
        let has = |(name, value): (&str, &str)| clip.labels.get(name).is_some_and(|v| v == value);
        if clip.mirrored || !label.is_none_or(has) {
            continue;
        }
        let features = dataset.features(dataset.whole(number)?)?;
        for row in features.rows() {
            let positions = row[layout.positions.clone()].as_chunks::<3>().0;
            let steps = row[layout.velocities.clone()].as_chunks::<3>().0;
            let joint = |foot: usize| {
                let square: f32 = steps[joints[foot]].iter().map(|step| step * step).sum();
                let contact = row[layout.contacts.start + foot] > 0.5;
                let rests = (contact, square.sqrt() * metres_a_second < STILL);
                (positions[joints[foot] - 1][1] * metres, rests)
            };
            for side in [0, 2] {
                let (ankle, toe) = (joint(side), joint(side + 1));
                ankles.add(ankle.0, ankle.1);
                toes.add(toe.0, toe.1);
                let heel = (ankle.0 - ANKLE, ankle.1);
                let lower = if heel.0 < toe.0 { heel } else { toe };
                feet.add(lower.0, lower.1);
            }
        }
    }
    println!(
        "joint   which      count   least     1 %     5 %    50 %    95 %    99 %    most (cm)"
    );
    ankles.print("ankle");
    toes.print("toes");
    feet.print("foot");
    Ok(())
}
