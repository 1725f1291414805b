"""RefinementNetwork beside PyTorch, which runs the same weights."""

import importlib
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
    torch = importlib.import_module("torch")
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(0)
nn = torch.nn
sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "training"))
network = importlib.import_module("network")


def random_network(*sizes):
    """With layers that are not 0, as those at the start of a training are."""
    net = network.Network(*sizes)
    for layer in net.modules():
        if hasattr(layer, "reset_parameters"):
            layer.reset_parameters()
    return net


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
            network.write_safetensors(weights, arrays, {"format": "pt"})
            run = subprocess.run([os.environ["REFINE_PLANES"], weights, str(rows), str(cols)],
                                 input=planes.numpy().tobytes(), stdout=subprocess.PIPE, check=True)
        found = np.frombuffer(run.stdout, np.float32).reshape(rows, cols)
        correction = np.abs(wanted - planes[0, 0].numpy()).max()
        self.assertGreater(correction, 0.01)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-4 * correction)
        print(f"{rows} x {cols}: max difference {np.abs(found - wanted).max() / correction:.1e} of the correction")

    def test_a_network_of_the_usual_size(self):
        torch.manual_seed(1)
        self.check(random_network(), np.float32, 64, 88)

    def test_half_precision(self):
        torch.manual_seed(2)
        self.check(random_network(5, (16, 8, 24), 1), np.float16, 48, 40)

    def test_other_sizes_are_padded_by_their_edge(self):
        torch.manual_seed(3)
        self.check(random_network(1, (8, 24, 16), 3), np.float32, 29, 51)


if __name__ == "__main__":
    unittest.main()
