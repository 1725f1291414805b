"""A program built without Aravis and V4L2 (preset bare): what it has not it names, the rest works."""

import unittest

import numpy as np
from program import DEVICE, ProgramTest

NO_ARAVIS, NO_V4L2 = "-DSTIPPLE_ARAVIS=ON", "-DSTIPPLE_V4L2=ON"


class WithoutCamerasTest(ProgramTest):
    def test_each_address_says_what_is_missing_and_how_to_have_it(self):
        for address, fix in (("gige:127.0.0.1", NO_ARAVIS), ("usb:12345", NO_ARAVIS),
                             ("v4l2:/dev/video0", NO_V4L2)):
            self.fails(DEVICE, (address, "built without", fix),
                       "capture", "record", address, "-o", "clip.strec")
            self.fails(DEVICE, (address, "built without", fix), "capture", "features", address)

    def test_the_list_and_the_doctor_say_it_too(self):
        for words, reasons in ((["list"], [NO_ARAVIS, NO_V4L2]), (["doctor"], [NO_V4L2]),
                               (["doctor", "gige:127.0.0.1"], [NO_ARAVIS])):
            said = self.run_program("capture", *words)
            for reason in reasons:
                self.assertIn(reason, said.stdout + said.stderr)

    def test_recordings_are_played_as_ever(self):
        self.write_array("light.npy", np.random.default_rng(1).random((5, 16, 16)))
        self.succeed("capture", "record", "replay:light.npy", "-o", "clip.strec")
        self.assertIn("clip.strec", self.names())


if __name__ == "__main__":
    unittest.main()
