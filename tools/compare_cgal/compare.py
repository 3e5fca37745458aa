"""Compares intersecting triangles with CGAL and sia counts with libigl's exact winding number.

    pip install cgal libigl numpy
    cargo run --release -p physique-geometry --example dump_pairs -- pairs
    python tools/compare_cgal/compare.py pairs

Exits with 1 if anything differs.
"""

import sys
import time
from pathlib import Path

import igl
import numpy as np
from CGAL.CGAL_Polygon_mesh_processing import self_intersections
from CGAL.CGAL_Polyhedron_3 import Polyhedron_3

POINTS_ASIDE = 35


def corners(face):
    """The positions of a face's corners, which name it: the bindings do not number them."""
    halfedge = face.halfedge()
    points = []
    for _ in range(3):
        point = halfedge.vertex().point()
        points.append((point.x(), point.y(), point.z()))
        halfedge = halfedge.next()
    return frozenset(points)


def cgal_pairs(path):
    """Pairs of intersecting faces by CGAL's exact predicates, and how long it took."""
    polyhedron = Polyhedron_3(str(path))
    numbers = {corners(face): number for number, face in enumerate(polyhedron.facets())}
    assert len(numbers) == polyhedron.size_of_facets(), "two faces have the same corners"
    found = []
    start = time.perf_counter()
    self_intersections(polyhedron, found)
    seconds = time.perf_counter() - start
    pairs = {tuple(sorted((numbers[corners(pair.first)], numbers[corners(pair.second)]))) for pair in found}
    return pairs, seconds


def grid():
    """The sia grid, x slowest, in single precision."""
    axis = (2 * np.arange(POINTS_ASIDE, dtype=np.float32) / np.float32(POINTS_ASIDE - 1) - 1).astype(np.float32)
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)


def main(folder):
    differs = False
    for off in sorted(folder.glob("*.off")):
        faces = igl.readOFF(str(off))[1]
        ours = {tuple(map(int, line.split())) for line in off.with_suffix(".pairs").open()}
        theirs, seconds = cgal_pairs(off)
        share = sum(bool(set(faces[a]) & set(faces[b])) for a, b in theirs)
        print(
            f"{off.stem}: CGAL {len(theirs)} pairs in {seconds * 1e3:.0f} ms ({share} share a vertex), "
            f"missing {len(theirs - ours)}, extra {len(ours - theirs)}"
        )

        points = grid()
        inside = (points * points).sum(1) <= 1
        vertices = np.loadtxt(off.with_suffix(".ball"))
        winding = np.rint(igl.winding_number(vertices, faces.astype(np.int64), points[inside].astype(float)))
        counts = np.loadtxt(off.with_suffix(".counts"), dtype=int)
        unequal = int((winding != counts[inside]).sum()) + int((counts[~inside] != 0).sum())
        print(f"{off.stem}: {inside.sum()} points in the ball, {unequal} counts differ from igl's winding number")
        differs |= ours != theirs or unequal > 0
    return differs


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
