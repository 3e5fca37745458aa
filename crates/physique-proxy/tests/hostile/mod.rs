//! What the tests of hostile proxies share: a sound folder of the published layout, one file of
//! which is another.

use std::fs;
use std::path::{Path, PathBuf};

use physique_proxy::files::{ProxyLimits, parse_proxy, read_published};
use physique_proxy::{Error, SphereProxy};

const SOUND: &str = "tests/fixtures/published";
/// The files of a published folder.
pub(crate) const FILES: [&str; 4] = [
    "SR/sphere_regressor.pth",
    "JR/joint_regressor.pth",
    "boneweights.npy",
    "coll_mat_1jd90.npy",
];

/// The bytes of a file of the sound folder.
pub(crate) fn sound(file: &str) -> Vec<u8> {
    fs::read(Path::new(SOUND).join(file)).unwrap()
}

/// A copy of the sound folder.
pub(crate) struct Published(tempfile::TempDir);

impl Published {
    pub(crate) fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for name in ["SR", "JR"] {
            fs::create_dir(folder.path(name)).unwrap();
        }
        for file in FILES {
            folder.put(file, &sound(file));
        }
        folder
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub(crate) fn put(&self, file: &str, bytes: &[u8]) {
        fs::write(self.path(file), bytes).unwrap();
    }

    /// Reads the folder with other bytes for one file, which is put back.
    pub(crate) fn read_with(
        &self,
        file: &str,
        bytes: &[u8],
        limits: &ProxyLimits,
    ) -> Result<SphereProxy, Error> {
        self.put(file, bytes);
        let found = read_published(self.0.path(), limits);
        self.put(file, &sound(file));
        found
    }

    /// Reads a file of ours, or one that stands for a file of the published layout.
    pub(crate) fn read(
        &self,
        name: &str,
        stands_for: Option<&str>,
        bytes: &[u8],
        limits: &ProxyLimits,
    ) -> Result<SphereProxy, Error> {
        match stands_for {
            Some(file) => self.read_with(file, bytes, limits),
            None => parse_proxy(name, bytes, limits),
        }
    }
}

/// Whatever is read gives spheres and pairs, or says why not.
pub(crate) fn use_proxy(proxy: &SphereProxy) {
    if let Ok(body) = proxy.normalised(&[1.0])
        && body.check().is_ok()
    {
        let turn = glam::Mat3::IDENTITY.to_cols_array();
        let mut centres = Vec::new();
        body.pose(&[turn; 22], &mut centres);
        assert_eq!(centres.len(), proxy.sphere_count());
    }
    let _ = proxy.pairs();
}
