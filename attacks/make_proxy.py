"""Writes the hostile proxy files into `proxy/`. Run it here: python3 make_proxy.py

Files of our own layout end in `.safetensors`. The others stand in for one file of a sound folder of
the published layout; `expected.tsv` says which. Only Python's own library is used.
"""
import io
import json
import os
import struct
import zipfile

os.makedirs("proxy", exist_ok=True)
os.chdir("proxy")
LIST = []


def write(name, data, tries, word, stands_for=""):
    with open(name, "wb") as file:
        file.write(data)
    LIST.append((name, stands_for, tries, word))


# --- our own layout ----------------------------------------------------------------------------

BETAS, WIDTH, SPHERES, JOINTS = 1, 2, 2, 22


def floats(*values):
    return struct.pack("<%df" % len(values), *values)


def words(*values):
    return struct.pack("<%dI" % len(values), *values)


def linear(arrays, name, inputs, outputs, normalised):
    weight = "weight_v" if normalised else "weight"
    arrays["%s.%s" % (name, weight)] = ("F32", [outputs, inputs], floats(*[0.1] * (outputs * inputs)))
    if normalised:
        arrays[name + ".weight_g"] = ("F32", [outputs, 1], floats(*[0.1] * outputs))
    arrays[name + ".bias"] = ("F32", [outputs], floats(*[0.1] * outputs))


def sound(betas=BETAS, width=WIDTH, spheres=SPHERES):
    arrays = {}
    layers = ["net1.0", "net1.2", "net1.4", "net1.6", "net2.0", "net2.2", "net2.4", "net2.6"]
    for layer in layers:
        inputs = betas if layer == "net1.0" else width
        outputs = width - betas if layer == "net1.6" else width
        linear(arrays, "spheres." + layer, inputs, outputs, True)
    linear(arrays, "spheres.net2.8", width, 4 * spheres, False)
    linear(arrays, "joints.linear_stack.0", betas, width, False)
    linear(arrays, "joints.linear_stack.2", width, width, False)
    linear(arrays, "joints.linear_stack.4", width, 3 * JOINTS, False)
    row = [1.0] + [0.0] * (JOINTS - 1)
    arrays["blend_weights"] = ("F32", [spheres, JOINTS], floats(*row * spheres))
    arrays["pairs"] = ("U32", [1, 2], words(0, 1))
    return arrays


def file_of(arrays, notes="physique-proxy 1\nposes: 3", offsets=None, raw=None):
    header, data = {"__metadata__": {"proxy": notes}}, b""
    for name, (kind, shape, values) in arrays.items():
        header[name] = {"dtype": kind, "shape": shape, "data_offsets": [len(data), len(data) + len(values)]}
        data += values
    for name, place in (offsets or {}).items():
        header[name]["data_offsets"] = place
    text = json.dumps(header) if raw is None else raw
    return struct.pack("<Q", len(text)) + text.encode() + data


def changed(tries, word, name, file=None, **notes):
    """A sound file but for some arrays."""
    arrays = sound()
    for array, value in (file or {}).items():
        if value is None:
            del arrays[array]
        else:
            arrays[array] = value
    write(name + ".safetensors", file_of(arrays, **notes), tries, word)


def header(name, tries, word, text, length=None, data=b""):
    length = len(text) if length is None else length
    write(name + ".safetensors", struct.pack("<Q", length) + text + data, tries, word)


changed("nothing: a sound file beside the others", "", "sound")
header("header_2_63", "a header of 2^63 bytes", "its header", b"{}", 2**63)
header("header_outside", "a header longer than the file", ".safetensors file", b"{}", 100000)
header("header_lists", "lists in lists in the header", ".safetensors file", b'{"__metadata__":' + b"[" * 9000)
header("header_not_utf8", "a header in no known encoding", ".safetensors file", b'{"\xff\xfe":1}')
header("header_twice", "notes twice in the header", ".safetensors file",
       b'{"__metadata__":{"proxy":"physique-proxy 1"},"__metadata__":{"proxy":"physique-proxy 1"}}')
