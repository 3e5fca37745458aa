"""Imports BVH and glTF files of one motion into Blender and compares its joints with a CSV of ours.

    pip install bpy
    physique convert walk.bvh walk.csv && physique convert walk.bvh walk.glb
    python check_import.py walk.csv walk.bvh walk.glb

Blender's world is Z up: ours (x, y, z) must be Blender's (x, -z, y). Prints the largest distance of
any of the 22 joints in any frame, and fails above 0.1 mm.
"""

import csv
import sys

import bpy
from mathutils import Vector

TOLERANCE_M = 1e-4


def positions(path):
    """Frame rate, joint names and `[frames][joints]` positions in Blender's axes."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    names = [column.removesuffix("_x_m") for column in header if column.endswith("_x_m")]
    frames = []
    for row in rows:
        numbers = [float(number) for number in row[1:]]
        points = [numbers[i : i + 3] for i in range(0, len(numbers), 3)]
        frames.append([Vector((x, -z, y)) for x, y, z in points])
    rate = (len(rows) - 1) / (float(rows[-1][0]) - float(rows[0][0]))
    return rate, names, frames


def import_file(path, rate, scale):
    """An empty scene at `rate`, then the file; the armature."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = round(rate)
    scene.render.fps_base = round(rate) / rate
    if path.endswith(".bvh"):
        up = {} if "_z" not in path else {"axis_forward": "Y", "axis_up": "Z"}
        bpy.ops.import_anim.bvh(filepath=path, global_scale=scale, **up)
    else:
        bpy.ops.import_scene.gltf(filepath=path)
    return next(thing for thing in scene.objects if thing.type == "ARMATURE")


def largest_distance(armature, first, names, frames):
    scene = bpy.context.scene
    worst = (0.0, "", 0)
    for index, joints in enumerate(frames):
        # Keys of glTF lie at times, which Blender rounds to 32-bit frames.
        scene.frame_set(first + index)
        for name, expected in zip(names, joints):
            found = armature.matrix_world @ armature.pose.bones[name].head
            worst = max(worst, ((found - expected).length, name, index))
    return worst


def main(table, *files):
    rate, names, frames = positions(table)
    failed = False
    for path in files:
        armature = import_file(path, rate, scale=1.0 if "_m" in path else 0.01)
        action = armature.animation_data.action
        first = round(action.frame_range[0])
        distance, joint, frame = largest_distance(armature, first, names, frames)
        meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
        print(
            f"{path}: Blender {bpy.app.version_string}, {len(armature.pose.bones)} bones, "
            f"{sum(len(mesh.data.vertices) for mesh in meshes)} vertices, first frame {first}, "
            f"frames {action.frame_range[0]:g} to {action.frame_range[1]:g} of {len(frames)}; "
            f"largest distance {1000 * distance:.4f} mm ({joint}, frame {frame})"
        )
        failed |= distance > TOLERANCE_M
    sys.exit(failed)


main(*sys.argv[1:])
