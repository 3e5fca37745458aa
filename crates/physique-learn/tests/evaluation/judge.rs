//! The judge, on made-up motions of a body.

use std::path::Path;

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body_low};
use physique_data::{DataLimits, Dataset, Recipe, Source, Split, Window, Wording, build};
use physique_learn::evaluation::judge::{ContentJudge, MotionDescription, Trial, TrialOptions};
use physique_learn::random::Random;
use physique_motion::features::MotionFeatures;
use physique_motion::{FrameRate, Motion, Recording};

const RECIPE: &str = r#"
name = "made-up"
licence = "CC0"
attribution = "nobody"
mirror = true
[windows]
shortest = 1.0
longest = 3.0
[split]
validation = 0.25
test = 0.0
within = "content"
[[source]]
files = "{content}_{take}.npz"
[words.content.walk]
does = ["walks", "is walking"]
held_out.does = ["strolls"]
[words.content.squat]
does = ["squats"]
held_out.does = ["goes down"]
[words.content.raise-left-hand]
mirrored = "raise-right-hand"
does = ["raises the left hand"]
held_out.does = ["holds up the left hand"]
[words.content.raise-right-hand]
mirrored = "raise-left-hand"
does = ["raises the right hand"]
held_out.does = ["holds up the right hand"]
[[caption]]
text = "a person {content.does}"
"#;

const TAKES: u64 = 8;

/// A body that walks, squats or raises its left hand, each time a little differently.
fn motion(content: &str, take: u64) -> Motion {
    let mut random = Random::new(&[take, content.len() as u64]);
    let mut varied = |about: f64| (about * (0.8 + 0.4 * random.unit())) as f32;
    let (speed, depth, angle, start) = (varied(1.2), varied(0.3), varied(2.0), varied(0.5));
    let frames = 44 + 4 * (take as usize % 3);
    let (mut roots, mut rotations) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        let time = frame as f32 / 20.0;
        let progress = ((time - start) / 1.5).clamp(0.0, 1.0);
        let mut pose = [Quat::IDENTITY; Joint::COUNT];
        let mut root = Vec3::ZERO;
        let (mut left, right) = (-1.3, 1.3);
        match content {
            "walk" => {
                root.z = speed * time;
                let swing = 0.4 * (6.0 * time + start).sin();
                pose[Joint::LeftHip.index()] = Quat::from_rotation_x(swing);
                pose[Joint::RightHip.index()] = Quat::from_rotation_x(-swing);
            }
            "squat" => {
                let bend = (3.0 * progress).sin();
                root.y = -depth * bend;
                for (hip, knee) in [
                    (Joint::LeftHip, Joint::LeftKnee),
                    (Joint::RightHip, Joint::RightKnee),
                ] {
                    pose[hip.index()] = Quat::from_rotation_x(-0.8 * bend);
                    pose[knee.index()] = Quat::from_rotation_x(1.6 * bend);
                }
            }
            _ => left += angle * progress,
        }
        pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(left);
        pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(right);
        roots.push(root);
        rotations.extend(pose);
    }
    let rate = FrameRate::new(20.0).expect("possible");
    Motion::new(rate, None, roots, rotations).expect("finite")
}

fn made_up(folder: &Path) -> Dataset {
    let body = open_body_low().expect("embedded");
    let body = Body::mean(body, Sex::Neutral).expect("possible");
    for content in ["walk", "squat", "raise-left-hand"] {
        for take in 0..TAKES {
            let recording = Recording {
                motion: motion(content, take),
                name: String::new(),
                rest_pelvis: body.rest_joint(Joint::Pelvis),
                source: None,
                licence: None,
                notes: Vec::new(),
            };
            let file = folder.join(format!("{content}_{take}.npz"));
            physique::motion::native::write(file, &recording).expect("written");
        }
    }
    let recipe = Recipe::parse(RECIPE, "test").expect("a recipe");
    let (output, limits) = (folder.join("made-up.pmd"), DataLimits::default());
    let source = Source::Recipe(Box::new(recipe));
    build(&source, folder, &output, &limits, &()).expect("sound clips");
    Dataset::open(&output, &limits).expect("just built")
}

/// A clip of the validation split with this label, and its exact mirror image, which has the other.
fn sides(dataset: &Dataset) -> [MotionFeatures; 2] {
    let clips = &dataset.index().clips;
    let of = |mirrored: bool| {
        let is = |clip: &usize| {
            clips[*clip].mirrored == mirrored && clips[*clip].labels["content"].starts_with("raise")
        };
        let clip = dataset.clips_of(Split::Validation).find(is).expect("some");
        dataset
            .features(dataset.whole(clip).expect("there"))
            .expect("sound")
    };
    [of(false), of(true)]
}

