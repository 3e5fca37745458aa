//! The protocols for people to choose from.

use physique::Protocol;
use physique::measures::measure_names;

/// Name, frame rate, source and measures of every protocol.
pub(crate) fn listed() -> String {
    let mut text = String::new();
    for protocol in Protocol::ALL {
        let about = protocol.about();
        let rate = match protocol.frame_rate() {
            Some(fps) => format!("motions are resampled to {fps:.0} fps"),
            None => "at the motion's own frame rate".to_owned(),
        };
        text += &format!(
            "{protocol}\n    {}\n    {}; {rate}\n",
            about.measures, about.source
        );
        if let Protocol::Published(published) = protocol {
            text += &format!("    measures: {}\n", published.measure_names().join(", "));
        } else {
            let names = measure_names(&[protocol], &physique::Group::ALL);
            text += &format!("    measures: {}\n", names[3..].join(", "));
        }
    }
    text + "All stand on the floor that --floor chooses: zero (default), lowest, estimated or \
            humos-sink.\nFigures compare with published ones only on the same motions and bodies.\n"
}
