//! All arrays of a file by name, whatever the file is.

use crate::npz::{Array, ArrayLimits};
use crate::pickle::PickleLimits;
use crate::{Data, Error};

/// All numeric arrays of a `.npy`, `.npz`, `.pkl` or `.pt` file, told apart by content.
///
/// Arrays in dictionaries, lists and objects are named by their path: `motion`, `people.0.pose`,
/// `shapedirs.x`. The array of a `.npy` without a name of its own is called `array`. Other
/// values, such as text and single numbers, are passed over; arrays of objects in a `.npz` are
/// looked into. Cost: a copy of every array.
///
/// # Errors
/// As [`Data::read`].
pub fn named_arrays(
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<Vec<Array>, Error> {
    let mut found = Vec::new();
    collect(Data::read(bytes, arrays, pickles)?, &mut found);
    Ok(found)
}

/// In the order of the file; the depth of [`Data`] is bounded.
fn collect(data: Data, found: &mut Vec<Array>) {
    match data {
        Data::Array(array) => found.push(array),
        Data::List(items) => items.into_iter().for_each(|item| collect(item, found)),
        Data::Dict(entries) => entries
            .into_iter()
            .for_each(|(_, value)| collect(value, found)),
        Data::Number(_) | Data::Text(_) | Data::Other(_) => {}
    }
}
