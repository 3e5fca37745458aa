//! Clocks that other programs do not disturb, on Linux.

use std::fs;

/// Milliseconds that all threads of this process have run.
pub(crate) fn processor_milliseconds() -> Result<f64, Box<dyn std::error::Error>> {
    // The kernel books a running thread's time when it pauses.
    std::thread::yield_now();
    let mut nanoseconds = 0.0;
    for thread in fs::read_dir("/proc/self/task")? {
        let times = fs::read_to_string(thread?.path().join("schedstat"))?;
        nanoseconds += times.split(' ').next().unwrap_or_default().parse::<f64>()?;
    }
    Ok(1e-6 * nanoseconds)
}

#[allow(dead_code)] // Not every example measures more than once.
/// The middle one, or the later of the two.
pub(crate) fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