changed("another version of the format", "physique-proxy 1", "version_2", notes="physique-proxy 2\nposes: 3")
changed("no version of the format", "no format", "version_none", notes="")
name = "spheres.net1.0.weight_v"
changed("an array that lies outside the file", ".safetensors file", "offsets_outside", offsets={name: [0, 2**40]})
changed("an array at the end of 64 bits", ".safetensors file", "offsets_2_64", offsets={name: [2**64 - 8, 2**64 - 1]})
changed("an array that ends before it begins", ".safetensors file", "offsets_backward", offsets={name: [8, 0]})
changed("two arrays in one place", ".safetensors file", "offsets_overlap", offsets={"pairs": [0, 8]})
changed("an array of 2^80 numbers", ".safetensors file", "shape_overflow", {name: ("F32", [2**40, 2**40], floats(0, 0))})
changed("an array of a negative length", ".safetensors file", "shape_negative", {name: ("F32", [-2, 1], floats(0, 0))})
changed("an array of 100 dimensions", "dimensions", "shape_100", {name: ("F32", [1] * 99 + [2], floats(0, 0))})
changed("numbers of a kind that does not exist", ".safetensors file", "kind_none", {name: ("F31", [2, 1], floats(0, 0))})
changed("weights in 64 bits", "F32, F16 or I8", "kind_f64", {name: ("F64", [2, 1], b"\0" * 16)})
changed("no first layer", "net1.0.weight_v", "layer_missing", {name: None})
changed("a network for no betas", "betas", "betas_none", {name: ("F32", [2, 0], b"")})
changed("a layer of 1,000 and none of the others", "net1.0.weight_g", "width_1000",
        {name: ("I8", [1000, 1], b"\1" * 1000), "spheres.net1.0.weight_g": None})
changed("4,097 spheres", "4096 spheres", "spheres_4097", {"spheres.net2.8.bias": ("I8", [16388], b"\0" * 16388)})
changed("a sphere and a half", "4 values a sphere", "spheres_half", {"spheres.net2.8.bias": ("F32", [6], floats(*[0.0] * 6))})
changed("joints for other betas", "betas as the spheres", "betas_differ", {
    "joints.linear_stack.0.weight": ("F32", [2, 3], floats(*[0.1] * 6))})
changed("a weight that is no number", "NaN", "weight_nan", {name: ("F32", [2, 1], floats(float("nan"), 1))})
changed("weights that overflow when they are squared", "too large to square", "weight_1e38", {name: ("F32", [2, 1], floats(1e38, 1e38))})
changed("weights without a direction", "row of zeros", "weight_zero", {name: ("F32", [2, 1], floats(0, 0))})
changed("a sphere of the radius e^1000", "radii", "radius_infinite", {
    "spheres.net2.8.bias": ("F32", [8], floats(1000, 0, 0, 0, 0, 0, 0, 0))})
changed("a sphere at infinity", "finite", "centre_infinite", {
    "spheres.net2.8.bias": ("F32", [8], floats(0, float("inf"), 0, 0, 0, 0, 0, 0))})
ROW = [0.0] * (JOINTS - 2)
changed("a sphere that follows five joints", "at most four", "blend_five", {
    "blend_weights": ("F32", [2, JOINTS], floats(*[0.2] * 5 + [0.0] * 17 + [1.0] + [0.0] * 21))})
changed("blend weights that are no numbers", "sum NaN", "blend_nan", {
    "blend_weights": ("F32", [2, JOINTS], floats(*([float("nan"), 1.0] + ROW) * 2))})
changed("blend weights of 1e38 and -1e38", "sum", "blend_1e38", {
    "blend_weights": ("F32", [2, JOINTS], floats(*([1e38, -1e38] + ROW) * 2))})
changed("blend weights of one sphere for two", "[2, 22]", "blend_short", {
    "blend_weights": ("F32", [1, JOINTS], floats(*[1.0] + [0.0] * 21))})
changed("a pair of spheres that are not there", "two different spheres", "pairs_outside", {"pairs": ("U32", [1, 2], words(0, 2**32 - 1))})
changed("a sphere with itself", "two different spheres", "pairs_itself", {"pairs": ("U32", [1, 2], words(1, 1))})
changed("a pair and a half", "[pairs, 2]", "pairs_half", {"pairs": ("U32", [1, 3], words(0, 1, 0))})
changed("pairs in bytes", "U32", "pairs_bytes", {"pairs": ("U8", [4, 2], b"\0\1" * 4)})
changed("the same pair a thousand times", "", "pairs_1000", {"pairs": ("U32", [1000, 2], words(*[0, 1] * 1000))})
NO_PAIRS = {"pairs": None, "pair_intersections": ("U32", [1], words(9))}
changed("more intersections than poses", "at most 3 poses", "counts_above_poses", NO_PAIRS)
changed("statistics of no number of poses", "number of poses", "counts_of_nothing", NO_PAIRS, notes="physique-proxy 1")
changed("statistics of -1 poses", "number of poses", "counts_negative", NO_PAIRS, notes="physique-proxy 1\nposes: -1")
changed("statistics of fewer pairs", "1 elements", "counts_short", {"pairs": None, "pair_intersections": ("U32", [0], b"")})

