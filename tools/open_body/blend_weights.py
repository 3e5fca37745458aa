"""Blend weights as the asset stores them: four joints a vertex, 16 bits a weight, exactly mirrored."""

import numpy as np

import skeleton

INFLUENCES = 4
FULL = 65535
SMALLEST = 1e-3  # smaller shares are dropped


def quantised(weights, mirror):
    """From dense (vertices, 22) weights: joints uint8 and weights uint16 (vertices, 4), heaviest first.

    Each row sums to FULL. Also returns the share of weight that was dropped, for each vertex.
    """
    weights = weights / weights.sum(axis=1, keepdims=True)
    joints = np.zeros((len(weights), INFLUENCES), dtype=np.uint8)
    shares = np.zeros((len(weights), INFLUENCES), dtype=np.uint16)
    dropped = np.zeros(len(weights))
    for vertex in np.nonzero(mirror >= np.arange(len(mirror)))[0]:
        opposite = mirror[vertex]
        kept, dropped[vertex] = _kept(weights[vertex], vertex == opposite)
        whole = _rounded(kept, vertex == opposite)
        joints[vertex], shares[vertex] = _heaviest_first(whole)
        if opposite != vertex:
            dropped[opposite] = dropped[vertex]
            joints[opposite], shares[opposite] = _heaviest_first(whole[skeleton.MIRROR])
    return joints, shares, dropped


def _kept(row, on_mid_plane):
    """The row with at most four weights; on the mid plane left and right stay or go together."""
    if on_mid_plane:
        row = (row + row[skeleton.MIRROR]) / 2
    order = sorted(range(len(row)), key=lambda j: (-row[j], j))
    chosen = set(order[:INFLUENCES])
    if on_mid_plane:
        chosen = {j for j in chosen if skeleton.MIRROR[j] in chosen}
    kept = np.array([w if j in chosen and w >= SMALLEST else 0.0 for j, w in enumerate(row)])
    return kept / kept.sum(), 1 - kept.sum()


def _rounded(row, on_mid_plane):
    """Integers that sum to FULL: what rounding left over goes to the heaviest joint (of the trunk)."""
    whole = np.round(row * FULL).astype(np.int64)
    own_mirror = skeleton.MIRROR == np.arange(len(row))
    candidates = np.where(own_mirror, whole, -1) if on_mid_plane else whole
    whole[candidates.argmax()] += FULL - whole.sum()
    return whole


def _heaviest_first(whole):
    order = sorted(np.nonzero(whole)[0], key=lambda j: (-whole[j], j))
    joints = np.zeros(INFLUENCES, dtype=np.uint8)
    shares = np.zeros(INFLUENCES, dtype=np.uint16)
    joints[: len(order)] = order
    shares[: len(order)] = whole[order]
    return joints, shares
