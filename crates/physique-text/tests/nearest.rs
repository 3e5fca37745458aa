//! Prompts outside what a model knows are far from its captions.

use physique_text::{CaptionIndex, Error, MiniLm};

#[test]
fn known_prompts_are_near_and_others_far() {
    let encoder = MiniLm::embedded().unwrap();
    let captions = [
        "a person walks forward",
        "a person runs forward",
        "a person waves with the left hand",
        "a person waves with the right hand",
        "a person raises both hands",
        "a person takes a bow",
    ];
    let index = CaptionIndex::new(&encoder, &captions).unwrap();
    let same = index.nearest(&encoder, &captions);
    for (number, nearest) in same.iter().enumerate() {
        assert_eq!(nearest.caption, number);
        assert!(nearest.distance.abs() < 1e-5, "{}", nearest.distance);
    }
    let held_out = [
        "someone is waving their left hand",
        "someone is waving their right hand",
        "a man jogs straight ahead",
        "both arms are lifted up",
    ];
    let near: Vec<usize> = index
        .nearest(&encoder, &held_out)
        .iter()
        .map(|n| n.caption)
        .collect();
    assert_eq!(near, [2, 3, 1, 4]);
    let usual = index.usual_distance(&encoder, &held_out).unwrap();
    let strange = [
        "the stock market fell sharply",
        "a recipe for apple pie",
        "quantum physics",
    ];
    for (prompt, nearest) in strange.iter().zip(index.nearest(&encoder, &strange)) {
        assert!(
            nearest.distance > usual,
            "{prompt}: {} of {usual}",
            nearest.distance
        );
    }
    assert!(index.usual_distance(&encoder, &[]).is_none());
    assert!(matches!(
        CaptionIndex::new(&encoder, &[]),
        Err(Error::NoCaptions)
    ));
}
