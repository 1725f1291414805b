"""stipple.view: the page of streams and arrays."""

import json
import unittest
import urllib.request

import numpy as np
import stipple


def asked(view, path):
    with urllib.request.urlopen(view.url + path, timeout=60) as answer:
        return answer.read()


class ViewTest(unittest.TestCase):
    video = np.random.default_rng(1).uniform(0.1, 0.9, (24, 16, 20)).astype(np.float32)

    def test_a_stream_and_arrays_are_shown(self):
        stream = stipple.emulate(self.video)
        with stipple.view(stream, self.video[:20], truth=self.video, method="fast") as view:
            self.assertEqual(json.loads(asked(view, "status")), {"slots": 24, "first": 0, "complete": True, "switched": [0]})
            codes = np.frombuffer(asked(view, "plane/v1-7"), "<u2")
            light = 2.0 ** ((codes.astype(float) - 1) / 128 - 14)
            np.testing.assert_allclose(light, self.video[7].ravel(), rtol=0.0028)
            self.assertEqual(len(asked(view, "plane/v0-7?wait=20000")), 2 * 16 * 20)
            self.assertIn(view.url, view._repr_html_())
        with self.assertRaises(OSError):
            asked(view, "status")

    def test_what_cannot_be_shown_is_an_error(self):
        with self.assertRaises(ValueError):
            stipple.view()
        with self.assertRaises(OSError):
            stipple.view("absent.stipple")
        with self.assertRaisesRegex(ValueError, "16 x 16|20 x 16"):
            stipple.view(self.video, self.video[:, :, :16])
        with self.assertRaisesRegex(ValueError, "method"):
            stipple.view(self.video, method="bst")


if __name__ == "__main__":
    unittest.main()
