//! glTF files in memory, built array by array.

use base64::Engine as _;
use physique_motion::glb;
use physique_motion::{Error, FrameRate, ReadOptions, SkeletonClip};
use serde_json::{Value, json};

/// A document under construction with one buffer.
pub(crate) struct Gltf {
    pub(crate) json: Value,
    pub(crate) data: Vec<u8>,
}

impl Gltf {
    pub(crate) fn new(nodes: Value) -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "nodes": nodes,
            "accessors": [], "bufferViews": [], "animations": [],
        });
        Self {
            json,
            data: Vec::new(),
        }
    }

    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let (offset, length) = (self.data.len(), bytes.len());
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
        self.push("bufferViews", view)
    }

    pub(crate) fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let count = values.len() / width;
        let accessor =
            json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
        self.push("accessors", accessor)
    }

    pub(crate) fn animate(&mut self, name: &str, tracks: &[(usize, &str, &str, usize, usize)]) {
        let samplers: Vec<Value> = tracks
            .iter()
            .map(|(_, _, interpolation, input, output)| {
                json!({ "input": input, "output": output, "interpolation": interpolation })
            })
            .collect();
        let channels: Vec<Value> = tracks
            .iter()
            .enumerate()
            .map(|(sampler, (node, path, ..))| {
                json!({ "sampler": sampler, "target": { "node": node, "path": path } })
            })
            .collect();
        let animation = json!({ "name": name, "samplers": samplers, "channels": channels });
        self.push("animations", animation);
    }

    /// With the buffer in base64.
    pub(crate) fn text(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.data);
        let uri = format!("data:application/octet-stream;base64,{data}");
        json["buffers"] = json!([{ "byteLength": self.data.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }

    /// With the buffer in a file of this name.
    pub(crate) fn beside(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.data.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }

    pub(crate) fn binary(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.data.len() }]);
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut file = b"glTF\x02\0\0\0".to_vec();
        let word = |length: usize| u32::try_from(length).unwrap().to_le_bytes();
        file.extend(word(28 + json.len() + self.data.len()));
        file.extend(word(json.len()));
        file.extend(b"JSON");
        file.extend(json);
        file.extend(word(self.data.len()));
        file.extend(b"BIN\0");
        file.extend(&self.data);
        file
    }
}

pub(crate) fn parse(bytes: &[u8]) -> Result<Vec<(String, SkeletonClip)>, Error> {
    glb::parse(bytes, "some.glb", &ReadOptions::default())
}

pub(crate) fn only(bytes: &[u8]) -> SkeletonClip {
    let mut clips = parse(bytes).unwrap();
    assert_eq!(clips.len(), 1);
    clips.remove(0).1
}

pub(crate) fn error(gltf: &Gltf) -> String {
    parse(&gltf.text()).unwrap_err().to_string()
}

/// Two nodes, the lower one a metre above the upper.
pub(crate) fn pair() -> Gltf {
    Gltf::new(json!([
        { "name": "a", "children": [1] },
        { "name": "b", "translation": [0.0, 1.0, 0.0] },
    ]))
}

/// The path of node `a` under an interpolation, at 10 frames a second.
pub(crate) fn path(interpolation: &str, times: &[f32], values: &[f32]) -> Vec<f32> {
    let mut gltf = pair();
    let input = gltf.floats("SCALAR", times);
    let values: Vec<f32> = values.iter().flat_map(|&x| [x, 0.0, 0.0]).collect();
    let output = gltf.floats("VEC3", &values);
    gltf.animate("path", &[(0, "translation", interpolation, input, output)]);
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(10.0).unwrap()),
        ..ReadOptions::default()
    };
    let clips = glb::parse(&gltf.text(), "path.gltf", &options).unwrap();
    let clip = &clips[0].1;
    (0..clip.frame_count())
        .map(|frame| clip.translation(frame, 0).x)
        .collect()
}
