"""Files of cameras: their numbers as bytes, and the light that the program makes of them."""

import numpy as np
from program import INPUT, OK, ProgramTest


MOSAIC = np.arange(4 * 6 * 8).reshape(4, 6, 8) * 21  # up to 4011


def lsb_packed(values, bits):
    """Rows of samples as a bit string each, from the lowest bit on (PFNC "p")."""
    string = (np.asarray(values)[..., None] >> np.arange(bits)) & 1
    return np.packbits(string.reshape(*values.shape[:-1], -1), axis=-1, bitorder="little").tobytes()


def msb_packed(values, bits):
    """The same from the highest bit on."""
    string = (np.asarray(values)[..., None] >> np.arange(bits)[::-1]) & 1
    return np.packbits(string.reshape(*values.shape[:-1], -1), axis=-1).tobytes()


class CameraFilesTest(ProgramTest):
    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
        return name

    def light(self, footage, *options):
        """The light that was emulated. What was said stands in self.said."""
        done = self.run_program("emulate", footage, "-o", "clip.stipple", "--truth", "light.npy", "--force", "-q",
                                *options)
        self.assertEqual(done.returncode, OK, done.stderr)
        self.said = done.stderr
        return self.array("light.npy")

    def assert_light(self, expected, footage, *options):
        np.testing.assert_allclose(self.light(footage, *options), np.asarray(expected), rtol=1e-6, atol=1e-9)

    def refuse(self, parts, footage, *options):
        self.fails(INPUT, [f"stipple: error: {footage}: ", *parts], "emulate", footage, "-o", "x.stipple", *options)
