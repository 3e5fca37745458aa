"""Writes the hostile motion files into `motion/`. Run it here: python3 make_motion.py

Only Python's own library is used; every file is small. What is larger, the test makes in memory.
"""
import base64
import json
import os
import pickle
import struct
import zipfile

os.makedirs("motion", exist_ok=True)
os.chdir("motion")


def write(name, data):
    with open(name, "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())


# --- BVH ---------------------------------------------------------------------------------------

LEG = """HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
JOINT Leg
{
OFFSET 0 -40 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 -40 0
}
}
}
MOTION
Frames: 1
Frame Time: 0.05
0 80 0 0 0 0 0 0 0
"""

write("frames_4000000000.bvh", LEG.replace("Frames: 1", "Frames: 4000000000"))
write("frames_of_20_digits.bvh", LEG.replace("Frames: 1", "Frames: 99999999999999999999"))
write("frames_promised.bvh", LEG.replace("Frames: 1", "Frames: 2000000"))
write("frames_negative.bvh", LEG.replace("Frames: 1", "Frames: -1"))
write("channels_4000000000.bvh", LEG.replace("CHANNELS 3", "CHANNELS 4000000000"))
write("channels_repeated.bvh", LEG.replace("CHANNELS 3 Zrotation Xrotation Yrotation",
                                           "CHANNELS 3 Zrotation Zrotation Zrotation"))
write("braces_missing.bvh", LEG.replace("}\n}\n}\nMOTION", "MOTION"))
write("braces_only.bvh", "HIERARCHY\nROOT a\n{" + "}" * 5000)
write("joints_nested_3000.bvh", "HIERARCHY\nROOT a\n{\n" + "JOINT b\n{\n" * 3000)
write("roots_3000.bvh", "HIERARCHY\n" + "ROOT a\n{\n}\n" * 3000)
write("idle_joints.bvh", "HIERARCHY\n" + "ROOT a\n{\n}\n" * 1000 + "MOTION\nFrames: 2000000\nFrame Time: 1\n")
write("nan.bvh", LEG.replace("0 80 0", "0 nan 0"))
write("numbers_1e308.bvh", LEG.replace("0 80 0", "0 1e308 0"))
write("offset_1e308.bvh", LEG.replace("0 -40 0", "0 -1e308 0"))
write("offset_1e38.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 3e38 0\nCHANNELS 3 Xposition Yposition Zposition\n"
      + "JOINT b\n{\nOFFSET 0 3e38 0\n" * 60 + "}\n" * 61 + "MOTION\nFrames: 1\nFrame Time: 1\n0 3e38 0\n")
write("angles_1e38.bvh", LEG.replace("0 80 0 0 0 0", "0 80 0 1e38 3e38 -1e38"))
write("frame_time_nan.bvh", LEG.replace("0.05", "nan"))
write("frame_time_1e-320.bvh", LEG.replace("0.05", "1e-320"))
write("frame_time_1e-30.bvh", LEG.replace("0.05", "1e-30"))
write("not_utf8.bvh", LEG.encode().replace(b"Leg", b"\xff\xfe\xc0\x80"))
write("zeros.bvh", LEG.encode().replace(b"0 80 0", b"0 8\x000 0"))
write("name_without_end.bvh", "HIERARCHY\nROOT " + "a" * 20000)
write("comment_without_end.bvh", "HIERARCHY\n" + "#" * 20000)

# --- ASF/AMC -----------------------------------------------------------------------------------

ASF = """:version 1.10
:units
 mass 1
 length 0.45
 angle deg
:root
 order TX TY TZ RX RY RZ
 axis XYZ
 position 0 0 0
 orientation 0 0 0
:bonedata
begin
 name upper
 direction 1 0 0
 length 8
 axis 0 0 90 XYZ
 dof rx ry rz
end
begin
 name lower
 direction 1 0 0
 length 7
 axis 0 0 90 XYZ
 dof rx
end
:hierarchy
begin
root upper
upper lower
end
"""
AMC = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 17 0 0 0 0\nupper 1 2 3\nlower 4\n2\nroot 0 17 0 0 0 0\nupper 1 2 3\nlower 4\n"


def pair(name, asf=ASF, amc=AMC):
    write(name + ".asf", asf)
    write(name + ".amc", amc)


pair("sound_pair")
pair("circle", ASF.replace("root upper\nupper lower", "upper lower\nlower upper"))
pair("two_parents", ASF.replace("root upper\n", "root upper lower\n"))
pair("bones_3000", ASF.replace(":hierarchy", "begin\nname b\nend\n" * 3000 + ":hierarchy"))
pair("children_9000", ASF.replace("root upper\n", "root" + " upper" * 9000 + "\n"))
pair("chain_of_500", ":bonedata\n" + "".join("begin\nname b%d\nend\n" % i for i in range(500))
     + ":hierarchy\nbegin\nroot b0\n" + "".join("b%d b%d\n" % (i, i + 1) for i in range(499)) + "end\n", "1\nroot 0 0 0 0 0 0\n")
pair("length_1e308", ASF.replace("length 8", "length 1e308"))
pair("factor_1e-300", ASF.replace("length 0.45", "length 1e-300"))
pair("dof_repeated", ASF.replace("dof rx ry rz", "dof" + " rx" * 2000))
pair("names_not_utf8", ASF.encode().replace(b"upper", b"\xff\xc0"), AMC.encode().replace(b"upper", b"\xff\xc0"))
pair("amc_nan", amc=AMC.replace("lower 4", "lower nan"))
pair("amc_1e308", amc=AMC.replace("17", "1e308"))
pair("amc_frames_skipped", amc=AMC.replace("\n2\n", "\n18446744073709551615\n"))
pair("amc_idle_frames", amc=AMC.replace(":FULLY-SPECIFIED\n", "") + "".join("%d\n" % i for i in range(3, 9000)))
pair("amc_zeros", amc=AMC.replace("root", "ro\0ot"))
pair("asf_binary", bytes(range(256)) * 20)
write("no_skeleton.amc", AMC)

# --- glTF --------------------------------------------------------------------------------------

DATA = struct.pack("<2f6f", 0, 1, 0, 0, 0, 1, 0, 0)


def gltf(name, change=lambda document: None, data=DATA, raw=lambda text: text):
    document = {
        "asset": {"version": "2.0"},
        "nodes": [{"name": "a", "children": [1]}, {"name": "b", "translation": [0, 1, 0]}],
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                      {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "animations": [{"name": "walk", "samplers": [{"input": 0, "output": 1}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
    }
    change(document)
    write(name, raw(json.dumps(document)))


def put(*path_and_value):
    *path, key, value = path_and_value

    def change(document):
        for step in path:
            document = document[step]
        document[key] = value
    return change


gltf("sound.gltf")
gltf("count_2_60.gltf", put("accessors", 1, "count", 2**60))
gltf("count_2_60_of_nothing.gltf", put("accessors", 1, {"componentType": 5126, "count": 2**60, "type": "VEC3"}))
gltf("count_2_64.gltf", put("accessors", 1, "count", 2**64))
gltf("offset_overflow.gltf", put("accessors", 1, "byteOffset", 2**64 - 1))
gltf("view_overflow.gltf", put("bufferViews", 1, "byteOffset", 2**64 - 8))
gltf("view_outside.gltf", put("bufferViews", 1, "byteLength", 4000000000))
gltf("stride_overflow.gltf", put("bufferViews", 1, "byteStride", 2**63))
gltf("buffer_outside.gltf", put("buffers", 0, "byteLength", 4000000000))
gltf("sparse_outside.gltf", put("accessors", 1, "sparse", {
    "count": 2, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}))
gltf("sparse_2_60.gltf", put("accessors", 1, "sparse", {
    "count": 2**60, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}))
gltf("circle.gltf", put("nodes", 1, "children", [0]))
gltf("own_child.gltf", put("nodes", 0, "children", [0]))
gltf("child_outside.gltf", put("nodes", 0, "children", [2**63]))
gltf("nested_nodes_500.gltf", put("nodes", [{"children": [i + 1]} for i in range(500)] + [{}]))
gltf("nodes_2000.gltf", put("nodes", [{"children": list(range(1, 2000))}] + [{} for _ in range(1999)]))
gltf("skins_300.gltf", put("skins", [{"joints": [0, 1]}] * 300))
gltf("skin_of_one_node.gltf", put("skins", [{"joints": [0] * 9000}]))
gltf("binds_singular.gltf", put("skins", [{"joints": [0, 1], "inverseBindMatrices": 2}]), raw=lambda text: text.replace(
    '"type": "VEC3"}]', '"type": "VEC3"}, {"componentType": 5126, "count": 2, "type": "MAT4"}]'))
gltf("scale_zero.gltf", put("nodes", 0, "scale", [0, 0, 0]))
gltf("scale_1e30.gltf", put("nodes", 0, "scale", [1e30, 1e30, 1e30]))
gltf("translation_1e308.gltf", put("nodes", 0, "translation", [1e308, 0, 0]))
gltf("nan_word.gltf", raw=lambda text: text.replace("[0, 1, 0]", "[0, NaN, 0]"))
gltf("nan_key.gltf", data=struct.pack("<2f6f", 0, float("nan"), 0, 0, 0, 1, 0, 0))
gltf("key_at_1e30.gltf", data=struct.pack("<2f6f", 0, 1e30, 0, 0, 0, 1, 0, 0))
gltf("key_at_1e9.gltf", data=struct.pack("<2f6f", 0, 1e9, 0, 0, 0, 1, 0, 0))
gltf("keys_1e-30_apart.gltf", data=struct.pack("<2f6f", 0, 1e-30, 0, 0, 0, 1, 0, 0))
gltf("keys_backward.gltf", data=struct.pack("<2f6f", 1, 0, 0, 0, 0, 1, 0, 0))
gltf("infinite_path.gltf", data=struct.pack("<2f6f", 0, 1, 0, 0, 0, float("inf"), 0, 0))
gltf("file_above.gltf", put("buffers", 0, "uri", "../../README.md"))
gltf("file_above_encoded.gltf", put("buffers", 0, "uri", "%2e%2e/%2e%2e/README.md"))
gltf("file_of_the_system.gltf", put("buffers", 0, "uri", "/etc/passwd"))
gltf("file_url.gltf", put("buffers", 0, "uri", "file:///etc/passwd"))
gltf("web_address.gltf", put("buffers", 0, "uri", "http://127.0.0.1/a.bin"))
gltf("itself.gltf", put("buffers", 0, "uri", "itself.gltf"))
gltf("folder.gltf", put("buffers", 0, "uri", "."))
gltf("not_base64.gltf", put("buffers", 0, "uri", "data:;base64,~~~~"))
gltf("packed.gltf", put("extensionsRequired", ["EXT_meshopt_compression"]))
gltf("same_keys_900_times.gltf", put("animations", 0, "channels", [
    {"sampler": 0, "target": {"node": 0, "path": "translation"}}] * 900))
gltf("animations_900.gltf", lambda document: put("animations", [document["animations"][0]] * 900)(document))
gltf("lists_nested_9000.gltf", raw=lambda text: text[:-1] + ', "extras": ' + "[" * 9000)
gltf("objects_9000.gltf", put("nodes", [{}] * 9000))


def glb(name, json_length=None, length=None, version=2, text=b"{}  "):
    chunk = struct.pack("<I", len(text) if json_length is None else json_length) + b"JSON" + text
    whole = 12 + len(chunk) if length is None else length
    write(name, b"glTF" + struct.pack("<II", version, whole) + chunk)


glb("header_only.glb", text=b"")
glb("chunk_4_gb.glb", json_length=0xFFFFFFFF)
glb("length_4_gb.glb", length=0xFFFFFFFF)
glb("length_short.glb", length=14)
glb("version_1.glb", version=1)
glb("not_utf8.glb", text=b'{"asset": "\xff\xfe"}')

# --- arrays ------------------------------------------------------------------------------------


def npy(shape, descr="<f8", data=b""):
    text = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }\n" % (descr, shape)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode() + data


def npz(name, **arrays):
    with zipfile.ZipFile(name, "w", zipfile.ZIP_DEFLATED) as archive:
        for key, data in arrays.items():
            info = zipfile.ZipInfo(key + ".npy", (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data)


def doubles(*values):
    return struct.pack("<%dd" % len(values), *values)


ZERO_POSE = npy("(2, 156)", data=doubles(*[0.0] * 312))
TRANS = npy("(2, 3)", data=doubles(*[0.0] * 6))
RATE = npy("()", data=doubles(30.0))
npz("amass_sound.npz", poses=ZERO_POSE, trans=TRANS, mocap_framerate=RATE)
npz("amass_frames_2_40.npz", poses=npy("(1099511627776, 156)"), trans=TRANS, mocap_framerate=RATE)
npz("amass_nan.npz", poses=npy("(2, 156)", data=doubles(*[float("nan")] * 312)), trans=TRANS, mocap_framerate=RATE)
npz("amass_1e308.npz", poses=npy("(2, 156)", data=doubles(*[1e308] * 312)), trans=TRANS, mocap_framerate=RATE)
npz("amass_rate_nan.npz", poses=ZERO_POSE, trans=TRANS, mocap_framerate=npy("()", data=doubles(float("nan"))))
npz("amass_rate_0.npz", poses=ZERO_POSE, trans=TRANS, mocap_framerate=npy("()", data=doubles(0.0)))
npz("amass_path_short.npz", poses=ZERO_POSE, trans=npy("(1, 3)", data=doubles(0, 0, 0)), mocap_framerate=RATE)
npz("amass_path_1e308.npz", poses=ZERO_POSE, trans=npy("(2, 3)", data=doubles(*[1e308] * 6)), mocap_framerate=RATE)
npz("amass_text.npz", poses=npy("(2, 156)", "<U4", b"abcd" * 4 * 312), trans=TRANS, mocap_framerate=RATE)
npz("amass_bomb.npz", poses=npy("(100000, 156)", data=b"\0" * (100000 * 156 * 8)), trans=TRANS, mocap_framerate=RATE)
npz("native_empty.npz", physique_motion=npy("()", data=doubles(1.0)))
npz("native_frames_2_40.npz", physique_motion=npy("()", "<i8", struct.pack("<q", 1)),
    rotations=npy("(1099511627776, 22, 4)", "<f4"), root_translation=npy("(1099511627776, 3)", "<f4"),
    frame_rate=RATE)
FEATURES = [0.0] * 263
write("features_frames_2_40.npy", npy("(1099511627776, 263)", "<f4"))
write("features_none.npy", npy("(0, 263)", "<f4"))
write("features_nan.npy", npy("(2, 263)", data=doubles(*[float("nan")] * 526)))
write("features_1e308.npy", npy("(2, 263)", data=doubles(*[1e308] * 526)))
write("features_1e38.npy", npy("(2, 263)", data=doubles(*[1e38] * 526)))
write("features_zero.npy", npy("(2, 263)", data=doubles(*[0.0] * 526)))
write("positions_nan.npy", npy("(2, 22, 3)", data=doubles(*[float("nan")] * 132)))
write("positions_1e38.npy", npy("(2, 22, 3)", data=doubles(*([1e38, -1e38, 3e38] * 44))))
write("positions_one_place.npy", npy("(2, 22, 3)", data=doubles(*[0.5] * 132)))
write("positions_2_20_motions.npy", npy("(1048576, 22, 3, 1048576)", "<f4"))
write("motions_2_40_of_no_frames.npy", npy("(1099511627776, 0, 263)", "<f4"))
npz("results_2_40_of_no_frames.npz", motion=npy("(1099511627776, 22, 3, 0)", "<f4"), text=npy("(0,)", "<f4"))

# A dictionary as MDM's results.npy holds it, whose lengths lie.
ARRAY = npy("(1, 22, 3, 2)", "<f4", b"\0" * 528)
write("results_lengths.pkl", pickle.dumps({"motion": [[0.0] * 10], "lengths": [2**62], "text": ["a"] * 3, "num_samples": -1}, 2))

# --- DeepMimic and tables ----------------------------------------------------------------------

STAND = [0.05] + [0.0] * 43
for quaternion in (4, 8, 12, 16, 21, 25, 30, 35, 39):
    STAND[quaternion] = 1.0


def deep_mimic(name, *rows, raw=lambda text: text):
    write(name, raw(json.dumps({"Loop": "wrap", "Frames": list(rows)})))


def row(**changes):
    changed = list(STAND)
    for at, value in changes.items():
        changed[int(at[1:])] = value
    return changed


deep_mimic("deep_mimic_sound.json", STAND, STAND, STAND)
deep_mimic("deep_mimic_times.json", row(_0=1e-300), row(_0=1e300), STAND)
deep_mimic("deep_mimic_step_1e-9.json", row(_0=1e-9), row(_0=1000.0), STAND)
deep_mimic("deep_mimic_negative.json", row(_0=-1.0), STAND)
deep_mimic("deep_mimic_no_turn.json", row(_4=0.0), STAND)
deep_mimic("deep_mimic_turn_1e308.json", row(_4=1e308), STAND)
deep_mimic("deep_mimic_path_1e308.json", row(_1=1e308), STAND)
deep_mimic("deep_mimic_short_row.json", STAND[:-1], STAND)
deep_mimic("deep_mimic_nested.json", raw=lambda text: text.replace("[]", "[" * 9000))
deep_mimic("deep_mimic_1e999.json", STAND, raw=lambda text: text.replace("0.05", "1e999"))
write("table_nan.csv", "time_s,pelvis_x_m,pelvis_y_m,pelvis_z_m\n0,nan,0,0\n")
write("table_columns.csv", "time_s" + ",a" * 9000 + "\n")
