//! What training steps see.

mod support;

use std::collections::HashMap;

use physique_data::{Balance, Order, Sampler, SamplerOptions, Split};
use support::{RECIPE, built, folder};

fn options(order: Order) -> SamplerOptions {
    SamplerOptions {
        order,
        ..SamplerOptions::default()
    }
}

#[test]
fn a_pass_sees_every_clip_once_and_a_step_is_a_pure_function() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let sampler = Sampler::new(&dataset, options(Order::Passes)).unwrap();
    assert_eq!(sampler.clip_count(), 6);
    assert_eq!(sampler.steps_a_pass(2), 3);
    let mut orders = Vec::new();
    for pass in 0..4 {
        let steps = (0..3).map(|step| sampler.draw(10, 3 * pass + step, 2));
        let drawn: Vec<usize> = steps.flatten().map(|drawn| drawn.window.clip).collect();
        let mut sorted = drawn.clone();
        sorted.sort_unstable();
        let expected: Vec<usize> = dataset.clips_of(Split::Train).collect();
        assert_eq!(sorted, expected);
        orders.push(drawn);
    }
    orders.dedup();
    assert_eq!(orders.len(), 4, "every pass has an order of its own");

    let again = Sampler::new(&dataset, options(Order::Passes)).unwrap();
    assert_eq!(again.draw(10, 7, 2), sampler.draw(10, 7, 2));
    let (a, b): (Vec<_>, Vec<_>) = (0..9)
        .map(|step| (sampler.draw(11, step, 2), sampler.draw(10, step, 2)))
        .unzip();
    assert_ne!(a, b);
}

#[test]
fn windows_are_within_clips_and_captions_belong_to_them() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let index = dataset.index();
    let sampler = Sampler::new(&dataset, options(Order::BalancedBy("content".into()))).unwrap();
    let mut lengths: HashMap<usize, usize> = HashMap::new();
    let mut contents: HashMap<&str, usize> = HashMap::new();
    for drawn in (0..400).flat_map(|step| sampler.draw(10, step, 8)) {
        let clip = &index.clips[drawn.window.clip];
        assert_eq!(clip.split, Split::Train);
        assert!(drawn.window.start + drawn.window.frames <= clip.frames);
        assert!(drawn.window.frames.is_multiple_of(4));
        dataset.features(drawn.window).unwrap();
        let set = &index.caption_sets[clip.captions];
        assert!(set.training.contains(&drawn.caption.unwrap()));
        *lengths.entry(drawn.window.frames).or_default() += 1;
        *contents.entry(&clip.labels["content"]).or_default() += 1;
    }
    assert!(
        *lengths.keys().max().unwrap() <= 40,
        "the longest window has 2 s: {lengths:?}"
    );
    // Seconds are a fraction of a walk's two clips each for the turns: the square root evens it out.
    let walk = index.clips.iter().filter(|clip| clip.split == Split::Train);
    let mut rows: HashMap<&str, usize> = HashMap::new();
    for clip in walk {
        *rows.entry(&clip.labels["content"]).or_default() += clip.frames;
    }
    let total: f64 = rows.values().map(|&rows| (rows as f64).sqrt()).sum();
    for (content, rows) in rows {
        let expected = 3200.0 * (rows as f64).sqrt() / total;
        let found = contents[content] as f64;
        // Five standard deviations of a binomial of 3200 draws are below 142.
        assert!(
            (found - expected).abs() < 142.0,
            "{content}: {found}, expected {expected}"
        );
    }
}

#[test]
fn favoured_values_are_drawn_more_often() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let count = |favoured: &[(&str, f64)], content: &str| {
        let balance = Balance {
            favoured: favoured.iter().map(|&(v, f)| (v.to_owned(), f)).collect(),
            ..Balance::from("content")
        };
        let sampler = Sampler::new(&dataset, options(Order::BalancedBy(balance))).unwrap();
        let drawn = (0..400).flat_map(|step| sampler.draw(10, step, 8));
        let clips = drawn.map(|drawn| &dataset.index().clips[drawn.window.clip]);
        clips
            .filter(|clip| clip.labels["content"] == content)
            .count() as f64
            / 3200.0
    };
    let even = count(&[], "walk");
    let favoured = count(&[("walk", 3.0)], "walk");
    let expected = 3.0 * even / (1.0 + 2.0 * even);
    // Five standard deviations of each of the two shares come to less than 0.09.
    assert!(
        favoured > even + 0.1 && (favoured - expected).abs() < 0.09,
        "{even} {favoured}"
    );

    for (value, factor) in [
        ("wlak", 2.0),
        ("walk", 0.0),
        ("walk", f64::NAN),
        ("walk", f64::INFINITY),
    ] {
        let balance = Balance {
            favoured: [(value.to_owned(), factor)].into(),
            ..Balance::from("content")
        };
        let error = Sampler::new(&dataset, options(Order::BalancedBy(balance))).unwrap_err();
        let message = error.to_string();
        assert!(
            message.contains(value) && message.contains("walk"),
            "{message}"
        );
    }
}

#[test]
fn nothing_to_draw_is_an_error() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let nothing = SamplerOptions {
        split: Split::Validation,
        ..SamplerOptions::default()
    };
    let problem = Sampler::new(&dataset, nothing).unwrap_err().to_string();
    assert!(problem.contains("validation"), "{problem}");
}
