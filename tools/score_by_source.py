"""Tables of docs/real-motion.md: `score_by_source.py SCORES.jsonl`.

Reads the output of `physique score -o SCORES.jsonl`: self-intersection by source of the clips, then
the twenty worst clips. The source follows from a clip's folders.
"""

import json
import statistics
import sys


def source(file: str) -> str:
    """Where a clip comes from."""
    for part, name in [
        ("motiondataset-1", "Bandai Namco 1"), ("motiondataset-2", "Bandai Namco 2"),
        ("100style", "100STYLE"), ("iclone", "CMU, iClone"),
    ]:
        if part in file.lower():
            return name
    if file.endswith(".amc"):
        return "CMU, as recorded"
    return "CMU, " + file.split("/")[-2]


def read(path: str) -> list[dict]:
    """The clips that were scored."""
    with open(path, encoding="utf-8") as lines:
        next(lines)
        clips = [json.loads(line) for line in lines]
    scored = [clip for clip in clips if clip["score"]]
    print(f"{len(clips)} clips, {len(clips) - len(scored)} not scored, "
          f"{sum(clip['score']['frames'] for clip in scored)} frames\n")
    return scored


def by_source(clips: list[dict]) -> None:
    groups: dict[str, list[dict]] = {}
    for clip in clips:
        groups.setdefault(source(clip["file"]), []).append(clip)
    print("| source | clips | frames | self-intersection: median of clips, cm³ | worst clip, cm³ "
          "| creases: median, cm³ | mapping: median of mean errors, cm |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for name, group in sorted(groups.items()):
        found = [clip["score"]["self_intersection"] for clip in group]
        means = [one["mean_cm3"] for one in found]
        creases = statistics.median(one["crease_mean_cm3"] for one in found)
        errors = statistics.median(clip["mapping"]["mean_error_cm"] for clip in group)
        frames = sum(clip["score"]["frames"] for clip in group)
        print(f"| {name} | {len(group)} | {frames} | {statistics.median(means):.1f} "
              f"| {max(means):.0f} | {creases:.0f} | {errors:.1f} |")
    of_all = statistics.median(clip["score"]["self_intersection"]["mean_cm3"] for clip in clips)
    print(f"\nmedian of all clips: {of_all:.1f} cm³\n")


def worst(clips: list[dict], count: int) -> None:
    clips = sorted(clips, key=lambda clip: -clip["score"]["self_intersection"]["mean_cm3"])
    print("| source | clip | mean, cm³ | worst, cm³ | at, s | frames above 50 cm³, % "
          "| worst pair, mean cm³ |")
    print("|---|---|--:|--:|--:|--:|---|")
    for clip in clips[:count]:
        found = clip["score"]["self_intersection"]
        pair = found["pairs"][0]
        print(f"| {source(clip['file'])} | `{clip['file'].split('/')[-1]}` | {found['mean_cm3']:.0f} "
              f"| {found['worst_cm3']:.0f} | {found['worst_s']:.1f} "
              f"| {found['frames_above_50_cm3_percent']:.0f} "
              f"| {' – '.join(pair['parts'])} {pair['mean_cm3']:.0f} |")


def main() -> None:
    clips = read(sys.argv[1])
    by_source(clips)
    worst(clips, 20)


main()
