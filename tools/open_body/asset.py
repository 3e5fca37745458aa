"""The asset's arrays, format 1."""

import numpy as np

import blend_weights
import skeleton

FORMAT = 1
METRES_PER_STEP = 5e-5  # of the template


def arrays(template, directions, regressor, weights, triangles, mirror, betas, attribute_map):
    """Quantises a body; template (V, 3), directions (10, V, 3), regressor (22, V), weights (V, 22)."""
    steps = np.round(template / METRES_PER_STEP)
    assert np.abs(steps).max() < 32767
    joint, vertex = np.nonzero(regressor)
    shares = regressor[joint, vertex].astype(np.float32)
    blend_joint, blend_weight, _dropped = blend_weights.quantised(weights, mirror)
    return {
        "format": np.array([FORMAT], dtype=np.uint32),
        "template_quantised": _mirrored_exactly(steps.astype(np.int16), mirror),
        "shape_directions": _mirrored_exactly(directions.astype(np.float16), mirror),
        "regressor_joint": joint.astype(np.uint8),
        "regressor_vertex": vertex.astype(np.uint16),
        "regressor_weight": shares,
        "blend_joint": blend_joint,
        "blend_weight": blend_weight,
        "triangles": triangles.astype(np.uint16),
        "parents": skeleton.PARENTS.astype(np.int8),
        "mirror_vertex": mirror.astype(np.uint16),
        "betas_male": betas["male"].astype(np.float32),
        "betas_female": betas["female"].astype(np.float32),
        "attribute_map": attribute_map.astype(np.float32),
    }


def _mirrored_exactly(field, mirror):
    """Makes the right side the exact mirror image of the left, and x zero on the mid plane."""
    field = field.copy()
    middle = np.nonzero(mirror == np.arange(len(mirror)))[0]
    left = np.nonzero(mirror > np.arange(len(mirror)))[0]  # left vertices come first
    field[..., middle, 0] = 0
    reflected = field[..., left, :]
    reflected[..., 0] = -reflected[..., 0]
    field[..., mirror[left], :] = reflected
    return field + field.dtype.type(0)  # no negative zeros
