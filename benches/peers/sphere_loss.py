"""Times the self-intersection loss of 192 spheres as it is usually written in PyTorch.

From the paper's equations: joint transforms are chained joint by joint, blended by dense weights
(spheres x 22), centres are gathered pair by pair, `sum max(0, r_i + r_j - |c_i - c_j|)^2`, and
autograd goes back to the rotation matrices. The time does not depend on the numbers, so they are
made up; the sizes are those of the embedded proxy.

Usage: sphere_loss.py [FRAMES ...]      as many threads as RAYON_NUM_THREADS, else all cores
"""

import os
import resource
import sys
import time

import torch

SPHERES, PAIRS, JOINTS = 192, 16_759, 22
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]


def joint_transforms(rotations, joints):
    """World transforms from rest of every joint: (frames, joints, 4, 4)."""
    frames = rotations.shape[0]
    offsets = joints.clone()
    offsets[1:] -= joints[PARENTS[1:]]
    top = torch.cat([rotations, offsets.expand(frames, -1, -1)[..., None]], dim=-1)
    bottom = torch.tensor([0.0, 0.0, 0.0, 1.0]).expand(frames, JOINTS, 1, 4)
    local = torch.cat([top, bottom], dim=-2)
    chain = [local[:, 0]]
    for joint in range(1, JOINTS):
        chain.append(chain[PARENTS[joint]] @ local[:, joint])
    world = torch.stack(chain, dim=1)
    moved_rest = world[..., :3, :3] @ joints[..., None]
    translation = world[..., :3, 3:] - moved_rest
    return torch.cat([torch.cat([world[..., :3, :3], translation], dim=-1), bottom], dim=-2)


def loss(rotations, joints, centres, radii, weights, pairs):
    """(frames,) sums of squared depths."""
    frames = rotations.shape[0]
    transforms = joint_transforms(rotations, joints).reshape(frames, JOINTS, 16)
    blended = (weights @ transforms).reshape(frames, SPHERES, 4, 4)
    homogeneous = torch.cat([centres, torch.ones(SPHERES, 1)], dim=1)
    posed = (blended @ homogeneous[None, :, :, None])[..., :3, 0]
    first, second = pairs
    distances = torch.linalg.norm(posed[:, first] - posed[:, second], dim=-1)
    depths = torch.relu(radii[first] + radii[second] - distances)
    return (depths**2).sum(dim=-1)


def main():
    torch.manual_seed(0)
    torch.set_num_threads(int(os.environ.get("RAYON_NUM_THREADS", os.cpu_count())))
    joints, centres = 0.5 * torch.randn(JOINTS, 3), 0.5 * torch.randn(SPHERES, 3)
    radii = 0.03 + 0.05 * torch.rand(SPHERES)
    weights = torch.softmax(5 * torch.randn(SPHERES, JOINTS), dim=1)
    pairs = torch.triu_indices(SPHERES, SPHERES, 1)
    pairs = pairs[:, torch.randperm(pairs.shape[1])[:PAIRS].sort().values]
    print(f"PyTorch {torch.__version__}, {torch.get_num_threads()} threads")
    for frames in map(int, sys.argv[1:] or ["64", "1024"]):
        rotations = torch.linalg.qr(torch.randn(frames, JOINTS, 3, 3)).Q.requires_grad_()
        wall, cpu = [], []
        for _ in range(3 if frames > 4096 else 9):
            rotations.grad = None
            start = time.perf_counter(), time.process_time()
            loss(rotations, joints, centres, radii, weights, pairs).mean().backward()
            wall.append(1e3 * (time.perf_counter() - start[0]))
            cpu.append(1e3 * (time.process_time() - start[1]))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        middle = len(wall) // 2
        print(
            f"frames {frames}: wall {sorted(wall)[middle]:.4f} ms, CPU {sorted(cpu)[middle]:.4f} ms, "
            f"process {peak:.1f} MiB at most"
        )


if __name__ == "__main__":
    main()
