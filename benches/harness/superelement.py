"""Reads a superelement by the safetensors layout: length, JSON header, data."""

import json
import pathlib
import struct

import numpy as np


def read(path):
    """Its tensors by name."""
    content = pathlib.Path(path).read_bytes()
    (length,) = struct.unpack("<Q", content[:8])
    header = json.loads(content[8 : 8 + length])
    header.pop("__metadata__")
    data = content[8 + length :]
    return {
        name: np.frombuffer(data[slice(*entry["data_offsets"])], dtype="<f8").reshape(entry["shape"])
        for name, entry in header.items()
        if entry["dtype"] == "F64"
    }