# --- the published layout ----------------------------------------------------------------------

REGRESSOR, WEIGHTS, MATRIX = "SR/sphere_regressor.pth", "boneweights.npy", "coll_mat_1jd90.npy"


def npy(shape, descr="<f8", data=b""):
    text = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }\n" % (descr, shape)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode() + data


def zipped(entries):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry, data in entries:
            info = zipfile.ZipInfo(entry, (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data)
    return out.getvalue()


SYSTEM = b"cos\nsystem\n(S'touch physique_was_here'\ntR."
TENSOR = (b"\x80\x02}X\x0f\x00\x00\x00net1.0.weight_vctorch._utils\n_rebuild_tensor_v2\n((U\x07storagectorch\n"
          b"FloatStorage\nU\x010U\x03cpuK\x04tQK\x00%sK\x01K\x01\x86\x89NtRs.")
write("os_system.pth", SYSTEM, "to run a command", "os.system", REGRESSOR)
write("os_system_zipped.pth", zipped([("archive/data.pkl", SYSTEM)]), "to run a command", "os.system", REGRESSOR)
write("module.pth", b"\x80\x02cSR.model\nRegressor\n)\x81.", "to load a class of its own", "SR.model.Regressor", REGRESSOR)
write("tensor_2_62.pth", zipped([("archive/data.pkl", TENSOR % (b"\x8a\x08" + struct.pack("<q", 2**62) + b"K\x01\x86")),
                                 ("archive/data/0", floats(1, 2, 3, 4))]), "a tensor of 2^62 rows", "storage", REGRESSOR)
write("bomb.pth", zipped([("archive/data.pkl", TENSOR % b"K\x02K\x02\x86"), ("archive/data/0", b"\0" * (40 << 20))]),
      "an archive of 40 kB that unpacks to 42 MB", "above the", REGRESSOR)
write("empty.pth", b"", "an empty file", "sphere_regressor.pth", REGRESSOR)
write("weights.pth", zipped([("net1.0.weight_v.npy", npy("(8192, 1)", "|i1", b"\1" * 8192)),
                             ("net2.8.bias.npy", npy("(4,)", "<f4", floats(0, 0, 0, 0)))]),
      "two small arrays of a network of 470 million numbers", "parameters", REGRESSOR)
write("weights_1000.pth", zipped([("net1.0.weight_v.npy", npy("(1000, 1)", "|i1", b"\1" * 1000)),
                                  ("net2.8.bias.npy", npy("(4,)", "<f4", floats(0, 0, 0, 0)))]),
      "two small arrays of a network of 7 million numbers", "net1.0.weight_g", REGRESSOR)
write("weights_objects.npy", npy("()", "|O", SYSTEM), "to run a command", "os.system", WEIGHTS)
write("weights_2_40.npy", npy("(1099511627776, 22)", "<f4"), "2^40 spheres that do not follow", "above the", WEIGHTS)
write("weights_text.npy", npy("(24, 22)", "<U1", b"1\0\0\0" * 528), "text for weights", "numbers", WEIGHTS)
write("weights_nan.npy", npy("(24, 22)", "<f4", floats(*[float("nan")] * 528)), "weights that are no numbers", "NaN", WEIGHTS)
write("matrix_2_32.npy", npy("(4294967296, 4294967296)", "<f8"), "2^64 pairs", "impossible shape", MATRIX)
write("matrix_nan.npy", npy("(24, 24)", "<f4", floats(*[float("nan")] * 576)), "marks that are no numbers", "finite number", MATRIX)
write("matrix_all.npy", npy("(24, 24)", "|b1", b"\1" * 576), "every pair left out", "", MATRIX)
write("matrix_short.npy", npy("(24, 24)", "<f8", b"\0" * 8), "a matrix that does not follow", "found", MATRIX)

with open("expected.tsv", "w") as file:
    file.writelines("\t".join(row) + "\n" for row in LIST)