#[test]
fn it_tells_contents_and_sides_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let judge = ContentJudge::of_dataset(&dataset, Split::Train, "content").expect("labelled");
    let labels = ["raise-left-hand", "raise-right-hand", "squat", "walk"];
    assert_eq!(judge.labels(), labels);
    let accuracy = judge.accuracy(&dataset, Split::Validation, "content");
    assert_eq!(accuracy.expect("labelled").share(), 1.0);
    let [left, right] = sides(&dataset).map(|features| judge.judge(&features).expect("it fits"));
    assert_eq!([left.label, right.label], labels[..2]);
    assert!(left.share > 0.5 && left.share <= 1.0, "{left:?}");

    // What it knows is no distance away; what it does not know is far.
    let clip = dataset.clips_of(Split::Train).next().expect("some");
    let whole = dataset.whole(clip).expect("there");
    let known = dataset.features(whole).expect("sound");
    let odd: Vec<f32> = known
        .values()
        .iter()
        .map(|value| 3.0 * value + 1.0)
        .collect();
    let odd = MotionFeatures::new(known.frame_rate(), known.skeleton(), odd).expect("finite");
    let [known, odd] = [known, odd].map(|of| judge.judge(&of).expect("it fits").distance);
    assert!(odd > 5.0 * known, "{known} {odd}");
}

#[test]
fn lengths_are_not_looked_at() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let clip = dataset.clips_of(Split::Train).next().expect("some");
    let whole = dataset
        .features(dataset.whole(clip).expect("there"))
        .expect("sound");
    let twice = [whole.values(), whole.values()].concat();
    let twice = MotionFeatures::new(whole.frame_rate(), whole.skeleton(), twice).expect("finite");
    let [a, b] = [&whole, &twice].map(MotionDescription::of);
    let numbers = a.numbers().iter().zip(b.numbers()).enumerate();
    // All but how far it turned.
    let different = numbers.filter(|(_, (a, b))| (**a - **b).abs() > 1e-3 * a.abs().max(1.0));
    let different: Vec<_> = different.map(|(index, _)| index).collect();
    assert!(different.len() <= 1, "{different:?}");
}

#[test]
fn a_trial_counts_what_is_right_swapped_and_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let judge = ContentJudge::of_dataset(&dataset, Split::Train, "content").expect("labelled");
    let options = TrialOptions {
        samples: 3,
        ..TrialOptions::default()
    };
    let trial = Trial::new(&dataset, &options).expect("possible");
    assert_eq!(trial.values.len(), 4);
    assert_eq!(trial.prompts.len(), 12);
    // Every prompt for the right hand gets the left one, all else what it asks for.
    let clips = &dataset.index().clips;
    let given = |text: &str| {
        let content = match text {
            text if text.contains("hand") => "raise-left-hand",
            text if text.contains("squat") => "squat",
            _ => "walk",
        };
        let is = |clip: &usize| clips[*clip].labels["content"] == content;
        let clip = dataset.clips_of(Split::Validation).find(is).expect("some");
        dataset
            .features(dataset.whole(clip).expect("there"))
            .expect("sound")
    };
    let motions: Vec<_> = trial
        .prompts
        .iter()
        .map(|prompt| given(&prompt.caption.text))
        .collect();
    let report = trial.report(&dataset, &judge, &motions).expect("it works");
    assert_eq!(report.judge.share(), 1.0);
    for row in &report.rows {
        let expected = match row.value.as_str() {
            "raise-right-hand" => (0, 3),
            _ => (3, 0),
        };
        assert_eq!((row.right, row.swapped), expected, "{}", row.value);
        assert_eq!(row.samples, 3);
        // Real motions against real ones.
        let ratio = row.quality.jerk_m_s3 / row.real.jerk_m_s3;
        assert!((0.4..2.5).contains(&ratio), "{} {ratio}", row.value);
    }
    assert_eq!(
        (report.all.samples, report.all.right, report.all.swapped),
        (12, 9, 3)
    );
    assert_eq!(report.all.taken_for["raise-left-hand"], 3);

    let told = trial
        .report(&dataset, &judge, &motions[1..])
        .expect_err("one less");
    assert!(
        told.to_string().contains("12, one a prompt, found 11"),
        "{told}"
    );
}

#[test]
fn prompts_depend_on_the_seed_and_keep_to_the_wording() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let prompts = |wording: Wording, seed: u64| {
        let options = TrialOptions {
            wording,
            seed,
            ..TrialOptions::default()
        };
        Trial::new(&dataset, &options).expect("possible").prompts
    };
    let training = prompts(Wording::Training, 1);
    assert_eq!(training, prompts(Wording::Training, 1));
    assert_ne!(training, prompts(Wording::Training, 2));
    assert!(
        training
            .iter()
            .all(|prompt| !prompt.caption.text.contains("holds up"))
    );
    assert!(
        training
            .iter()
            .all(|prompt| [40, 44, 48].contains(&prompt.frames))
    );
    let held_out = prompts(Wording::HeldOut, 1);
    let words = ["strolls", "goes down", "holds up"];
    let kept = |text: &str| words.iter().any(|word| text.contains(word));
    assert!(held_out.iter().all(|prompt| kept(&prompt.caption.text)));
    let none = TrialOptions {
        label: "style".into(),
        ..TrialOptions::default()
    };
    let told = Trial::new(&dataset, &none)
        .expect_err("no styles")
        .to_string();
    assert!(told.contains("label `style`"), "{told}");
}

#[test]
fn too_little_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let window = Window {
        clip: 0,
        start: 0,
        frames: 20,
    };
    let features = dataset.features(window).expect("there");
    let examples = vec![(MotionDescription::of(&features), "walk"); 4];
    let told = ContentJudge::new(&examples).expect_err("four").to_string();
    assert!(told.contains("at least 5, found 4"), "{told}");
    let told = ContentJudge::of_dataset(&dataset, Split::Train, "style");
    assert!(told.expect_err("no styles").to_string().contains("found 0"));
}
