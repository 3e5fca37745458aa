"""MakeHuman's macro sliders: which targets they mix, and how much of each.

A target's file name lists one word for each slider it depends on, for example
`universal-female-old-maxmuscle-minweight`. Its coefficient is the product of the words' weights;
a slider's words are hat functions over its range, and sum to 1.
"""

import itertools

import numpy as np

import makehuman

SEX = ["male", "female"]
AGE = ["young", "old"]
MUSCLE = ["minmuscle", "averagemuscle", "maxmuscle"]
WEIGHT = ["minweight", "averageweight", "maxweight"]
HEIGHT = ["minheight", "maxheight"]
PROPORTIONS = ["idealproportions", "uncommonproportions"]
ANCESTRY = ["african", "asian", "caucasian"]
CUP = ["mincup", "averagecup", "maxcup"]
FIRMNESS = ["minfirmness", "averagefirmness", "maxfirmness"]

SLIDERS = {
    "sex": SEX,
    "age": AGE,
    "muscle": MUSCLE,
    "weight": WEIGHT,
    "height": HEIGHT,
    "proportions": PROPORTIONS,
    "cup": CUP,
    "firmness": FIRMNESS,
}

# MakeHuman documents its age slider as 25 years in the middle ("young") and 90 years at the end ("old").
YOUNG_YEARS, OLD_YEARS = 25.0, 90.0


def _adult_targets():
    """Yields (words, path) of every macro target that shapes an adult."""
    for body in itertools.product(SEX, AGE, MUSCLE, WEIGHT):
        name = "-".join(body)
        yield body, f"macrodetails/universal-{name}"
        for height in HEIGHT:
            yield (*body, height), f"macrodetails/height/{name}-{height}"
        for proportions in PROPORTIONS:
            yield (*body, proportions), f"macrodetails/proportions/{name}-{proportions}"
    for words in itertools.product(ANCESTRY, SEX, AGE):
        yield words, "macrodetails/" + "-".join(words)
    for words in itertools.product(AGE, MUSCLE, WEIGHT, CUP, FIRMNESS):
        yield ("female", *words), "breast/female-" + "-".join(words)


def read_adult_targets(folder, mesh):
    """Returns the targets' words and displacements (targets, vertices, 3)."""
    words, displacements = [], []
    for key, path in _adult_targets():
        if key[-2:] == ("averagecup", "averagefirmness"):
            continue  # no file: the average breast is part of the body's own target
        words.append(key)
        displacements.append(makehuman.read_target(folder, path, mesh))
    return words, np.stack(displacements)


def coefficients(words, people):
    """The targets' coefficients (people, targets).

    `people` maps each slider to an array, 0..1 from its first word to its last (outside: extrapolated),
    and `ancestry` to an array (people, 3) of shares.
    """
    weight_of = dict(zip(ANCESTRY, np.asarray(people["ancestry"]).T))
    for slider, names in SLIDERS.items():
        weight_of.update(_hat_functions(np.asarray(people[slider]), names))
    return np.stack([np.prod([weight_of[word] for word in key], axis=0) for key in words], axis=1)


def _hat_functions(value, names):
    position = value * (len(names) - 1)
    segment = np.clip(np.floor(position), 0, len(names) - 2)
    within = position - segment
    return {name: np.where(segment == i, 1 - within, 0) + np.where(segment == i - 1, within, 0)
            for i, name in enumerate(names)}
