"""The numbers of the card, measured on the finished arrays and the drawn people."""

import numpy as np

import people
import shape_space
import skeleton


def report(name, arrays, body, triangles, space, drawn):
    """Prints what `crates/physique-body/assets/CARD.md` states about one body."""
    template = arrays["template_quantised"] * 5e-5
    directions = arrays["shape_directions"].astype(np.float64)
    print(f"== {name}")
    explained = np.cumsum(space.variance) / space.total_variance
    for count in (1, 2, 3, 4, 5, 6, 8, 10, 16):
        mean, high, worst = _held_out_error(drawn.coefficients, body, count)
        print(f"{count:2} betas: variance {explained[count - 1]:.4f}, "
              f"held-out error mean {mean:.2f} p95 {high:.2f} max {worst:.1f} mm")
    betas = space.betas(drawn.coefficients)
    print("beta variance", betas.var(axis=0, ddof=1).round(4), "mean", np.abs(betas.mean(axis=0)).max().round(6))
    for sex, chosen in (("men", drawn.male), ("women", ~drawn.male)):
        _print_range(f"drawn {sex}", drawn.stature[chosen], drawn.bmi[chosen])
    _print_traits(template, directions, triangles, betas, drawn)
    normal = np.random.default_rng(1).normal(size=(500, shape_space.BETAS))
    shapes = template + np.tensordot(normal, directions, 1)
    stature, mass = people.statures(shapes), people.volumes(shapes, triangles) * people.DENSITY
    _print_range("500 normal betas", stature, mass / stature**2)
    _print_joint_error(arrays, body, drawn)
    _print_attribute_error(arrays["attribute_map"], template, directions, triangles, drawn)
    _print_mesh(template, arrays, triangles)


def _held_out_error(coefficients, body, count):
    """Fits to 4 of 5 people; distance of the others' vertices to what `count` betas make of them, in mm."""
    held_out = np.arange(len(coefficients)) % 5 == 0
    space = shape_space.fit(coefficients[~held_out], body)
    rest = coefficients[held_out] - space.mean
    rest = rest - rest @ space.to_betas[:, :count] @ space.directions[:count]
    errors = []
    for part in np.array_split(rest, 8):
        errors.append(1000 * np.linalg.norm(body.along(part)[0], axis=2).ravel())
    errors = np.concatenate(errors)
    return errors.mean(), np.percentile(errors, 95), errors.max()


def _print_range(title, stature, bmi):
    mass = bmi * stature**2
    for name, unit, values in (("stature", "m", stature), ("mass", "kg", mass), ("BMI", "kg/m2", bmi)):
        print(f"{title}: {name} {values.min():.3f} / {values.mean():.3f} / {values.max():.3f} "
              f"sd {values.std():.3f} {unit}")


def _print_traits(template, directions, triangles, betas, drawn):
    mass = np.log(drawn.bmi * drawn.stature**2)
    traits = {"stature": drawn.stature, "ln mass": mass, "BMI": drawn.bmi, "male": drawn.male, "age": drawn.years}
    traits["muscle"] = drawn.sliders["muscle"]
    for k, direction in enumerate(directions):
        ends = []
        for sigma in (-3, 3):
            vertices = template + sigma * direction
            stature, mass = people.statures(vertices), people.DENSITY * people.volumes(vertices, triangles)
            ends.append(f"{sigma:+d}: {stature:.3f} m {mass:.1f} kg BMI {mass / stature**2:.1f}")
        r = ", ".join(f"{name} {np.corrcoef(betas[:, k], values)[0, 1]:+.2f}" for name, values in traits.items())
        print(f"beta {k}: {'; '.join(ends)}; correlation {r}")


def _print_joint_error(arrays, body, drawn):
    dense = np.zeros((len(skeleton.NAMES), len(arrays["mirror_vertex"])))
    dense[arrays["regressor_joint"], arrays["regressor_vertex"]] = arrays["regressor_weight"]
    regressed = np.tensordot(dense, body.vertices, ([1], [1])).transpose(1, 0, 2)
    residual = regressed - body.joints
    errors = residual[0] + np.tensordot(drawn.coefficients, residual[1:], 1)
    errors = 1000 * np.linalg.norm(errors, axis=2)
    each = ", ".join(f"{name} {error:.1f}" for name, error in zip(skeleton.NAMES, errors.mean(axis=0)))
    print(f"joint error mean {errors.mean():.1f} max {errors.max():.1f} mm; {each}")
    print("regressor vertices a joint", (dense > 0).sum(axis=1))
    template = arrays["template_quantised"] * 5e-5
    for name, place in zip(skeleton.NAMES, dense @ template):
        print(f"  {name:15} {place.round(3)}")


def _print_attribute_error(attribute_map, template, directions, triangles, drawn):
    mass = drawn.bmi * drawn.stature**2
    sex = np.where(drawn.male, 1.0, -1.0)
    attributes = np.stack([np.ones_like(sex), sex, drawn.stature, np.log(mass), drawn.years])
    chosen = slice(None, None, 10)
    shapes = template + np.tensordot((attribute_map @ attributes).T[chosen], directions, 1)
    stature_error = np.abs(people.statures(shapes) - drawn.stature[chosen])
    mass_error = np.abs(people.volumes(shapes, triangles) * people.DENSITY / mass[chosen] - 1)
    print(f"attributes: stature error mean {1000 * stature_error.mean():.1f} max {1000 * stature_error.max():.1f} mm, "
          f"mass error mean {100 * mass_error.mean():.2f} max {100 * mass_error.max():.2f} %")


def _print_mesh(template, arrays, triangles):
    corners = template[triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    dominant = arrays["blend_joint"][:, 0]
    head, hands = (dominant == skeleton.NAMES.index("head")).sum(), np.isin(dominant, [20, 21]).sum()
    soles = (template[:, 1] < template[:, 1].min() + 0.01).sum()
    volume, stature = people.volumes(template, triangles), people.statures(template)
    print(f"template {stature:.3f} m, {1000 * volume:.2f} L, BMI {people.DENSITY * volume / stature**2:.1f}")
    print(f"edges mean {1000 * edges.mean():.1f} min {1000 * edges.min():.2f} max {1000 * edges.max():.1f} mm")
    print(f"vertices: head {head}, hands {hands}, lowest centimetre {soles}")
    print("influences a vertex", np.bincount((arrays["blend_weight"] > 0).sum(axis=1)))
