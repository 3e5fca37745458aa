#!/usr/bin/env python3
"""Builds the two embedded fonts from the npm package `inter-ui` 4.1.1.

    python tools/fonts/build.py                    # fetches the package with npm
    python tools/fonts/build.py --source package   # takes one that is unpacked

The fonts are cut down to the characters that labels need, and figures are made tabular,
so that numbers stand under each other.
"""

import argparse
import hashlib
import io
import pathlib
import subprocess
import tarfile
import tempfile

from fontTools import subset
from fontTools.ttLib import TTFont

ASSETS = pathlib.Path(__file__).resolve().parents[2] / "crates" / "physique-view" / "assets"
PACKAGE = "inter-ui@4.1.1"
CHARACTERS = (
    set(range(0x20, 0x7F))
    | set(range(0xA0, 0x180))  # Latin-1 and Latin Extended-A: names of people and files
    | set(map(ord, "αβγδεθλμπρστφωΔΣΩ"))
    | set(map(ord, "–—‘’“”•…′″→←↑↓−×≈≠≤≥±°²³⁻½\ufffd"))
)


def build(source: pathlib.Path) -> bytes:
    """The subset of one WOFF2 file as an uncompressed TrueType file."""
    font = TTFont(source, recalcTimestamp=False)
    glyphs = set(font.getGlyphOrder())
    for table in font["cmap"].tables:
        for figure in "0123456789":
            name = table.cmap.get(ord(figure))
            if name and f"{name}.tf" in glyphs:
                table.cmap[ord(figure)] = f"{name}.tf"
    options = subset.Options()
    options.layout_features = []
    options.hinting = False
    options.drop_tables += ["GDEF", "GPOS", "GSUB", "STAT", "DSIG"]
    options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]  # the licence travels inside the font
    options.notdef_outline = True
    options.recalc_timestamp = False
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=CHARACTERS)
    subsetter.subset(font)
    font.flavor = None
    buffer = io.BytesIO()
    font.save(buffer)
    return buffer.getvalue()


def fetch(folder: pathlib.Path) -> pathlib.Path:
    """The package, unpacked below `folder`."""
    subprocess.run(["npm", "pack", "--silent", PACKAGE], cwd=folder, check=True)
    with tarfile.open(next(folder.glob("inter-ui-*.tgz"))) as archive:
        archive.extractall(folder, filter="data")
    return folder / "package"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", type=pathlib.Path, help="the unpacked package")
    parser.add_argument("--output", type=pathlib.Path, default=ASSETS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        package = arguments.source or fetch(pathlib.Path(temporary))
        for name in ("Inter-Regular", "Inter-SemiBold"):
            data = build(package / "web" / f"{name}.woff2")
            (arguments.output / f"{name}.ttf").write_bytes(data)
            print(f"{hashlib.sha256(data).hexdigest()}  {name}.ttf  {len(data)} bytes")


if __name__ == "__main__":
    main()
