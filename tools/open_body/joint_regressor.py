"""Joints as convex combinations of few vertices, fitted to how MakeHuman's joints move with shape."""

import numpy as np
from scipy.optimize import nnls
from scipy.spatial import cKDTree

import skeleton

NEAREST = 500  # candidate vertices near the joint
SLAB_HALF_HEIGHT = 0.06  # and those at its height, in metres,
SLAB_HALF_WIDTH = {"trunk": 0.25, "limb": 0.12}  # this close to it sideways
COMPONENTS = 30  # of the shape space that the joints must follow
EMPHASIS = 3.0  # of position and sum against
SPREAD = 5e-3  # the ridge that spreads the weight over more vertices
SMALLEST_SHARE = 0.01  # of the largest weight; below it a vertex is dropped


def fit(vertices, directions, joints, joint_directions, mirror):
    """Returns dense rows (22, vertices), non-negative, each summing to 1, exactly mirrored.

    `directions` (components, vertices, 3) and `joint_directions` (components, 22, 3) move together.
    """
    rows = np.zeros((len(skeleton.NAMES), len(vertices)))
    tree = cKDTree(vertices)
    for j, name in enumerate(skeleton.NAMES):
        if name.startswith("right"):
            continue
        near = _candidates(vertices, tree, joints[j], name)
        # One equation for each coordinate of the mean and of each direction, and one for the sum.
        system = [EMPHASIS * np.ones((1, len(near))), EMPHASIS * vertices[near].T]
        system += list(EMPHASIS * directions[:, near].transpose(0, 2, 1))
        wanted = EMPHASIS * np.concatenate([[1.0], joints[j], joint_directions[:, j].ravel()])
        system = np.vstack([*system, SPREAD * np.eye(len(near))])
        weights, _ = nnls(system, np.concatenate([wanted, np.zeros(len(near))]), maxiter=20 * len(near))
        weights[weights < SMALLEST_SHARE * weights.max()] = 0
        rows[j, near] = weights / weights.sum()
        if name.startswith("left"):
            rows[skeleton.MIRROR[j], mirror] = rows[j]
        else:
            rows[j] = (rows[j] + rows[j, mirror]) / 2
    return rows


def _candidates(vertices, tree, joint, name):
    kind = "limb" if name.startswith("left") else "trunk"
    _, near = tree.query(joint, k=NEAREST)
    level = np.abs(vertices[:, 1] - joint[1]) < SLAB_HALF_HEIGHT
    beside = np.abs(vertices[:, 0] - joint[0]) < SLAB_HALF_WIDTH[kind]
    return np.unique(np.concatenate([near, np.nonzero(level & beside)[0]]))
