//! Time to encode captions.

use divan::Bencher;
use physique_text::{MiniLm, TextEncoder as _};

fn main() {
    divan::main();
}

const CAPTION: &str = "a tired person walks and waves with the left hand";

#[divan::bench]
fn mini_lm_opens() -> MiniLm {
    MiniLm::embedded().unwrap()
}

#[divan::bench(args = [1, 64, 1000])]
fn mini_lm_encodes(bencher: Bencher<'_, '_>, captions: usize) {
    let encoder = MiniLm::embedded().unwrap();
    let captions = vec![CAPTION; captions];
    bencher.bench(|| encoder.encode(&captions));
}
