"""Medians of scores over clips by what they show: `score_by_content.py SCORES.jsonl...`.

Reads the output of `physique score -o SCORES.jsonl`; several files add their groups of measures to
each other's clips. What a clip shows stands in its file's name (Bandai Namco, 100STYLE) or follows
from its folder (CMU's subjects and dances).
"""

import json
import re
import statistics
import sys

FOLDERS = {
    "01": "playground, as recorded", "02": "walk, run, jump, punch, as recorded",
    "03": "uneven ground, as recorded",
    "001": "playground: jumps, climbing", "002": "walk, run, jump, punch", "003": "uneven ground",
    "005": "modern dance, ballet", "006": "basketball", "007": "walk in many ways",
    "salsa": "salsa", "martial": "martial arts", "indian": "Indian dance",
    "train_data_bvh": "T-pose",
}
MEASURES = [
    ("self-intersection, cm³", "self_intersection", "mean_cm3", 1),
    ("in ground, cm", "ground", "penetration_mean_cm", 2),
    ("above, cm", "ground", "floating_mean_cm", 2),
    ("unsupported, %", "ground", "unsupported_percent", 1),
    ("flight, %", "ground", "flight_percent", 1),
    ("slide, cm/s", "feet", "slide_mean_cm_s", 1),
    ("in base, %", "balance", "stable_percent", 0),
    ("outside, cm", "balance", "outside_mean_cm", 1),
    ("margin, cm", "balance", "margin_mean_cm", 1),
    ("acceleration, m/s²", "smoothness", "acceleration_mean_m_s2", 1),
    ("jerk, m/s³", "smoothness", "jerk_mean_m_s3", 0),
    ("jitter, mm", "smoothness", "jitter_mean_mm", 2),
]


def content(file: str) -> str:
    """What a clip shows."""
    folder, name = file.split("/")[-2:]
    bandai = re.match(r"dataset-(\d)_([a-z-]+)_", name)
    if bandai:
        return f"Bandai {bandai[1]}: {bandai[2].replace('-', ' ')}"
    style = re.match(r"([A-Za-z]+)_([A-Z]{2})\.bvh", name)
    if style:
        kinds = {"W": "walk", "R": "run", "D": "idle"}
        return f"100STYLE: {kinds[style[2][1]]}"
    return f"CMU: {FOLDERS.get(folder, folder)}"


def main() -> None:
    clips: dict[str, dict] = {}
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as lines:
            next(lines)
            for line in lines:
                motion = json.loads(line)
                if motion["score"]:
                    measured = {k: v for k, v in motion["score"].items() if v is not None}
                    clips.setdefault(motion["file"], {}).update(measured)
    groups: dict[str, list[dict]] = {}
    for file, score in clips.items():
        groups.setdefault(content(file), []).append(score)
    print("| content | clips | " + " | ".join(name for name, *_ in MEASURES) + " |")
    print("|---|--:" + "|--:" * len(MEASURES) + "|")
    for name in sorted(groups):
        cells = [name, str(len(groups[name]))]
        for _, group, measure, digits in MEASURES:
            values = [score.get(group, {}).get(measure) for score in groups[name]]
            values = [value for value in values if value is not None]
            cells.append(f"{statistics.median(values):.{digits}f}" if values else "–")
        print("| " + " | ".join(cells) + " |")


main()
