"""Turns MakeHuman's A-pose into the T-pose, for all body shapes at once.

Each bone gets one world rotation, the same for every shape. Then a posed vertex is still linear in the
targets, and posing the base mesh and each target once is enough:
    v' = sum over bones b of w_b (R_b (v - head_b) + head'_b).
"""

from dataclasses import dataclass

import numpy as np

import skeleton


@dataclass
class LinearBody:
    """A body that is linear in mixing coefficients: row 0 is the base mesh, row 1 + t is target t."""

    vertices: np.ndarray  # (1 + targets, vertices, 3)
    joints: np.ndarray  # (1 + targets, 22, 3)
    blend_weights: np.ndarray  # (vertices, 22)

    def mix(self, coefficients):
        """Vertices (..., vertices, 3) of the shapes with coefficients (..., targets)."""
        return _mixed(self.vertices, coefficients)

    def mix_joints(self, coefficients):
        """Joints (..., 22, 3) of the shapes with coefficients (..., targets)."""
        return _mixed(self.joints, coefficients)

    def along(self, directions):
        """Displacements of vertices and of joints along directions (..., targets) in coefficients."""
        return np.tensordot(directions, self.vertices[1:], 1), np.tensordot(directions, self.joints[1:], 1)


def _mixed(fields, coefficients):
    return fields[0] + np.tensordot(coefficients, fields[1:], 1)


def _direction(outward, up, forward):
    vector = np.array([outward, up, forward])
    return vector / np.linalg.norm(vector)


# Our own choice of T-pose, in whole degrees, near the pose in which SMPL's rotations are zero, so that
# motions recorded for SMPL's limbs carry over.
_ARM_DOWN, _ARM_BACK = np.tan(np.radians([3.0, 6.0]))
_FOREARM_UP = np.tan(np.radians(2.0))
_HAND_DOWN, _HAND_BACK = np.tan(np.radians([2.0, 5.0]))
_THIGH_OUT = np.tan(np.radians(5.0))
_SHANK_IN, _SHANK_BACK = np.tan(np.radians([2.0, 6.0]))
UPPER_ARM = _direction(1, -_ARM_DOWN, -_ARM_BACK)
FOREARM = _direction(1, _FOREARM_UP, 0)
HAND = _direction(1, -_HAND_DOWN, -_HAND_BACK)
THIGH = _direction(_THIGH_OUT, -1, 0)
SHANK = _direction(-_SHANK_IN, -1, -_SHANK_BACK)
TOES_OUT = np.radians(12.0)
# MakeHuman's women press their small toes into one another: spread them, in degrees outward.
TOE_SPREAD = {"toe1-1": -2.0, "toe2-1": 0.0, "toe3-1": 1.0, "toe4-1": 4.0, "toe5-1": 10.0}
# Raising the arms lifts the shoulder girdle, each bone of it a share.
CLAVICLE_LIFT, SCAPULA_LIFT = np.radians([10.0, 18.0])
# The hand's twist against the elbow, spread along the arm as the two bones of the forearm do.
TWIST_SHARE = {"upperarm02": 0.15, "lowerarm01": 0.35, "lowerarm02": 0.75}


def pose(mesh, targets, rig, skin, neutral):
    """The T-posed LinearBody of the vertices `skin`; `neutral` are the coefficients that set the rotations."""
    fields = np.concatenate([mesh.vertices[None], targets])
    heads = np.stack([fields[:, rig.head[name]].mean(axis=1) for name in rig.names], axis=1)
    joints = skeleton.positions(fields, mesh)
    mix = np.concatenate([[1.0], neutral])
    rotation = _bone_rotations(rig, mesh, np.tensordot(mix, fields, 1), np.tensordot(mix, joints, 1))

    index = {name: i for i, name in enumerate(rig.names)}
    posed_heads = np.zeros_like(heads)
    for i, name in enumerate(rig.names):  # parents come first
        if rig.parent[name] is None:
            posed_heads[:, i] = heads[:, i]
        else:
            p = index[rig.parent[name]]
            posed_heads[:, i] = posed_heads[:, p] + (heads[:, i] - heads[:, p]) @ rotation[p].T

    weights = rig.weights[skin] / rig.weights[skin].sum(axis=1, keepdims=True)
    rest = fields[:, skin]
    vertices = np.zeros_like(rest)
    for i in range(len(rig.names)):
        moved = np.nonzero(weights[:, i])[0]
        posed = (rest[:, moved] - heads[:, None, i]) @ rotation[i].T + posed_heads[:, None, i]
        vertices[:, moved] += weights[moved, i, None] * posed

    carriers = [index[joint.carrier] for joint in skeleton.JOINTS]
    posed_joints = np.stack(
        [(joints[:, j] - heads[:, b]) @ rotation[b].T + posed_heads[:, b] for j, b in enumerate(carriers)], axis=1
    )
    merged = np.zeros((len(skin), len(skeleton.NAMES)))
    np.add.at(merged.T, skeleton.joint_of_bone(rig), weights.T)
    return _with_fixed_pelvis(LinearBody(vertices, posed_joints, merged))


