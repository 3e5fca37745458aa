//! The embedded proxy of the open body, and real poses.

use physique_body::{Body, open_body};
use physique_motion::embedded;
use physique_proxy::{Pairs, PoseMatrices, SphereBody, open_proxy, pose_matrices};

/// The 192 spheres of the mean body, in metres, and the pairs that the paper compares.
pub(crate) fn body_and_pairs() -> (SphereBody, Pairs) {
    let body = Body::new(open_body().expect("embedded"), &[]).expect("mean shape");
    let proxy = open_proxy().expect("embedded");
    let spheres = proxy.of_body(&body).expect("a body with extent");
    (spheres, proxy.pairs().expect("few"))
}

/// Poses of all embedded clips, one after the other.
pub(crate) fn poses() -> Vec<PoseMatrices> {
    let mut poses = Vec::new();
    for clip in embedded::clips() {
        let motion = clip.load().expect("embedded").motion;
        poses.extend((0..motion.frame_count()).map(|f| pose_matrices(motion.frame_rotations(f))));
    }
    poses
}
