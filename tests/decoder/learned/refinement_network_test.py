"""RefinementNetwork beside PyTorch, which runs the same weights."""

import importlib
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    torch = importlib.import_module("torch")
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(0)
nn = torch.nn


class Residual(nn.Module):
    def __init__(self, width):
        super().__init__()
        self.a = nn.Conv2d(width, width, 3, padding=1)
        self.b = nn.Conv2d(width, width, 3, padding=1)

    def forward(self, x):
        return x + self.b(torch.relu(self.a(x)))


class Net(nn.Module):
    """The network of decoder/learned/refinement_network.h."""

    def __init__(self, inputs=13, widths=(40, 64, 96), blocks=2):
        super().__init__()
        a, b, c = widths

        def stage(width):
            return nn.Sequential(*(Residual(width) for _ in range(blocks)))

        self.i = nn.Conv2d(4 * inputs, a, 3, padding=1)
        self.e1, self.d1 = stage(a), nn.Conv2d(a, b, 2, 2)
        self.e2, self.d2 = stage(b), nn.Conv2d(b, c, 2, 2)
        self.m = stage(c)
        self.u2, self.f2 = nn.ConvTranspose2d(c, b, 2, 2), stage(b)
        self.u1, self.f1 = nn.ConvTranspose2d(b, a, 2, 2), stage(a)
        self.o = nn.Conv2d(a, 4, 3, padding=1)

    def forward(self, x):
        h = self.e1(self.i(nn.functional.pixel_unshuffle(x, 2)))
        g = self.e2(self.d1(h))
        g = self.f2(g + self.u2(self.m(self.d2(g))))
        h = self.f1(h + self.u1(g))
        return x[:, :1] + nn.functional.pixel_shuffle(self.o(h), 2)


def write_safetensors(path, tensors):
    header, data = {"__metadata__": {"format": "pt"}}, b""
    for name, array in tensors.items():
        header[name] = {"dtype": {2: "F16", 4: "F32"}[array.itemsize], "shape": list(array.shape),
                        "data_offsets": [len(data), len(data) + array.nbytes]}
        data += array.tobytes()
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


class RefinementNetworkTest(unittest.TestCase):
    def check(self, net, dtype, rows, cols):
        """A sum of n products rounds to about sqrt(n) 6e-8 of its size, and n is at most 864."""
        arrays = {name: tensor.numpy().astype(dtype) for name, tensor in net.state_dict().items()}
        net.load_state_dict({name: torch.from_numpy(array.astype(np.float32)) for name, array in arrays.items()})
        planes = torch.rand(1, net.i.in_channels // 4, rows, cols)
        with torch.no_grad():
            padded = nn.functional.pad(planes, (0, -cols % 8, 0, -rows % 8), mode="replicate")
            wanted = net(padded)[0, 0, :rows, :cols].numpy()
        with tempfile.TemporaryDirectory() as folder:
            weights = os.path.join(folder, "net.safetensors")
            write_safetensors(weights, arrays)
            run = subprocess.run([os.environ["REFINE_PLANES"], weights, str(rows), str(cols)],
                                 input=planes.numpy().tobytes(), stdout=subprocess.PIPE, check=True)
        found = np.frombuffer(run.stdout, np.float32).reshape(rows, cols)
        correction = np.abs(wanted - planes[0, 0].numpy()).max()
        self.assertGreater(correction, 0.01)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-4 * correction)
        print(f"{rows} x {cols}: max difference {np.abs(found - wanted).max() / correction:.1e} of the correction")

    def test_a_network_of_the_usual_size(self):
        torch.manual_seed(1)
        self.check(Net(), np.float32, 64, 88)

    def test_half_precision(self):
        torch.manual_seed(2)
        self.check(Net(5, (16, 8, 24), 1), np.float16, 48, 40)

    def test_other_sizes_are_padded_by_their_edge(self):
        torch.manual_seed(3)
        self.check(Net(1, (8, 24, 16), 3), np.float32, 29, 51)


if __name__ == "__main__":
    unittest.main()
