"""Thins the surface out, keeping it mirror symmetric.

Only the left half is decimated (quadric error metric, its border on the mid plane locked). Every kept
vertex is then expressed as a point on the original half, so that all targets and weights follow by
one sparse matrix, and the right half is the mirror image of the left.
"""

from dataclasses import dataclass

import numpy as np
import pyfqmr
import scipy.sparse as sparse
from scipy.spatial import cKDTree

MILLIMETRES = 1000.0  # pyfqmr's thresholds suit meshes of this size
CANDIDATES = 40  # nearest triangles looked at for each new vertex


@dataclass
class HalfSurface:
    """The left half: vertices with x >= 0, those with x = 0 on the mid plane, and its triangles."""

    vertices: np.ndarray
    triangles: np.ndarray

    def on_mid_plane(self):
        return self.vertices[:, 0] == 0.0


def decimated(half, vertex_target):
    """Returns (resampling, triangles): a sparse (new, old) matrix of convex rows, and new triangles.

    `vertex_target` counts the whole closed body: it has 2 V - 4 triangles, half of them here.
    """
    simplify = pyfqmr.Simplify()
    # Rounded to a micrometre: the last bit must not decide which edge collapses first.
    simplify.setMesh(np.round(half.vertices * MILLIMETRES, 3), half.triangles)
    simplify.simplify_mesh(
        target_count=vertex_target - 2,
        aggressiveness=5,
        update_rate=2,
        max_iterations=400,
        preserve_border=True,
        verbose=False,
    )
    points, triangles, _normals = simplify.getMesh()
    points = np.asarray(points) / MILLIMETRES
    return _resampling(half, points), np.asarray(triangles)


def _resampling(half, points):
    corners = half.vertices[half.triangles]
    _, nearest = cKDTree(corners.mean(axis=1)).query(points, k=CANDIDATES)
    weights = _closest_point_weights(corners[nearest], points[:, None])
    found = np.einsum("nck,nckd->ncd", weights, corners[nearest])
    best = np.linalg.norm(found - points[:, None], axis=2).argmin(axis=1)
    rows = np.arange(len(points))
    columns = half.triangles[nearest[rows, best]]
    values = weights[rows, best]

    # The border is locked: its vertices are vertices of the original.
    middle = np.nonzero(half.on_mid_plane())[0]
    on_border = np.abs(points[:, 0]) < 1e-6
    _, match = cKDTree(half.vertices[middle]).query(points[on_border])
    columns[on_border] = middle[match][:, None]
    values[on_border] = [1.0, 0.0, 0.0]

    entries = values.ravel(), (np.repeat(rows, 3), columns.ravel())
    return sparse.csr_matrix(entries, shape=(len(points), len(half.vertices)))


def _closest_point_weights(corners, points):
    """Barycentric weights (..., 3) of the point of each triangle (..., 3, 3) that is closest to `points`.

    Ericson, Real-Time Collision Detection, 5.1.5.
    """
    a, b, c = np.moveaxis(corners, -2, 0)
    ab, ac = b - a, c - a

    def dots(from_corner):
        offset = points - from_corner
        return (ab * offset).sum(-1), (ac * offset).sum(-1)

    (d1, d2), (d3, d4), (d5, d6) = dots(a), dots(b), dots(c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(divide="ignore", invalid="ignore"):
        zero, one = np.zeros_like(d1), np.ones_like(d1)
        cases = [
            ((d1 <= 0) & (d2 <= 0), (one, zero, zero)),
            ((d3 >= 0) & (d4 <= d3), (zero, one, zero)),
            ((vc <= 0) & (d1 >= 0) & (d3 <= 0), (1 - d1 / (d1 - d3), d1 / (d1 - d3), zero)),
            ((d6 >= 0) & (d5 <= d6), (zero, zero, one)),
            ((vb <= 0) & (d2 >= 0) & (d6 <= 0), (1 - d2 / (d2 - d6), zero, d2 / (d2 - d6))),
            (
                (va <= 0) & (d4 >= d3) & (d5 >= d6),
                (zero, 1 - (d4 - d3) / ((d4 - d3) + (d5 - d6)), (d4 - d3) / ((d4 - d3) + (d5 - d6))),
            ),
        ]
        total = va + vb + vc
        weights = np.stack([va / total, vb / total, vc / total], axis=-1)
        for applies, corner_weights in reversed(cases):
            weights = np.where(applies[..., None], np.stack(corner_weights, axis=-1), weights)
    return weights


def both_sides(half_count, triangles, on_mid_plane):
    """The whole body from its left half: (triangles, mirror index); right vertices follow the left ones."""
    mirror = np.arange(half_count)
    side = np.nonzero(~on_mid_plane)[0]
    mirror[side] = half_count + np.arange(len(side))
    whole = np.vstack([triangles, mirror[triangles][:, ::-1]])
    return whole, np.concatenate([mirror, side])
