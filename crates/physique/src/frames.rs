//! Frames in parallel, results in order: the same for any number of threads.

use rayon::prelude::*;

use crate::Error;

/// Frames that one thread takes at once: enough to pay for its scratch space.
const FRAMES_A_TASK: usize = 32;

/// Measures frames `0..count`; every thread makes its own `meter` once.
///
/// `progress` is called with the number of frames done since the last call, from any thread.
pub(crate) fn measure_frames<Meter, Measured: Send>(
    count: usize,
    meter: impl Fn() -> Result<Meter, Error> + Sync,
    measure: impl Fn(&mut Meter, usize) -> Result<Measured, Error> + Sync,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<Measured>, Error> {
    let starts: Vec<_> = (0..count).step_by(FRAMES_A_TASK).collect();
    let tasks = starts
        .into_par_iter()
        .map_init(
            || None,
            |scratch, start| {
                let meter = match scratch {
                    Some(meter) => meter,
                    None => scratch.insert(meter()?),
                };
                let end = (start + FRAMES_A_TASK).min(count);
                let frames = (start..end).map(|frame| measure(meter, frame)).collect();
                progress(end - start);
                frames
            },
        )
        .collect::<Result<Vec<Vec<_>>, Error>>()?;
    Ok(tasks.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn results_come_in_order_and_progress_adds_up() {
        let done = AtomicUsize::new(0);
        let measured = measure_frames(
            1000,
            || Ok(()),
            |(), frame| Ok(frame),
            |frames| {
                done.fetch_add(frames, Ordering::Relaxed);
            },
        );
        assert!(measured.unwrap().into_iter().eq(0..1000));
        assert_eq!(done.into_inner(), 1000);
    }

    #[test]
    fn the_first_error_ends_it() {
        let fail = |(): &mut (), frame: usize| match frame {
            500 => Err(Error::NoFrames),
            _ => Ok(()),
        };
        assert!(measure_frames(1000, || Ok(()), fail, |_| ()).is_err());
        let no_meter = || Err::<(), _>(Error::NoFrames);
        assert!(measure_frames(1, no_meter, |_, _| Ok(()), |_| ()).is_err());
    }
}
