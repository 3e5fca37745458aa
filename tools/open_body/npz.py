"""Writes a deflated .npz file of which every byte follows from its arrays.

Python's `zipfile` calls whichever zlib the machine has, and zlib's successors deflate differently. So the
arrays are deflated by the pinned package zopfli (smaller, too), and the few records of a ZIP archive
(PKWARE APPNOTE 6.3.10, 4.3.7 to 4.3.16) are written here, without dates, owners or extra fields.
"""

import io
import struct
import zlib

import numpy as np
import zopfli.zlib

VERSION = 20  # of the ZIP specification: 2.0, deflate
DEFLATED = 8
TIME, DATE = 0, (1 << 5) | 1  # 1980-01-01, the earliest date a ZIP archive can name
ZLIB_HEADER, ZLIB_TRAILER = 2, 4  # bytes around the raw deflate stream


def write(path, named_arrays):
    records, directory = b"", b""
    for name, array in named_arrays.items():
        data = _npy(array)
        packed = zopfli.zlib.compress(data)[ZLIB_HEADER:-ZLIB_TRAILER]
        file_name = f"{name}.npy".encode("ascii")
        sizes = zlib.crc32(data), len(packed), len(data), len(file_name), 0
        common = struct.pack("<HHHHHIIIHH", VERSION, 0, DEFLATED, TIME, DATE, *sizes)
        place = struct.pack("<HHHII", 0, 0, 0, 0, len(records))
        directory += b"PK\x01\x02" + struct.pack("<H", VERSION) + common + place + file_name
        records += b"PK\x03\x04" + common + file_name + packed
    count = len(named_arrays)
    end = b"PK\x05\x06" + struct.pack("<HHHHIIH", 0, 0, count, count, len(directory), len(records), 0)
    path.write_bytes(records + directory + end)


def _npy(array):
    data = io.BytesIO()
    np.lib.format.write_array(data, np.ascontiguousarray(array), version=(1, 0), allow_pickle=False)
    return data.getvalue()
