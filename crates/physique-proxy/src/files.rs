//! Proxies in files: our own layout, and the published one.

mod published;
mod read;
mod write;

pub use published::read_published;
pub use read::{parse_proxy, read_proxy};
pub use write::{Precision, proxy_bytes, write_proxy};

/// What a proxy file may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProxyLimits {
    /// Bytes of a file.
    pub bytes: u64,
    /// Numbers in all regressors together.
    pub parameters: usize,
    /// Spheres.
    pub spheres: usize,
}

impl Default for ProxyLimits {
    fn default() -> Self {
        Self {
            bytes: 1 << 28,
            parameters: 1 << 25,
            spheres: 4_096,
        }
    }
}

/// What a file of ours says it is.
const FORMAT: &str = "physique-proxy 1";
/// Names of our arrays; regressors' arrays follow their prefix under the published names.
const SPHERES: &str = "spheres.";
const JOINTS: &str = "joints.";
const BLEND_WEIGHTS: &str = "blend_weights";
const STATISTICS: &str = "pair_intersections";
const CHOSEN: &str = "pairs";
