"""The 22 joints in SMPL's order: parents, where they lie, and which of MakeHuman's bones they carry."""

from dataclasses import dataclass

import numpy as np

# name, parent, helper cube at the joint (or two and how far from the first to the second it lies), MakeHuman bone that carries the joint, name stems of the merged bones.
# "l" and ".L" stand for both sides; a bone without a stem here belongs to the joint of its parent bone.
# The spine and the collars turn about points inside their bones, where SMPL's joints lie, not at their ends.
_TRUNK = [
    ("pelvis", None, "joint-spine-4", "spine04", ["root", "pelvis", "spine05", "spine04"]),
    ("spine1", "pelvis", ("joint-spine-3", "joint-spine-2", 0.6), "spine03", ["spine03"]),
    ("spine2", "spine1", ("joint-spine-2", "joint-neck", 0.33), "spine02", ["spine02"]),
    ("spine3", "spine2", ("joint-spine-2", "joint-neck", 0.5), "spine01", ["spine01", "breast"]),
    ("neck", "spine3", "joint-neck", "neck01", ["neck01", "neck02", "neck03"]),
    ("head", "neck", "joint-head", "head", ["head"]),
]
_LIMBS = [
    ("hip", "pelvis", "joint-l-upper-leg", "upperleg01.L", ["upperleg01", "upperleg02"]),
    ("knee", "hip", "joint-l-knee", "lowerleg01.L", ["lowerleg01", "lowerleg02"]),
    ("ankle", "knee", "joint-l-ankle", "foot.L", ["foot"]),
    ("foot", "ankle", "joint-l-foot-1", "foot.L", ["toe1-1", "toe2-1", "toe3-1", "toe4-1", "toe5-1"]),
    ("collar", "spine3", ("joint-l-clavicle", "joint-l-scapula", 0.6), "clavicle.L", ["clavicle", "shoulder01"]),
    ("shoulder", "collar", "joint-l-shoulder", "upperarm01.L", ["upperarm01", "upperarm02"]),
    ("elbow", "shoulder", "joint-l-elbow", "lowerarm01.L", ["lowerarm01", "lowerarm02"]),
    ("wrist", "elbow", "joint-l-hand", "wrist.L", ["wrist"]),
]
NAMES = (
    "pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot "
    "right_foot neck left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow "
    "left_wrist right_wrist"
).split()

# MakeHuman's thigh starts at the outer end of the femur's neck; the hip's centre is farther in.
HIP_WIDTH = 0.82
# The root turns freely and carries no weights of its own: put between the hips, where SMPL's users expect it.
PELVIS_IN_FRONT_OF_HIPS = 0.007
PELVIS = np.array([0.0, -0.22, 0.03])


@dataclass
class Joint:
    name: str
    parent: str | None
    helpers: tuple  # (from, to, share)
    carrier: str
    stems: list


def _joints():
    table = {}
    for name, parent, helper, carrier, stems in _TRUNK:
        table[name] = Joint(name, parent, _between(helper), carrier, stems)
    for name, parent, helper, carrier, stems in _LIMBS:
        start, end, share = _between(helper)
        for side, letter in (("left", "l"), ("right", "r")):
            table[f"{side}_{name}"] = Joint(
                name=f"{side}_{name}",
                parent=parent if parent in table else f"{side}_{parent}",
                helpers=(start.replace("-l-", f"-{letter}-"), end.replace("-l-", f"-{letter}-"), share),
                carrier=carrier.replace(".L", f".{letter.upper()}"),
                stems=[f"{stem}.{letter.upper()}" for stem in stems],
            )
    return [table[name] for name in NAMES]


def _between(helper):
    return (helper, helper, 0.0) if isinstance(helper, str) else helper


JOINTS = _joints()
PARENTS = np.array([-1 if j.parent is None else NAMES.index(j.parent) for j in JOINTS])


def opposite(name):
    """left_knee for right_knee, and the name itself on the mid line."""
    side, _, rest = name.partition("_")
    return {"left": f"right_{rest}", "right": f"left_{rest}"}.get(side, name)


MIRROR = np.array([NAMES.index(opposite(name)) for name in NAMES])


def positions(fields, mesh):
    """The joints (..., 22, 3) before posing, of fields (..., vertices, 3) over the base mesh."""

    def centre(helper):
        return fields[..., mesh.helper(helper), :].mean(axis=-2)

    ends = [(centre(start), centre(end), share) for start, end, share in (joint.helpers for joint in JOINTS)]
    return np.stack([(1 - share) * start + share * end for start, end, share in ends], axis=-2)


def joint_of_bone(rig):
    """For each bone of the rig the index of the joint that carries it."""
    stem_joint = {stem: i for i, joint in enumerate(JOINTS) for stem in joint.stems}
    stem_joint.update({"pelvis.L": 0, "pelvis.R": 0, "breast.L": 9, "breast.R": 9})
    found = {}
    for bone in rig.names:  # parents come first
        found[bone] = stem_joint[bone] if bone in stem_joint else found[rig.parent[bone]]
    return np.array([found[bone] for bone in rig.names])
