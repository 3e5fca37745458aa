"""Reads MakeHuman's base mesh, rig and targets. Metres, Y up, facing +Z, left is +X."""

import gzip
import json
from dataclasses import dataclass

import numpy as np

METRES_PER_UNIT = 0.1  # MakeHuman models in decimetres


@dataclass
class BaseMesh:
    """The base mesh `hm08`: the skin (group `body`) and invisible helpers, such as a cube around each joint."""

    vertices: np.ndarray  # (vertices, 3), exactly mirror symmetric
    groups: dict  # name -> quads (faces, 4)
    mirror: np.ndarray  # (vertices,) index of the mirrored vertex

    def helper(self, name):
        """The vertices of one group."""
        return np.unique(self.groups[name])


def mirrored(field, mirror):
    """A field of vectors over the vertices, shape (..., vertices, 3), reflected at the plane x = 0."""
    return field[..., mirror, :] * [-1.0, 1.0, 1.0]


def read_base_mesh(folder):
    vertices, groups = [], {}
    quads = None
    with open(folder / "3dobjs" / "base.obj", encoding="utf-8") as lines:
        for line in lines:
            kind, *fields = line.split() or [""]
            if kind == "v":
                vertices.append([float(x) for x in fields])
            elif kind == "g":
                quads = groups.setdefault(fields[0], [])
            elif kind == "f":
                quads.append([int(corner.split("/")[0]) - 1 for corner in fields])
    mirror = _read_mirror(folder, len(vertices))
    vertices = np.array(vertices) * METRES_PER_UNIT
    vertices = (vertices + mirrored(vertices, mirror)) / 2
    return BaseMesh(vertices, {name: np.array(quads) for name, quads in groups.items()}, mirror)


def _read_mirror(folder, count):
    mirror = np.arange(count)
    with open(folder / "mesh_metadata" / "hm08.mirror", encoding="utf-8") as lines:
        for line in lines:
            vertex, opposite, _side = line.split()
            mirror[int(vertex)] = int(opposite)
    assert (mirror[mirror] == np.arange(count)).all()
    return mirror


def read_target(folder, path, mesh):
    """The displacements (vertices, 3) of one morph target, made symmetric (they are to within 0.1 mm)."""
    displacement = np.zeros_like(mesh.vertices)
    with gzip.open(folder / "targets" / f"{path}.target.gz", "rt") as text:
        rows = np.array(text.read().split(), dtype=np.float64).reshape(-1, 4)
    displacement[rows[:, 0].astype(int)] = rows[:, 1:] * METRES_PER_UNIT
    return (displacement + mirrored(displacement, mesh.mirror)) / 2


@dataclass
class Rig:
    """MakeHuman's 163 bones; a bone's head is the mean of a few base mesh vertices."""

    names: list  # parents before children
    parent: dict  # name -> name, None for the root
    head: dict  # name -> vertex indices
    weights: np.ndarray  # (vertices, bones)


def read_rig(folder, mesh):
    bones = json.loads((folder / "rigs" / "standard" / "rig.default.json").read_text())
    table = json.loads((folder / "rigs" / "standard" / "weights.default.json").read_text())["weights"]
    parent = {name: bone["parent"] or None for name, bone in bones.items()}

    def depth(name):
        return 0 if parent[name] is None else 1 + depth(parent[name])

    names = sorted(bones, key=lambda name: (depth(name), name))
    weights = np.zeros((len(mesh.vertices), len(names)))
    for column, name in enumerate(names):
        for vertex, weight in table.get(name, []):
            weights[vertex, column] += weight
    return Rig(names, parent, {name: _head_vertices(bone["head"], mesh) for name, bone in bones.items()}, weights)


def _head_vertices(head, mesh):
    if head["strategy"] == "CUBE":
        return mesh.helper(head["cube_name"])
    if head["strategy"] == "MEAN":
        return np.array(head["vertex_indices"])
    return np.array([head["vertex_index"]])
