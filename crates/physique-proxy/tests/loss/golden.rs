//! A complete proxy whose posed spheres, losses and gradient the published formulation gave in
//! PyTorch (`fixtures/sphere_proxy_posed.npz`: made-up weights, no recorded motion).

use glam::{DVec3, Vec3};
use physique_body::Joint;
use physique_files::npz::{Archive, ArrayLimits};
use physique_proxy::{Pairs, PoseMatrices, SphereBody};

pub(crate) struct Golden {
    archive: Archive,
}

impl Golden {
    pub(crate) fn open() -> Self {
        let bytes = include_bytes!("../fixtures/sphere_proxy_posed.npz").to_vec();
        let archive = Archive::open(bytes, ArrayLimits::default()).expect("a sound archive");
        Self { archive }
    }

    pub(crate) fn array(&mut self, key: &str) -> Vec<f32> {
        let array = self.archive.array(key).expect(key);
        array.to_f32().expect(key)
    }

    fn vectors(&mut self, key: &str) -> Vec<Vec3> {
        let numbers = self.array(key);
        numbers
            .as_chunks()
            .0
            .iter()
            .map(|&xyz| Vec3::from_array(xyz))
            .collect()
    }

    pub(crate) fn body(&mut self) -> SphereBody {
        let weights = self.array("blend_weights");
        let rows = weights.as_chunks::<{ Joint::COUNT }>().0.iter().map(|row| {
            let mut entries = [(0, 0.0); 4];
            let used = row.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
            for (entry, (joint, &weight)) in entries.iter_mut().zip(used) {
                *entry = (joint as u8, weight);
            }
            entries
        });
        SphereBody {
            blend_weights: rows.collect(),
            rest_joints: self.vectors("joints_rest").try_into().expect("22 joints"),
            centres: self.vectors("centers_rest"),
            radii: self.array("radii"),
        }
    }

    pub(crate) fn pairs(&mut self) -> Pairs {
        let excluded = self.archive.array("excluded_pairs").expect("pairs");
        let spheres = excluded.shape()[0];
        let excluded = excluded.to_i64().expect("booleans");
        let all = Pairs::all(spheres).expect("few");
        all.filtered(|i, j| excluded[i * spheres + j] == 0)
    }

    pub(crate) fn poses(&mut self) -> Vec<PoseMatrices> {
        self.array("rotmats").as_chunks().0.as_chunks().0.to_vec()
    }

    pub(crate) fn posed_centres(&mut self) -> Vec<DVec3> {
        let vectors = self.vectors("posed_centers");
        vectors.into_iter().map(Vec3::as_dvec3).collect()
    }
}
