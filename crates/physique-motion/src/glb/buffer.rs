//! The document under construction, and the one buffer that all its arrays lie in.

use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Index, Root, Value};

/// A glTF document and its binary data.
pub(super) struct Buffer {
    pub(super) root: Root,
    pub(super) data: Vec<u8>,
}

impl Buffer {
    pub(super) fn new() -> Self {
        let mut root = Root::default();
        root.asset.generator = Some(concat!("Physique ", env!("CARGO_PKG_VERSION")).into());
        let data = Vec::new();
        // Its length is known at the end.
        root.push(gltf_json::Buffer {
            byte_length: USize64(0),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        Self { root, data }
    }

    /// Adds an array of numbers, of `N` components each.
    pub(super) fn floats<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        target: Option<Target>,
    ) -> Index<Accessor> {
        let bytes = values
            .iter()
            .flatten()
            .flat_map(|value| value.to_le_bytes());
        let kind = match N {
            1 => Type::Scalar,
            3 => Type::Vec3,
            4 => Type::Vec4,
            _ => Type::Mat4,
        };
        self.add(
            bytes.collect(),
            values.len(),
            ComponentType::F32,
            kind,
            target,
        )
    }

    /// Adds an array of numbers with its smallest and largest, as positions and times need.
    pub(super) fn bounded_floats<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        target: Option<Target>,
    ) -> Index<Accessor> {
        let bound = |better: fn(f32, f32) -> f32| {
            let bounds = values
                .iter()
                .copied()
                .reduce(|a, b| std::array::from_fn(|axis| better(a[axis], b[axis])));
            // Written as the exact value of the 32-bit number.
            bounds.map(|bounds| Value::from(bounds.map(f64::from).to_vec()))
        };
        let (min, max) = (bound(f32::min), bound(f32::max));
        let index = self.floats(values, target);
        if let Some(accessor) = self.root.accessors.last_mut() {
            (accessor.min, accessor.max) = (min, max);
        }
        index
    }

    /// Adds an array of four bytes each.
    pub(super) fn bytes(&mut self, values: &[[u8; 4]], target: Option<Target>) -> Index<Accessor> {
        let bytes = values.as_flattened().to_vec();
        self.add(bytes, values.len(), ComponentType::U8, Type::Vec4, target)
    }

    /// Adds corners of triangles, in 16 bits where that is enough.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> Index<Accessor> {
        let corners = triangles.as_flattened();
        let (bytes, component) = if vertices <= usize::from(u16::MAX) {
            let narrow = corners
                .iter()
                .flat_map(|&corner| (corner as u16).to_le_bytes());
            (narrow.collect(), ComponentType::U16)
        } else {
            let wide = corners.iter().flat_map(|corner| corner.to_le_bytes());
            (wide.collect(), ComponentType::U32)
        };
        let target = Some(Target::ElementArrayBuffer);
        self.add(bytes, corners.len(), component, Type::Scalar, target)
    }

    fn add(
        &mut self,
        bytes: Vec<u8>,
        count: usize,
        component: ComponentType,
        kind: Type,
        target: Option<Target>,
    ) -> Index<Accessor> {
        // Every array starts at a multiple of its components' size.
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let view = self.root.push(View {
            buffer: Index::new(0),
            byte_length: bytes.len().into(),
            byte_offset: Some(self.data.len().into()),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: Default::default(),
        });
        self.data.extend(bytes);
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: count.into(),
            component_type: Checked::Valid(GenericComponentType(component)),
            type_: Checked::Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        })
    }
}
