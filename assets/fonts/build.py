#!/usr/bin/env python3
"""Build the two embedded fonts from the npm package `inter-ui` 4.1.1.

    npm pack inter-ui@4.1.1 && tar xzf inter-ui-4.1.1.tgz
    pip install fonttools==4.68.0 brotli
    python build.py package            # writes Inter-Regular.ttf and Inter-SemiBold.ttf beside this file
    python build.py package --check    # compares hashes with card.md instead

The fonts are cut down to the characters that labels need, and figures are made tabular,
so that numbers stand under each other.
"""

import hashlib
import io
import pathlib
import sys

from fontTools import subset
from fontTools.ttLib import TTFont

HERE = pathlib.Path(__file__).parent
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


def main() -> int:
    package = pathlib.Path(sys.argv[1])
    check = "--check" in sys.argv[2:]
    card = (HERE / "card.md").read_text() if check else ""
    for name in ("Inter-Regular", "Inter-SemiBold"):
        data = build(package / "web" / f"{name}.woff2")
        digest = hashlib.sha256(data).hexdigest()
        print(f"{digest}  {name}.ttf  {len(data)} bytes")
        if not check:
            (HERE / f"{name}.ttf").write_bytes(data)
        elif digest not in card:
            print(f"{name}.ttf differs from the hash in card.md", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
