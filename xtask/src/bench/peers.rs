//! The usual formulations in PyTorch, timed beside ours.

use std::process::Command;

use anyhow::Result;

use super::Row;
use crate::python::environment;
use crate::shell::{cargo, output, root};

/// Times dense linear blend skinning in PyTorch on the same machine and prints the ratio.
pub(super) fn skinning(rows: &[Row]) -> Result<()> {
    let folder = root().join("benches/peers");
    let python = environment("peers", &folder.join("requirements.txt"))?;
    let printed = output(
        "PyTorch skinning",
        Command::new(python).arg(folder.join("skinning.py")),
    )?;
    print!("{printed}");
    let peer = printed.lines().find_map(|line| {
        line.strip_prefix("milliseconds a batch: ")?
            .parse::<f64>()
            .ok()
    });
    let ours = rows
        .iter()
        .find(|row| row.name == "batch_of_64_frames_all_threads");
    if let (Some(peer), Some(ours)) = (peer, ours) {
        println!(
            "skinning 64 frames: PyTorch {peer:.3} ms, Physique {:.3} ms, ratio {:.1} (goal 15)",
            ours.milliseconds,
            peer / ours.milliseconds
        );
    }
    Ok(())
}

/// Times the sphere loss here and in PyTorch, one after the other, and prints the ratios of processor
/// times.
pub(super) fn sphere_loss() -> Result<()> {
    const SIZES: [&str; 3] = ["64", "1024", "12544"];
    let example = ["run", "--release", "-p", "physique-proxy"];
    let mut ours = cargo(&example);
    ours.args(["--example", "sphere_loss_speed", "--"])
        .args(SIZES);
    let ours = output("sphere loss", &mut ours)?;
    print!("{ours}");
    let folder = root().join("benches/peers");
    let python = environment("peers", &folder.join("requirements.txt"))?;
    let mut peer = Command::new(python);
    let peer = output(
        "PyTorch sphere loss",
        peer.arg(folder.join("sphere_loss.py")).args(SIZES),
    )?;
    print!("{peer}");
    let best = processor_times(&ours);
    for (frames, peer) in processor_times(&peer) {
        // The first line of a size is the best backend's.
        if let Some((_, ours)) = best.iter().find(|(of, _)| *of == frames) {
            println!(
                "sphere loss, {frames} frames: ratio {:.0} (goals 3000 at 1024, 2000 at 12544)",
                peer / ours
            );
        }
    }
    Ok(())
}

/// Times steps of training here and in PyTorch, the published network and the small one, and prints the
/// ratios of processor times.
pub(super) fn step_time() -> Result<()> {
    /// Networks, and how many steps of each are enough.
    const CASES: [(&str, &str); 2] = [("small", "10"), ("large", "2")];
    let folder = root().join("benches/peers");
    for (network, steps) in CASES {
        let arguments = ["--example", "step_time", "--", network, steps];
        let mut ours = cargo(&["run", "--release", "-p", "physique-learn"]);
        let ours = output("steps of training", ours.args(arguments))?;
        print!("{ours}");
        let python = environment("peers", &folder.join("requirements.txt"))?;
        let mut peer = Command::new(python);
        peer.arg(folder.join("step_time.py")).args([network, steps]);
        let peer = output("PyTorch's steps of training", &mut peer)?;
        print!("{peer}");
        if let (Some(ours), Some(peer)) = (step_seconds(&ours), step_seconds(&peer)) {
            println!("step of training, {network}: ratio {:.2}", peer / ours);
        }
    }
    Ok(())
}

/// Processor seconds of a line like `small: wall 0.2 s, CPU 0.4 s a step, process 9 MiB at most`.
fn step_seconds(printed: &str) -> Option<f64> {
    let time = printed.split_once("CPU ")?.1.split_once(" s a step")?.0;
    time.parse().ok()
}

/// Frames and processor milliseconds of lines like `frames 64, AVX2: wall 1 ms, CPU 2 ms`.
fn processor_times(printed: &str) -> Vec<(u32, f64)> {
    let line = |line: &str| {
        let frames = line.strip_prefix("frames ")?;
        let digits = frames.find(|letter: char| !letter.is_ascii_digit())?;
        let time = line.split_once("CPU ")?.1.split_once(" ms")?.0;
        Some((frames[..digits].parse().ok()?, time.parse().ok()?))
    };
    printed.lines().filter_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::{processor_times, step_seconds};

    #[test]
    fn reads_steps_of_training() {
        let printed = "small: PyTorch 2, 1 threads, wall 0.5 s, CPU 0.25 s a step, process 9 MiB";
        assert_eq!(step_seconds(printed), Some(0.25));
        assert_eq!(step_seconds("small: wall 0.5 s"), None);
    }

    #[test]
    fn reads_processor_times() {
        let printed = "17 pairs\nframes 64, AVX-512: wall 0.02 ms, CPU 0.03 ms, 9 kB\n\
                       frames 1024: wall 800.5 ms, CPU 1600.25 ms, process 9 MiB at most\n";
        assert_eq!(processor_times(printed), [(64, 0.03), (1024, 1600.25)]);
    }
}
