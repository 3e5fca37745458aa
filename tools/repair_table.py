"""Tables of repairs before and after: `repair_table.py FOLDER/repair.jsonl [--times]`, from the record
that `physique repair FILES... -o FOLDER` keeps. Times mean something on a quiet machine only."""

import json
import statistics
import sys
from pathlib import Path

MEASURES = [
    ("self-intersection, mean, cm³", "self_intersection", "mean_cm3", 1),
    ("self-intersection, worst frame, cm³", "self_intersection", "worst_cm3", 0),
    ("in ground, mean, cm", "ground", "penetration_mean_cm", 2),
    ("in ground, worst, cm", "ground", "penetration_worst_cm", 2),
    ("above ground, mean, cm", "ground", "floating_mean_cm", 2),
    ("without support, % of frames", "ground", "unsupported_percent", 1),
    ("slide, mean, cm/s", "feet", "slide_mean_cm_s", 2),
    ("slide above 10 cm/s, % of frames", "feet", "slide_frames_percent", 1),
    ("in base of support, % of frames", "balance", "stable_percent", 1),
    ("outside base, mean, cm", "balance", "outside_mean_cm", 2),
    ("jerk, mean, m/s³", "smoothness", "jerk_mean_m_s3", 1),
    ("jitter, mean, mm", "smoothness", "jitter_mean_mm", 2),
]
GREATER_IS_BETTER = {"stable_percent"}
CLIPS = [0, 1, 2, 4, 6, 8, 10]


def source(file):
    for part, name in [("salsa", "CMU salsa"), ("iclone", "CMU iClone"), ("Motiondataset-1", "Bandai 1"),
                       ("Motiondataset-2", "Bandai 2"), ("100style", "100STYLE"), (".amc", "CMU recorded")]:
        if part in file:
            return name
    return Path(file).parent.name


def value(score, group, name):
    return (score[group] or {}).get(name)


def main():
    times = "--times" in sys.argv
    lines = [json.loads(line) for line in open(sys.argv[1], encoding="utf-8")][1:]
    motions = [motion for line in lines for motion in line["motions"] if motion["before"]]
    motions.sort(key=lambda motion: -motion["before"]["self_intersection"]["mean_cm3"])

    print("| measure | median before | after | worst clip before | after | clips better / worse |")
    print("|---|--:|--:|--:|--:|--:|")
    for title, group, name, digits in MEASURES:
        pairs = [(value(m["before"], group, name), value(m["after"], group, name)) for m in motions]
        pairs = [pair for pair in pairs if None not in pair]
        if not pairs:
            continue
        sign = -1 if name in GREATER_IS_BETTER else 1
        worst = min if sign < 0 else max
        cells = [f"{pick(pair[side] for pair in pairs):.{digits}f}"
                 for pick in (lambda v: statistics.median(list(v)), worst) for side in (0, 1)]
        unit = 0.5 * 10 ** -digits
        better = sum(sign * (before - after) > unit for before, after in pairs)
        worse = sum(sign * (after - before) > unit for before, after in pairs)
        print(f"| {title} | {' | '.join(cells)} | {better} / {worse} |")

    shown = [MEASURES[index] for index in CLIPS]
    print("\n| source | clip | s | " + " | ".join(title.replace(", mean", "") for title, *_ in shown)
          + " | outcome |" + (" took, s |" if times else ""))
    print("|---|---|--:|" + "--:|" * len(shown) + "---|" + ("--:|" if times else ""))
    for motion in motions:
        cells = []
        for _, group, name, digits in shown:
            before, after = (value(motion[side], group, name) for side in ("before", "after"))
            cells.append("–" if None in (before, after) else
                         f"{before:.{min(digits, 1)}f} → {after:.{min(digits, 1)}f}")
        print(f"| {source(motion['file'])} | `{motion['name']}` | {motion['before']['duration_s']:.1f} | "
              + " | ".join(cells)
              + f" | {motion['outcome'].replace('-', ' ')} |"
              + (f" {motion['took_s']:.1f} |" if times else ""))

    seconds = sum(motion["before"]["duration_s"] for motion in motions)
    took = sum(motion["took_s"] for motion in motions)
    print(f"\n{len(motions)} clips, {seconds:.0f} s of motion"
          + (f", {took:.0f} s of work." if times else "."))


main()
