"""`stipple view`: what its server answers, and whom it refuses. The page itself is in view_page_test."""

import http.client
import json
import subprocess
import time
import unittest
from concurrent.futures import ThreadPoolExecutor
from urllib.parse import urlencode, urlsplit

import numpy as np
from program import DEVICE, INPUT, PROGRAM, USAGE, ProgramTest

COLS, ROWS, SLOTS = 48, 32, 60


def light_of(codes):
    """Light of the codes of a picture (docs/report.md)."""
    return np.where(codes == 0, 0, 2.0 ** ((codes.astype(float) - 1) / 128 - 14))


class Viewer:
    """A running `stipple view`."""

    def __init__(self, test, *arguments):
        self.program = test.start_program("view", *arguments, "--json", "view.json", "--force", stdout=-1)
        test.addCleanup(self.program.stdout.close)
        test.addCleanup(self.program.stderr.close)
        test.addCleanup(self.program.wait)
        test.addCleanup(self.program.terminate)
        self.url = self.program.stdout.readline().strip()
        test.assertTrue(self.url, "no address: see standard error")
        self.use_address()

    @classmethod
    def of(cls, url):
        """Of a page that another program serves."""
        viewer = cls.__new__(cls)
        viewer.url = url
        viewer.use_address()
        return viewer

    def use_address(self):
        self.port = urlsplit(self.url).port
        self.path = urlsplit(self.url).path

    def ask(self, path="", fields=None, method="GET", body=None, **keys):
        """(status, header fields, bytes) of the answer."""
        query = f"?{urlencode(keys)}" if keys else ""
        return self.ask_for(f"{self.path}{path}{query}", fields, method, body)

    def ask_for(self, target, fields=None, method="GET", body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            connection.request(method, target, body, headers=fields or {})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def picture(self, video, slot, **keys):
        for _ in range(20):  # a slow program answers without a picture meanwhile
            status, fields, data = self.ask(f"plane/v{video}-{slot}", **{"viewer": "t", "wait": 20000, **keys})
            assert status == 200, data
            if data:
                break
        return fields, np.frombuffer(data, "<u2")

    def json(self, path, **keys):
        status, _, data = self.ask(path, **keys)
        assert status == 200, data
        return json.loads(data)


class ViewTest(ProgramTest):
    def make_clip(self, *options, slots=SLOTS):
        self.succeed("synth", "pan", "-o", "scene.npy", "--frames", slots, "--size", f"{COLS}x{ROWS}")
        self.succeed("emulate", "scene.npy", "-o", "clip.stipple", *options)

    def test_the_last_picture_of_a_slot_has_the_light_of_decode(self):
        self.make_clip("--luminance")
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "fast")
        decoded = self.array("decoded.npy")
        viewer = Viewer(self, "clip.stipple", "--method", "fast")
        for slot in (3, 50, SLOTS - 1):
            seen, level = [], 0
            while level < 3:
                fields, codes = viewer.picture(0, slot, than=level)
                level = int(fields["Stipple-Level"])
                seen.append(fields["Stipple-Method"])
            self.assertEqual(seen[-1], "fast")
            expected = np.where(decoded[slot].ravel() < 2.0 ** -14.01, 0, decoded[slot].ravel())
            np.testing.assert_allclose(light_of(codes), expected, rtol=0.0028, atol=2.0 ** -14)

    def test_the_first_picture_of_a_slot_has_the_light_of_the_method_live(self):
        self.make_clip("--luminance", slots=130)  # three blocks
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "live")
        decoded = self.array("decoded.npy")
        viewer = Viewer(self, "clip.stipple")
        for slot in (0, 47, 48, 70, 95, 112, 129):
            fields, codes = viewer.picture(0, slot, than=0)
            self.assertEqual((fields["Stipple-Method"], fields["Stipple-Level"]), ("live", "1"))
            expected = np.where(decoded[slot].ravel() < 2.0 ** -14.01, 0, decoded[slot].ravel())
            np.testing.assert_allclose(light_of(codes), expected, rtol=0.0028, atol=2.0 ** -14)

    def test_a_stream_that_changes_its_schedule(self):
        self.make_clip("--luminance", "--schedule", "tiled", "--switch", "24:schedule=random,sensor.full_scale_e=8000")
        viewer = Viewer(self, "clip.stipple", "--method", "fast")
        for method, least in (("live", 0), ("fast", 2)):
            self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", method, "--force")
            decoded = self.array("decoded.npy")
            for slot in (10, 23, 24, 40, SLOTS - 1):
                fields, codes = viewer.picture(0, slot, than=0)
                while method == "fast" and fields["Stipple-Level"] != "3":
                    fields, codes = viewer.picture(0, slot, than=int(fields["Stipple-Level"]))
                if fields["Stipple-Method"] == method:  # else a better one was there
                    expected = np.where(decoded[slot].ravel() < 2.0 ** -14.01, 0, decoded[slot].ravel())
                    np.testing.assert_allclose(light_of(codes), expected, rtol=0.0028, atol=2.0 ** -14)
        self.assertEqual(viewer.json("status")["switched"], [24])
        read = sum(np.count_nonzero(np.frombuffer(viewer.ask(f"plane/r0k-{slot}")[2], "<u2")) for slot in range(SLOTS))
        self.assertEqual(read, self.figures("info", "clip.stipple")["samples"])
        run = viewer.json("run", run=0)
        self.assertEqual([part["slot"] for part in run["stream"]["switches"]], [24])
        # Exposures without a gap, also across the switch
        slots = [(slot, run["samples"]["exposures"][kind]) for slot, kind, _
                 in viewer.json("samples", run=0, row=5, col=7, first=0, end=SLOTS)]
        for (before, _), (slot, exposure) in zip(slots, slots[1:]):
            self.assertEqual(exposure["span_slots"], slot - before)
            self.assertEqual(exposure["readout"], 0 if slot < 24 else 1)

    def test_samples_of_a_pixel_are_those_of_the_stream(self):
        self.make_clip("--luminance", "--schedule", "tiled")
        viewer = Viewer(self, "clip.stipple")
        listed = viewer.json("samples", run=0, row=5, col=7, first=0, end=SLOTS)
        for slot, kind, dn in listed:
            kinds = np.frombuffer(viewer.ask(f"plane/r0k-{slot}")[2], "<u2")
            data = np.frombuffer(viewer.ask(f"plane/r0d-{slot}")[2], "<u2")
            at = 5 * COLS + 7
            self.assertEqual(kinds[at], kind + 1)
            self.assertEqual(data[np.count_nonzero(kinds[:at])], dn[0])
        self.assertEqual(sum(np.count_nonzero(np.frombuffer(viewer.ask(f"plane/r0k-{slot}")[2], "<u2"))
                             for slot in range(SLOTS)),
                         self.figures("info", "clip.stipple")["samples"])

    def test_the_exposure_map_has_each_pixels_exposure_under_way(self):
        self.make_clip("--luminance")
        viewer = Viewer(self, "clip.stipple")
        length = {}  # of the exposure that pixel (5, 7) has in each slot, by what is read of it
        kinds = [np.frombuffer(viewer.ask(f"plane/r0k-{slot}")[2], "<u2")[5 * COLS + 7] for slot in range(SLOTS)]
        read = [slot for slot in range(SLOTS) if kinds[slot]]
        for before, slot in zip(read, read[1:]):
            for open_slot in range(before + 1, slot + 1):
                length[open_slot] = slot - before
        for slot, slots in length.items():
            self.assertEqual(np.frombuffer(viewer.ask(f"plane/r0e-{slot}")[2], "<u2")[5 * COLS + 7], slots)

    def test_the_timeline_counts_what_info_counts(self):
        self.make_clip("--luminance")
        data = bytearray((self.folder / "clip.stipple").read_bytes())
        data[len(data) // 2] ^= 1
        (self.folder / "hurt.stipple").write_bytes(data)
        viewer = Viewer(self, "hurt.stipple")
        told = self.run_program("info", "hurt.stipple", "--json", "info.json")
        self.assertEqual(told.returncode, INPUT)
        known = json.loads((self.folder / "info.json").read_text())
        line = viewer.json("timeline", run=0)
        for _ in range(100):
            if line["complete"]:
                break
            time.sleep(0.1)
            line = viewer.json("timeline", run=0)
        self.assertEqual(sum(line["samples"]), known["samples"])
        self.assertEqual(sum(line["missing"]), 1)
        self.assertTrue(any("CRC" in place["cause"] for place in line["damage"]), line["damage"])

    def test_a_stream_that_grows_is_followed(self):
        self.make_clip("--luminance")
        data = (self.folder / "clip.stipple").read_bytes()
        (self.folder / "live.stipple").write_bytes(data[:len(data) // 2])
        viewer = Viewer(self, "live.stipple")
        status = viewer.json("status")
        self.assertFalse(status["complete"])
        self.assertLess(status["slots"], SLOTS)
        self.assertEqual(viewer.picture(0, status["slots"] - 1)[1].size, ROWS * COLS)
        (self.folder / "live.stipple").write_bytes(data)
        self.assertEqual(viewer.json("status"), {"slots": SLOTS, "first": 0, "complete": True, "switched": [0]})
        self.assertEqual(viewer.picture(0, SLOTS - 1)[1].size, ROWS * COLS)

    def test_footage_and_truth_are_shown_as_they_are(self):
        self.make_clip()
        viewer = Viewer(self, "clip.stipple", "--truth", "scene.npy")
        light = self.array("scene.npy")
        for slot in (40, 3, 59, 59):
            _, codes = viewer.picture(1, slot)
            np.testing.assert_allclose(light_of(codes), light[slot].transpose(2, 0, 1).ravel(), rtol=0.0028, atol=2.0 ** -14)

    def test_others_are_refused(self):
        self.make_clip("--luminance")
        viewer = Viewer(self, "clip.stipple")
        wrong = viewer.path[:-2] + ("0" if viewer.path[-2] != "0" else "1") + "/"
        for target, fields in (("/", {}), (wrong, {}), (viewer.path[:-1], {}), (viewer.path, {"Host": "example.com"}),
                               (viewer.path, {"Host": f"example.com:{viewer.port}"}),
                               (viewer.path, {"Origin": "http://" + "elsewhere.example"}),
                               (viewer.path, {"Origin": "null"})):
            self.assertEqual(viewer.ask_for(target, fields)[0], 403, (target, fields))
        self.assertEqual(viewer.ask(fields={"Origin": viewer.url.removesuffix(viewer.path)})[0], 200)
        self.assertEqual(viewer.ask_for("/" + "x" * 100_000)[0], 414)
        self.assertEqual(viewer.ask("status", method="POST", body=b"x" * 1_000_000)[0], 413)
        for name in ("plane/v9-1", "plane/v0-999", "plane/v0", "plane/r0z-1", "plane/../x", "samples", "readout",
                     "status2", "plane/v0--1", "plane/v99999999999999999999-1"):
            self.assertEqual(viewer.ask(name)[0], 404, name)
        self.assertEqual(viewer.json("status")["slots"], SLOTS)

    def test_names_are_texts_in_the_page(self):
        self.make_clip("--luminance")
        name = "</script><img src=x onerror=alert(1)>.stipple".replace("/", "_")
        (self.folder / "clip.stipple").rename(self.folder / name)
        page = Viewer(self, name).ask()[2].decode()
        self.assertNotIn("<img src=x", page)

    def test_what_cannot_be_shown_is_told(self):
        self.make_clip("--luminance")
        self.succeed("synth", "pan", "-o", "wide.npy", "--frames", 2, "--size", f"{2 * COLS}x{ROWS}")
        self.fails(INPUT, ["absent.stipple"], "view", "absent.stipple")
        self.fails(INPUT, ["wide.npy", "96 x 32"], "view", "clip.stipple", "wide.npy")
        self.fails(DEVICE, ["gige:127.9.9.9", "no camera answers"], "view", "gige:127.9.9.9")
        self.fails(USAGE, ["--port"], "view", "clip.stipple", "--port", "0")
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([PROGRAM, "view", "clip.stipple"], cwd=self.folder, stdout=full, stderr=-1, timeout=60)
        self.assertEqual(done.returncode, DEVICE, done.stderr)  # nobody sees its address
        first = Viewer(self, "clip.stipple")
        self.fails(DEVICE, [f"127.0.0.1:{first.port}", "--port"], "view", "clip.stipple", "--port", first.port)

    def test_a_rig_is_shown_by_its_streams(self):
        self.make_clip()
        (self.folder / "rig.toml").write_text('sensors = ["left", "right"]\naperture = "own"\nright = { phase_slots = 3 }\n')
        self.succeed("emulate", "scene.npy", "-o", "rig", "--rig", "rig.toml", "--luminance")
        viewer = Viewer(self, "rig")
        self.assertEqual([viewer.json("run", run=run)["name"] for run in (0, 1)], ["left", "right"])
        self.assertEqual(viewer.picture(1, 10)[1].size, ROWS * COLS)

    def test_results_of_explore_are_shown_by_their_page(self):
        self.make_clip("--luminance")
        (self.folder / "space.toml").write_text("[axes]\nsensor = 'paper'\nschedule = ['tiled', 'full4x']\nmethod = 'naive'\n")
        self.succeed("explore", "space.toml", "-o", "results")
        viewer = Viewer(self, "results")
        self.assertEqual(viewer.ask()[2], (self.folder / "results/report.html").read_bytes())
        self.assertEqual(viewer.ask("status")[0], 404)
        self.fails(INPUT, ["results", "a page of their own"], "view", "clip.stipple", "results")
        (self.folder / "results/report.html").unlink()
        self.fails(INPUT, ["results", "--no-report"], "view", "results")

    def test_a_mosaic_shows_the_colours_of_its_cells(self):
        mosaic = np.random.default_rng(2).integers(0, 256, (3, ROWS, COLS), dtype=np.uint8)
        (self.folder / "mosaic.raw").write_bytes(mosaic.tobytes())
        viewer = Viewer(self, "mosaic.raw", "--raw", f"{COLS}x{ROWS}:bayerrg8", "--transfer", "linear")
        light = mosaic[1] / 255
        colours = np.stack([light[::2, ::2], (light[::2, 1::2] + light[1::2, ::2]) / 2, light[1::2, 1::2]])
        expected = np.repeat(np.repeat(colours, 2, 1), 2, 2).ravel()
        np.testing.assert_allclose(light_of(viewer.picture(0, 1)[1]), expected, rtol=0.003, atol=2.0 ** -14)

    def test_a_signal_ends_it(self):
        self.make_clip("--luminance")
        viewer = Viewer(self, "clip.stipple")
        with ThreadPoolExecutor() as pool:
            last = pool.submit(viewer.ask, "plane/v0-3", viewer="t", than=3, wait=20000)  # nothing is better
            time.sleep(0.5)
            viewer.program.terminate()
            self.assertEqual(viewer.program.wait(timeout=15), 143)
            self.assertEqual(last.result()[2], b"")


if __name__ == "__main__":
    unittest.main()
