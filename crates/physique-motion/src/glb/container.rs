//! The GLB container: a header, the JSON chunk and the binary chunk.

use super::buffer::Buffer;

/// Header of the file, and of each chunk.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The bytes of the file; `Err` says what glTF cannot hold.
pub(super) fn pack(buffer: Buffer) -> Result<Vec<u8>, String> {
    let Buffer { mut root, mut data } = buffer;
    for whole in &mut root.buffers {
        whole.byte_length = data.len().into();
    }
    let mut json = gltf_json::serialize::to_vec(&root).map_err(|error| error.to_string())?;
    // Chunks end at multiples of four: JSON padded with spaces, data with zeros.
    json.resize(json.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);

    let length = HEADER + 2 * CHUNK_HEADER + json.len() + data.len();
    let word = |length: usize| {
        let short = u32::try_from(length).map(u32::to_le_bytes);
        short.map_err(|_| format!("{length} bytes are more than its 4 GiB"))
    };
    let mut file = Vec::with_capacity(length);
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend(word(length)?);
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", data)] {
        file.extend(word(chunk.len())?);
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}
