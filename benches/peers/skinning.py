"""Times linear blend skinning as it is usually written in PyTorch, from the SMPL paper's equations.

Joint transforms are chained joint by joint, blended by dense weights (vertices x 22) in one matrix
product and applied to homogeneous vertices: 64 frames a batch, as many threads as Physique uses.
"""

import os
import time

import torch

VERTICES, JOINTS, FRAMES = 6889, 22, 64
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]


def joint_transforms(rotations, joints):
    """World transforms from rest of every joint: (frames, joints, 4, 4)."""
    frames = rotations.shape[0]
    offsets = joints.clone()
    offsets[1:] -= joints[PARENTS[1:]]
    local = torch.zeros(frames, JOINTS, 4, 4)
    local[..., :3, :3] = rotations
    local[..., :3, 3] = offsets
    local[..., 3, 3] = 1
    chain = [local[:, 0]]
    for joint in range(1, JOINTS):
        chain.append(chain[PARENTS[joint]] @ local[:, joint])
    world = torch.stack(chain, dim=1)
    moved_rest = (world[..., :3, :3] @ joints[..., None])[..., 0]
    from_rest = world.clone()
    from_rest[..., :3, 3] -= moved_rest
    return from_rest


def skin(rotations, joints, vertices, weights):
    """Posed vertices: (frames, vertices, 3)."""
    transforms = joint_transforms(rotations, joints).reshape(FRAMES, JOINTS, 16)
    blended = (weights @ transforms).reshape(FRAMES, VERTICES, 4, 4)
    homogeneous = torch.cat([vertices, torch.ones(VERTICES, 1)], dim=1)
    return (blended @ homogeneous[None, :, :, None])[..., :3, 0]


def main():
    torch.manual_seed(0)
    torch.set_num_threads(int(os.environ.get("RAYON_NUM_THREADS", os.cpu_count())))
    rotations = torch.linalg.qr(torch.randn(FRAMES, JOINTS, 3, 3)).Q
    joints, vertices = torch.randn(JOINTS, 3), torch.randn(VERTICES, 3)
    weights = torch.softmax(5 * torch.randn(VERTICES, JOINTS), dim=1)
    times = []
    with torch.inference_mode():
        for _ in range(40):
            start = time.perf_counter()
            skin(rotations, joints, vertices, weights)
            times.append(1e3 * (time.perf_counter() - start))
    median = sorted(times[5:])[len(times[5:]) // 2]
    print(f"PyTorch {torch.__version__}, {torch.get_num_threads()} threads, {FRAMES} frames")
    print(f"milliseconds a batch: {median:.3f}")


if __name__ == "__main__":
    main()
