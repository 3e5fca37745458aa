"""Thins the surface out by edge collapses, keeping it mirror symmetric and good for every body shape.

Only the left half is decimated; the right one is its mirror image. A vertex is merged into a neighbour
where that moves the surface least, by the quadric error metric (Garland & Heckbert, "Surface
Simplification Using Quadric Error Metrics", 1997) summed over several body shapes at once. The vertices
that stay are vertices of the original, so targets and blend weights need no resampling.
"""

import heapq
from dataclasses import dataclass

import numpy as np

EDGE_PENALTY = 0.03  # merging over a distance d counts like a surface error of this times d
SHARPEST_TURN = 0.35  # least cosine between a triangle's normals before and after
WORST_ASPECT = 9.0  # longest edge over altitude; worse triangles may only improve


@dataclass
class HalfSurface:
    """The left half: vertices with x >= 0, in several shapes, and triangles."""

    shapes: np.ndarray  # (shapes, vertices, 3)
    triangles: np.ndarray  # (triangles, 3)
    on_mid_plane: np.ndarray  # (vertices,) bool: the border of the half


def decimated(half, vertex_target, longest_edge):
    """Returns (kept vertices, triangles over them) of the left half.

    `vertex_target` counts the whole closed body: it has 2 V - 4 triangles, half of them here.
    No collapse makes an edge longer than `longest_edge` in the first shape.
    """
    work = _Collapse(half, longest_edge)
    work.run(vertex_target - 2)
    triangles = np.array([work.faces[index] for index in sorted(work.faces)])
    kept, triangles = np.unique(triangles, return_inverse=True)
    return kept, triangles.reshape(-1, 3)


def both_sides(triangles, on_mid_plane):
    """The whole body from its left half: (triangles, mirror index); right vertices follow the left ones."""
    count = len(on_mid_plane)
    mirror = np.arange(count)
    side = np.nonzero(~on_mid_plane)[0]
    mirror[side] = count + np.arange(len(side))
    whole = np.vstack([triangles, mirror[triangles][:, ::-1]])
    return whole, np.concatenate([mirror, side])


class _Collapse:
    def __init__(self, half, longest_edge):
        # Rounded to a micrometre: the last bit must not decide which edge collapses first.
        self.points = np.round(half.shapes, 6)
        self.border = half.on_mid_plane
        self.longest_edge = longest_edge
        self.faces = {index: tuple(face) for index, face in enumerate(half.triangles.tolist())}
        self.faces_of = [set() for _ in range(self.points.shape[1])]
        for index, face in self.faces.items():
            for vertex in face:
                self.faces_of[vertex].add(index)
        self.quadrics, self.areas = _quadrics(self.points, half.triangles)
        self.stamp = np.zeros(len(self.faces_of), dtype=int)  # how often a vertex's surroundings changed
        self.queue = []

    def run(self, face_target):
        for vertex in range(len(self.faces_of)):
            self._enqueue(vertex, self._neighbours(vertex))
        while len(self.faces) > face_target:
            _cost, start, end, stamps = heapq.heappop(self.queue)
            if stamps == (self.stamp[start], self.stamp[end]) and self._allowed(start, end):
                self._merge(start, end)

    def _neighbours(self, vertex):
        return {other for index in self.faces_of[vertex] for other in self.faces[index]} - {vertex}

    def _enqueue(self, start, ends):
        """Queues the merges of `start` into each of `ends`."""
        ends = sorted(ends)
        if not ends:
            return
        places = self.points[:, ends]
        homogeneous = np.concatenate([places, np.ones((*places.shape[:2], 1))], axis=2)
        merged = self.quadrics[:, [start]] + self.quadrics[:, ends]
        error = np.einsum("sei,seij,sej->e", homogeneous, merged, homogeneous)
        distance = np.linalg.norm(places - self.points[:, [start]], axis=2)
        error += (self.areas[:, [start]] * (EDGE_PENALTY * distance) ** 2).sum(axis=0)
        for cost, end in zip(error.tolist(), ends):
            heapq.heappush(self.queue, (cost, start, end, (self.stamp[start], self.stamp[end])))

    def _allowed(self, start, end):
        shared = self.faces_of[start] & self.faces_of[end]
        around_start, around_end = self._neighbours(start), self._neighbours(end)
        if len(around_start & around_end) != len(shared):
            return False  # the surface would touch itself
        if self.border[start] and not (self.border[end] and len(shared) == 1):
            return False  # a border vertex moves along the border only
        if self.border[end] and any(self.border[v] and v not in around_end for v in around_start - {end}):
            return False  # an edge across the half between two border vertices would weld the mirror image to it
        moved = [self.faces[index] for index in self.faces_of[start] - shared]
        return bool(moved) and self._keeps_shape(np.array(moved), start, end)

    def _keeps_shape(self, faces, start, end):
        before = self.points[:, faces]
        after = self.points[:, np.where(faces == start, end, faces)]
        normal_before, _, aspect_before = _face_geometry(before)
        normal_after, longest, aspect_after = _face_geometry(after)
        return (
            (longest[0] <= self.longest_edge).all()
            and ((normal_before * normal_after).sum(axis=2) >= SHARPEST_TURN).all()
            and (aspect_after[0] <= np.maximum(WORST_ASPECT, aspect_before[0].max())).all()
        )

    def _merge(self, start, end):
        for index in self.faces_of[start] & self.faces_of[end]:
            for vertex in self.faces.pop(index):
                self.faces_of[vertex].discard(index)
        for index in self.faces_of[start]:
            self.faces[index] = tuple(end if v == start else v for v in self.faces[index])
            self.faces_of[end].add(index)
        self.faces_of[start] = set()
        self.quadrics[:, end] += self.quadrics[:, start]
        self.areas[:, end] += self.areas[:, start]
        changed = sorted(self._neighbours(end) | {end})
        self.stamp[changed + [start]] += 1
        for vertex in changed:
            around = self._neighbours(vertex)
            self._enqueue(vertex, around)
            for other in sorted(around.difference(changed)):
                self._enqueue(other, [vertex])


def _face_geometry(corners):
    """Unit normals, longest edges and aspects (longest edge over altitude on it) of triangles (..., 3, 3)."""
    edges = np.roll(corners, -1, axis=-2) - corners
    cross = np.cross(edges[..., 0, :], edges[..., 1, :])
    double_area = np.maximum(np.linalg.norm(cross, axis=-1), 1e-12)
    longest = np.linalg.norm(edges, axis=-1).max(axis=-1)
    return cross / double_area[..., None], longest, longest**2 / double_area


def _quadrics(points, triangles):
    """Each vertex's quadric (shapes, vertices, 4, 4) and area, a third of its triangles'."""
    corners = points[:, triangles]
    cross = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    double_area = np.maximum(np.linalg.norm(cross, axis=2), 1e-12)
    normal = cross / double_area[..., None]
    offset = -(normal * corners[:, :, 0]).sum(axis=2)
    plane = np.concatenate([normal, offset[..., None]], axis=2)
    share = double_area / 6
    face_quadric = share[..., None, None] * plane[..., :, None] * plane[..., None, :]
    quadrics = np.zeros((*points.shape[:2], 4, 4))
    areas = np.zeros(points.shape[:2])
    for corner in range(3):
        for shape in range(len(points)):
            np.add.at(quadrics[shape], triangles[:, corner], face_quadric[shape])
            np.add.at(areas[shape], triangles[:, corner], share[shape])
    return quadrics, areas
