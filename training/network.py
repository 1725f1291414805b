"""The network of the methods learned and learned_fast, in PyTorch, and the file of its weights."""

import json
import os
import struct

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

INPUTS = 15  # decoder/learned/refinement_inputs.h
WIDTHS = (32, 64, 96)


class Block(nn.Module):
    def __init__(self, width):
        super().__init__()
        self.a = nn.Conv2d(width, width, 3, padding=1)
        self.b = nn.Conv2d(width, width, 3, padding=1)
        nn.init.zeros_(self.b.weight)
        nn.init.zeros_(self.b.bias)

    def forward(self, x):
        return x + self.b(F.relu(self.a(x)))


class Network(nn.Module):
    """As decoder/learned/refinement_network.h has it."""

    def __init__(self, inputs=INPUTS, widths=WIDTHS, blocks=2):
        super().__init__()
        half, quarter, eighth = widths

        def chain(width):
            return nn.Sequential(*[Block(width) for _ in range(blocks)])

        self.i = nn.Conv2d(4 * inputs, half, 3, padding=1)
        self.e1, self.d1 = chain(half), nn.Conv2d(half, quarter, 2, 2)
        self.e2, self.d2 = chain(quarter), nn.Conv2d(quarter, eighth, 2, 2)
        self.m = chain(eighth)
        self.u2, self.f2 = nn.ConvTranspose2d(eighth, quarter, 2, 2), chain(quarter)
        self.u1, self.f1 = nn.ConvTranspose2d(quarter, half, 2, 2), chain(half)
        self.o = nn.Conv2d(half, 4, 3, padding=1)
        nn.init.zeros_(self.o.weight)
        nn.init.zeros_(self.o.bias)

    def forward(self, x):
        h = self.e1(self.i(F.pixel_unshuffle(x, 2)))
        g = self.e2(self.d1(h))
        g = self.f2(g + self.u2(self.m(self.d2(g))))
        return x[:, :1] + F.pixel_shuffle(self.o(self.f1(h + self.u1(g))), 2)


def write_safetensors(path, arrays, metadata):
    """Arrays of float16 or float32 in the format of safetensors: length of the header, header, data."""
    header, data = {"__metadata__": metadata}, b""
    for name, array in arrays.items():
        header[name] = {"dtype": {2: "F16", 4: "F32"}[array.itemsize], "shape": list(array.shape),
                        "data_offsets": [len(data), len(data) + array.nbytes]}
        data += array.tobytes()
    text = json.dumps(header, sort_keys=True).encode()
    text += b" " * (-len(text) % 8)
    partial = f"{path}.partial"
    with open(partial, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)
    os.replace(partial, path)


def read_safetensors(path):
    """The arrays as float32 tensors, by name."""
    with open(path, "rb") as file:
        header, data = json.loads(file.read(struct.unpack("<Q", file.read(8))[0])), file.read()
    return {name: torch.from_numpy(np.frombuffer(data[slice(*entry["data_offsets"])], {"F16": "<f2", "F32": "<f4"}[entry["dtype"]])
                                   .reshape(entry["shape"]).astype(np.float32))
            for name, entry in header.items() if name != "__metadata__"}