def _with_fixed_pelvis(body):
    """Moves every shape so that its pelvis joint lies at the same point."""
    hips = [skeleton.NAMES.index("left_hip"), skeleton.NAMES.index("right_hip")]
    body.joints[:, hips, 0] *= skeleton.HIP_WIDTH
    pelvis = body.joints[:, 0].copy()
    pelvis[:, 0] = 0.0
    pelvis[:, 2] = body.joints[:, hips, 2].mean(axis=1)
    pelvis[0, 2] += skeleton.PELVIS_IN_FRONT_OF_HIPS
    body.joints[:, 0] = pelvis
    shift = -pelvis
    shift[0] += skeleton.PELVIS
    body.vertices += shift[:, None]
    body.joints += shift[:, None]
    return body


def _bone_rotations(rig, mesh, vertices, joints):
    """World rotations (bones, 3, 3): chosen on the left, reflected to the right, none on the trunk."""
    at = dict(zip(skeleton.NAMES, joints))
    chosen = _left_rotations(at, lambda name: vertices[mesh.helper(name)].mean(axis=0))
    reflection = np.diag([-1.0, 1.0, 1.0])
    rotation = {}
    for name in rig.names:  # parents come first; a bone that is not chosen follows its parent
        stem, _, side = name.partition(".")
        if stem in chosen and side:
            left = chosen[stem]
            rotation[name] = left if side == "L" else reflection @ left @ reflection
        else:
            rotation[name] = rotation.get(rig.parent[name], np.eye(3))
    return np.stack([rotation[name] for name in rig.names])


def _left_rotations(at, helper):
    thigh = _between(at["left_knee"] - at["left_hip"], THIGH)
    shank = _between(at["left_ankle"] - at["left_knee"], SHANK)
    foot = at["left_foot"] - at["left_ankle"]
    upper_arm = _between(at["left_elbow"] - at["left_shoulder"], UPPER_ARM)
    forearm = _between(upper_arm @ (at["left_wrist"] - at["left_elbow"]), FOREARM) @ upper_arm

    # Palm down, index finger forward.
    along = helper("joint-l-finger-3-1") - at["left_wrist"]
    across = helper("joint-l-finger-2-1") - helper("joint-l-finger-5-1")
    hand = _frame(HAND, np.array([0.0, 0.0, 1.0])) @ _frame(along, across).T
    twist = _angle_about(FOREARM, hand @ forearm.T)
    base = {"upperarm02": upper_arm, "lowerarm01": forearm, "lowerarm02": forearm}
    up = np.array([0.0, 1.0, 0.0])
    foot_yaw = _turn(up, TOES_OUT - np.arctan2(foot[0], foot[2]))
    toes = {bone: _turn(up, np.radians(outward)) @ foot_yaw for bone, outward in TOE_SPREAD.items()}
    twisted = {bone: _turn(FOREARM, share * twist) @ base[bone] for bone, share in TWIST_SHARE.items()}
    return {
        "upperleg01": thigh,
        "upperleg02": thigh,
        "lowerleg01": shank,
        "lowerleg02": shank,
        "foot": foot_yaw,
        **toes,
        "clavicle": _turn(np.array([0.0, 0.0, 1.0]), CLAVICLE_LIFT),
        "shoulder01": _turn(np.array([0.0, 0.0, 1.0]), SCAPULA_LIFT),
        "upperarm01": upper_arm,
        **twisted,
        "wrist": hand,
    }


def _cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _between(a, b):
    """The shortest rotation from direction a to direction b."""
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    k = _cross_matrix(np.cross(a, b))
    return np.eye(3) + k + k @ k / (1 + a @ b)


def _turn(axis, angle):
    k = _cross_matrix(axis)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def _angle_about(axis, rotation):
    """The twist of a rotation about an axis (swing-twist decomposition)."""
    skew = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    return 2 * np.arctan2(skew @ axis, 1 + np.trace(rotation))


def _frame(x, y):
    """Columns: x normalised, y made perpendicular to it, and their cross product."""
    x = x / np.linalg.norm(x)
    y = y - x * (x @ y)
    y = y / np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], axis=1)
