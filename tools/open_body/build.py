#!/usr/bin/env python3
"""Builds the embedded open bodies from MakeHuman's CC0 data. See README.md."""

import environment

environment.run_again_with_fixed_kernels()

import argparse  # noqa: E402  (the kernels must be chosen before NumPy is imported)
import hashlib  # noqa: E402
from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402

import asset  # noqa: E402
import decimate  # noqa: E402
import joint_regressor  # noqa: E402
import makehuman  # noqa: E402
import measure  # noqa: E402
import npz  # noqa: E402
import people  # noqa: E402
import shape_space  # noqa: E402
import skeleton  # noqa: E402
import sliders  # noqa: E402
import source  # noqa: E402
import surface  # noqa: E402
import t_pose  # noqa: E402

HERE = Path(__file__).resolve().parent
BODIES = {"open_body": (6890, 0.06), "open_body_low": (3000, 0.09)}  # vertices, longest edge in metres
# The decimation looks at five bodies, (sex, weight, muscle): the average one, slim and heavy men and women.
GUIDES = [(0.5, 0.5, 0.5), (0.0, 0.0, 0.3), (0.0, 1.0, 0.3), (1.0, 0.0, 0.3), (1.0, 1.0, 0.3)]
GUIDE_HEIGHT = 0.37  # of the height slider: about 1.7 m


def main():
    arguments = _arguments()
    folder = source.find(arguments.source, arguments.cache)
    words, half, half_body = _t_posed_half(folder)
    bodies = {name: _whole_body(half, half_body, *size) for name, size in BODIES.items()}

    body, triangles, _ = bodies["open_body"]
    drawn = people.draw(words, body, triangles)
    space = shape_space.fit(drawn.coefficients, body)
    space.turn(_signs(space.betas(drawn.coefficients), drawn))

    arguments.output.mkdir(parents=True, exist_ok=True)
    hashes = []
    for name, (body, triangles, mirror) in bodies.items():
        path = arguments.output / f"{name}.npz"
        arrays = _arrays(body, triangles, mirror, space, drawn)
        npz.write(path, arrays)
        hashes.append(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n")
        if arguments.measure:
            measure.report(name, arrays, body, triangles, space, drawn)
        print(f"{path}: {len(mirror)} vertices, {len(triangles)} triangles, {path.stat().st_size} bytes")
    (arguments.output / "sha256sums").write_text("".join(hashes))


def _arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", type=Path, help=f"unpacked {source.PACKAGE} wheel (default: download it)")
    parser.add_argument("--cache", type=Path, default=HERE / ".cache", help="where a downloaded wheel is kept")
    parser.add_argument("--output", type=Path, default=HERE.parents[1] / "crates" / "physique-body" / "assets")
    parser.add_argument("--measure", action="store_true", help="print the numbers of the card")
    return parser.parse_args()


def _t_posed_half(folder):
    """The T-posed left half of the closed skin, linear in the targets, before decimation."""
    mesh = makehuman.read_base_mesh(folder)
    words, targets = sliders.read_adult_targets(folder, mesh)
    rig = makehuman.read_rig(folder, mesh)
    quads = surface.closed_skin(mesh)
    guides = sliders.coefficients(words, _guide_sliders())

    left = (mesh.vertices[quads, 0] >= 0).all(axis=1)
    skin, corners = np.unique(quads[left], return_inverse=True)
    body = t_pose.pose(mesh, targets, rig, skin, guides[0])
    shapes = body.mix(guides)
    on_mid_plane = mesh.mirror[skin] == skin
    shapes[:, on_mid_plane, 0] = 0.0
    triangles = surface.triangulated(shapes[0], corners.reshape(-1, 4))
    return words, decimate.HalfSurface(shapes, triangles, on_mid_plane), body


def _guide_sliders():
    count = len(GUIDES)
    settings = {name: np.full(count, 0.5) for name in sliders.SLIDERS}
    settings["sex"], settings["weight"], settings["muscle"] = np.array(GUIDES).T
    return dict(settings, height=np.full(count, GUIDE_HEIGHT), ancestry=np.full((count, 3), 1 / 3))


def _whole_body(half, body, vertex_target, longest_edge):
    """Decimates the half body and mirrors it: (LinearBody, triangles, mirror index)."""
    kept, triangles = decimate.decimated(half, vertex_target, longest_edge)
    triangles, mirror = decimate.both_sides(triangles, half.on_mid_plane[kept])
    side = kept[~half.on_mid_plane[kept]]
    weights = body.blend_weights
    whole = t_pose.LinearBody(
        np.concatenate([body.vertices[:, kept], body.vertices[:, side] * [-1.0, 1.0, 1.0]], axis=1),
        body.joints,
        np.concatenate([weights[kept], weights[side][:, skeleton.MIRROR]]),
    )
    assert surface.is_closed_and_oriented(triangles) and surface.euler_characteristic(triangles) == 2
    return whole, triangles, mirror


def _signs(betas, drawn):
    """The first beta grows with stature, each other one with mass or, if it tells them better, manhood."""
    mass = np.log(drawn.bmi * drawn.stature**2)
    traits = np.stack([drawn.stature, mass, drawn.male])
    correlation = np.corrcoef(traits, betas.T)[: len(traits), len(traits) :]
    strongest = 1 + np.abs(correlation[1:]).argmax(axis=0)
    strongest[0] = 0
    return np.sign(correlation[strongest, np.arange(betas.shape[1])])


def _arrays(body, triangles, mirror, space, drawn):
    template = body.mix(space.mean)
    directions, joint_directions = body.along(space.directions)
    fitted = slice(0, joint_regressor.COMPONENTS)
    regressor = joint_regressor.fit(
        template, directions[fitted], body.mix_joints(space.mean), joint_directions[fitted], mirror
    )
    betas = space.betas(drawn.coefficients)
    means = {"male": betas[drawn.male].mean(axis=0), "female": betas[~drawn.male].mean(axis=0)}
    return asset.arrays(
        template,
        directions[: shape_space.BETAS],
        regressor,
        body.blend_weights,
        triangles,
        mirror,
        means,
        _attribute_map(betas, drawn),
    )


def _attribute_map(betas, drawn):
    """Least squares: betas = map @ [1, sex, stature, ln mass, years], sex +1 for men and -1 for women."""
    mass = drawn.bmi * drawn.stature**2
    sex = np.where(drawn.male, 1.0, -1.0)
    attributes = np.stack([np.ones_like(sex), sex, drawn.stature, np.log(mass), drawn.years], axis=1)
    return np.linalg.lstsq(attributes, betas, rcond=None)[0].T


if __name__ == "__main__":
    main()
