"""Draws adults: who they are is drawn at random, how the sliders must stand for it is solved.

Stature and body mass index are drawn from stated distributions; the height and weight sliders are then
solved so that the body has them. So every person is different, heavy and slim ones included, and the
distribution is ours, not the sliders'.
"""

from dataclasses import dataclass

import numpy as np

import sliders

SEED = 20260101
PEOPLE_OF_EACH_SEX = 1000
DENSITY = 985.0  # kg/m3, the whole living body, lungs half full

STATURE = {"male": (1.755, 0.072), "female": (1.625, 0.066)}  # mean and deviation in metres
STATURE_RANGE = (1.45, 2.05)
BMI_MEDIAN, BMI_LOG_DEVIATION = 25.0, 0.20
BMI_RANGE = (17.0, 40.0)

# The path along which a body gains mass. At 0 both sliders, weight and muscle, are at their least; up to 1
# muscle rises to what was drawn, up to 2 weight rises to its end, up to 3 weight goes somewhat beyond its
# end (MakeHuman's targets extrapolated) while muscle wanes again. Most bodies lie between 1 and 2.
PATH = [0.0, 1.0, 2.0, 3.0]
WEIGHT_ALONG_PATH = [0.0, 0.0, 1.0, 1.35]
MUSCLE_ALONG_PATH = [0.0, 1.0, 1.0, 0.0]  # times the muscle drawn
BISECTIONS = 20


@dataclass
class People:
    coefficients: np.ndarray  # (people, targets)
    male: np.ndarray  # (people,) bool
    sliders: dict
    stature: np.ndarray  # m
    bmi: np.ndarray  # kg/m2
    years: np.ndarray


def drawn_people():
    """The drawn traits: sliders but weight and height, stature and BMI. Rounded: equal on every machine."""
    rng = np.random.default_rng(SEED)
    count = 2 * PEOPLE_OF_EACH_SEX
    male = np.arange(count) < PEOPLE_OF_EACH_SEX
    androgyny = np.clip(np.abs(rng.normal(0, 0.12, count)), 0, 0.4)
    mean, deviation = np.array([STATURE["male" if is_male else "female"] for is_male in male]).T
    traits = {
        "sex": np.where(male, androgyny, 1 - androgyny),
        "age": rng.beta(1.2, 1.6, count),
        "muscle": rng.beta(1.6, 1.6, count),
        "proportions": rng.random(count),
        "cup": rng.beta(2, 2, count),
        "firmness": rng.beta(2, 2, count),
        "ancestry": rng.dirichlet([1, 1, 1], count),
        "stature": np.clip(rng.normal(mean, deviation), *STATURE_RANGE),
        "bmi": _truncated_lognormal(rng, count),
    }
    return male, {name: np.round(values, 6) for name, values in traits.items()}


def _truncated_lognormal(rng, count):
    values = np.empty(0)
    while len(values) < count:
        more = BMI_MEDIAN * np.exp(rng.normal(0, BMI_LOG_DEVIATION, count))
        values = np.concatenate([values, more[(more > BMI_RANGE[0]) & (more < BMI_RANGE[1])]])
    return values[:count]


def volumes(vertices, triangles):
    """Signed volumes of closed meshes (..., vertices, 3)."""
    a, b, c = (vertices[..., triangles[:, k], :] for k in range(3))
    return np.einsum("...i,...i->...", a, np.cross(b, c)).sum(axis=-1) / 6


def statures(vertices):
    return np.ptp(vertices[..., 1], axis=-1)


def draw(words, body, triangles):
    """Draws the people and solves their sliders on the T-posed LinearBody."""
    male, traits = drawn_people()
    solved = {name: traits[name] for name in traits if name not in ("stature", "bmi")}
    heights = np.ascontiguousarray(body.vertices[:, :, 1])

    def at(progress):
        """Sliders, coefficients and BMI of everyone at `progress` along the path, stature solved."""
        setting = dict(
            solved,
            weight=np.interp(progress, PATH, WEIGHT_ALONG_PATH),
            muscle=solved["muscle"] * np.interp(progress, PATH, MUSCLE_ALONG_PATH),
        )
        ends = [sliders.coefficients(words, dict(setting, height=np.full(len(male), h))) for h in (0.0, 1.0)]
        low, high = (_stature(heights, end) for end in ends)
        setting["height"] = (traits["stature"] - low) / (high - low)
        coefficients = ends[0] + setting["height"][:, None] * (ends[1] - ends[0])
        return setting, coefficients, _bmi(body, coefficients, triangles)

    below, above = np.zeros(len(male)), np.full(len(male), PATH[-1])
    for _ in range(BISECTIONS):
        middle = (below + above) / 2
        heavier = at(middle)[2] > traits["bmi"]
        below, above = np.where(heavier, below, middle), np.where(heavier, middle, above)
    setting, coefficients, bmi = at((below + above) / 2)
    years = sliders.YOUNG_YEARS + (sliders.OLD_YEARS - sliders.YOUNG_YEARS) * traits["age"]
    assert (np.abs(bmi - traits["bmi"]) < 0.01).all(), "a body mass index lies outside the path"
    return People(coefficients, male, setting, traits["stature"], bmi, years)


def _stature(heights, coefficients):
    mixed = heights[0] + coefficients @ heights[1:]
    return np.ptp(mixed, axis=1)


def _bmi(body, coefficients, triangles, chunk=100):
    found = []
    for start in range(0, len(coefficients), chunk):
        vertices = body.mix(coefficients[start : start + chunk])
        found.append(DENSITY * volumes(vertices, triangles) / statures(vertices) ** 2)
    return np.concatenate(found)
