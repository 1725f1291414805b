"""`stipple report`: what the page holds, its bound, and inputs that cannot be used."""

import json
import re
import unittest

import numpy as np

from program import INPUT, OK, USAGE, ProgramTest

HOSTILE = "<img src=x onerror=alert(1)>&'\"<"  # the most that a file name can hold: no slash


def data_of(page):
    """The data in a page, as a browser reads them."""
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])


class ReportTest(ProgramTest):
    def page(self, name="report.html"):
        return (self.folder / name).read_text()

    def write_scene(self, frames=20, size="32x24"):
        self.succeed("synth", "pan", "-o", "scene.npy", "--frames", frames, "--size", size)
        self.succeed("emulate", "scene.npy", "-o", "clip.stipple")

    def test_quality_is_that_of_compare(self):
        self.write_scene()
        report = self.figures("report", "clip.stipple", "--truth", "scene.npy")
        self.assertEqual(report["quality_options"],
                         {"margin": 4, "max_value": 2, "peak": 1, "cd_per_unit": 100})
        self.assertEqual([video["name"] for video in report["videos"]],
                         ["truth", "clip, naive", "clip, fast"])
        for video, method in zip(report["videos"][1:], ("naive", "fast"), strict=True):
            self.succeed("decode", "clip.stipple", "-o", f"{method}.npy", "--method", method)
            expected = self.figures("compare", f"{method}.npy", "scene.npy", "--margin", 4, "--max-value", 2)
            for key in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db", "ssim"):
                self.assertEqual(video["quality"][key], expected[key], key)
        self.assertEqual(report["bytes"], (self.folder / "report.html").stat().st_size)
        self.assertEqual(data_of(self.page())["command"],
                         "stipple report clip.stipple --truth scene.npy --json -")

    def test_the_same_run_gives_the_same_page(self):
        self.write_scene()
        pages = []
        for threads in (1, 2):
            self.succeed("report", "clip.stipple", "--threads", threads, "--force")
            pages.append(self.page().replace(f"--threads {threads}", ""))
        self.assertEqual(*pages)

    def test_names_of_files_are_texts(self):
        self.write_scene(8, "16x16")
        name = f"{HOSTILE}.stipple"
        (self.folder / "clip.stipple").rename(self.folder / name)
        self.succeed("report", name, "--title", "</script><script>alert(1)</script>", "-o", "page.html")
        page = self.page("page.html")
        self.assertNotIn("<img", page)
        self.assertNotIn("<script>alert", page)
        data = data_of(page)
        self.assertEqual(data["runs"][0]["name"], HOSTILE)
        self.assertEqual(data["title"], "</script><script>alert(1)</script>")

    def test_a_folder_stands_for_its_streams_conventional_cameras_last(self):
        self.write_scene(12, "16x16")
        (self.folder / "runs").mkdir()
        for schedule in ("full4x", "random", "tiled"):
            self.succeed("emulate", "scene.npy", "-o", f"runs/{schedule}.stipple", "--schedule", schedule)
        report = self.figures("report", "runs", "--method", "naive", "--max-value", 3)
        self.assertEqual([video["name"] for video in report["videos"]],
                         ["random, naive", "tiled, naive", "full4x, naive"])
        self.assertEqual(report["quality_options"]["max_value"], 3)
        self.assertIsNone(report["videos"][0]["quality"])  # no truth

    def test_pictures_are_left_out_where_the_page_would_be_too_large(self):
        self.write_array("noise.npy", np.random.default_rng(1).random((40, 192, 192)))
        self.succeed("emulate", "noise.npy", "-o", "noise.stipple")
        done = self.run_program("report", "noise.stipple", "--max-size", "3M", "--json", "figures.json")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertIn("slot only", done.stderr)
        figures = json.loads((self.folder / "figures.json").read_text())
        self.assertGreater(figures["picture_step"], 1)
        self.assertLess(figures["bytes"], 3 * 2**20)
        self.assertIn(figures["notes"][0], data_of(self.page())["notes"])
        self.fails(INPUT, ["--max-size", "--crop"], "report", "noise.stipple", "-o", "b.html", "--max-size", "1M")

    def test_a_damaged_stream_is_shown_as_far_as_it_is_whole(self):
        self.write_scene()
        self.change_byte("clip.stipple", (self.folder / "clip.stipple").stat().st_size // 2)
        done = self.run_program("report", "clip.stipple")
        self.assertEqual(done.returncode, INPUT, done.stderr)
        self.assertIn("damaged", done.stderr)
        self.assertIn("damaged", data_of(self.page())["notes"][0])

    def test_figures_of_a_camera_become_a_part_of_the_page(self):
        self.write_scene(8, "16x16")
        self.succeed("characterize", "--sensor", "grasshopper", "-o", "series", "--json", "camera.json")
        self.succeed("report", "clip.stipple", "--characterization", "camera.json")
        figures = json.loads((self.folder / "camera.json").read_text())
        for camera in (data_of(self.page())["camera"], data_of(self.page("series/report.html"))["camera"]):
            for key in ("measured", "configured", "photon_transfer", "saturation_point"):
                self.assertEqual(camera[key], figures[key])
        for text in ("", "{", "[]", "{}", '{"measured": {"a": "b"}, "photon_transfer": [], "saturation_point": 0}',
                     '{"measured": {}, "photon_transfer": [[1, 2, 3]], "saturation_point": 1}',
                     '{"measured": {}, "photon_transfer": [[1, 2, "3"]], "saturation_point": 0}'):
            (self.folder / "other.json").write_text(text)
            self.fails(INPUT, ["other.json", "stipple characterize"], "report", "clip.stipple", "-o", "b.html",
                       "--characterization", "other.json")

    def test_a_truth_that_ends_early_is_told(self):
        self.write_scene(12, "16x16")
        self.write_array("short.npy", self.array("scene.npy")[:5])
        report = self.figures("report", "clip.stipple", "--truth", "short.npy", "--method", "naive")
        self.assertEqual(report["notes"], ["The truth has 5 of 12 slots; quality is of these."])
        self.assertEqual(data_of(self.page())["notes"], report["notes"])
        self.assertEqual(len(report["videos"][1]["quality"]["frames"]["ssim"]), 5)

    def test_a_large_until_takes_no_memory_for_slots_that_are_not_there(self):
        self.write_scene(8, "64x64")
        self.succeed("report", "clip.stipple", "--truth", "scene.npy", "--until", 100000, "--method", "naive")

    def test_streams_of_the_same_name_keep_their_folders(self):
        self.write_scene(8, "16x16")
        (self.folder / "other").mkdir()
        self.succeed("emulate", "scene.npy", "-o", "other/clip.stipple", "--schedule", "tiled")
        report = self.figures("report", "clip.stipple", "other/clip.stipple", "--method", "naive")
        self.assertEqual([video["name"] for video in report["videos"]], ["clip, naive", "other/clip, naive"])

    def test_runs_that_cannot_be_compared_are_told(self):
        self.write_scene(8, "16x16")
        self.write_array("dim.npy", 0.5 * self.array("scene.npy"))
        for name, more in {"alike": ["scene.npy", "--schedule", "tiled", "--seed", 5], "dim": ["dim.npy"],
                           "scaled": ["scene.npy", "--scale", 0.5],
                           "slow": ["scene.npy", "--set", "sensor.slot_us=7000"]}.items():
            self.succeed("emulate", *more, "-o", f"{name}.stipple")
        notes = self.figures("report", "clip.stipple", "alike.stipple", "dim.stipple", "scaled.stipple",
                             "slow.stipple", "--truth", "scene.npy", "--method", "naive")["notes"]
        self.assertEqual([note.partition(":")[0] for note in notes], ["dim", "scaled", "slow"])
        for note in notes[:2]:
            self.assertIn("other footage than clip", note)
        self.assertIn("slots last 7000 us, those of clip 5000 us", notes[2])
        self.assertEqual(data_of(self.page())["notes"], notes)

    def test_the_demo_leaves_a_page(self):
        self.succeed("demo", "--frames", 8, "--size", "16x16", "-o", "shown")
        data = data_of(self.page("shown/report.html"))
        self.assertEqual([video["name"] for video in data["videos"]],
                         ["truth", "4x exposure", "1x exposure", "1x, decoded", "coded, naive", "coded, decoded"])
        self.assertEqual([run["name"] for run in data["runs"]], ["full4x", "full1x", "random"])
        self.assertEqual(data["notes"], [])
        self.assertEqual([video["run"] for video in data["videos"]], [None, 0, 1, 1, 2, 2])

    def test_what_cannot_be_used_is_named(self):
        self.write_scene(8, "16x16")
        self.write_stream("other.stipple")
        for arguments, code, parts in (
                (["clip.stipple", "--crop", "8"], USAGE, ["--crop", "WxH"]),
                (["clip.stipple", "--crop", "8x8+9+9"], INPUT, ["--crop", "16 x 16"]),
                (["clip.stipple", "--max-size", "many"], USAGE, ["--max-size"]),
                (["clip.stipple", "--luminance"], USAGE, ["--luminance", "--truth"]),
                (["clip.stipple", "-o", "a.pdf"], USAGE, [".html"]),
                (["clip.stipple", "--truth", "light.npy"], INPUT, ["light.npy", "16 x 16 x 3"]),
                (["clip.stipple", "other.stipple"], INPUT, ["other.stipple", "8 x 8 x 1"]),
                (["absent.stipple"], INPUT, ["absent.stipple"]),
                (["scene.npy"], INPUT, ["scene.npy"]),
                ([], USAGE, ["RUN"])):
            self.fails(code, parts, "report", *arguments)
        (self.folder / "empty").mkdir()
        self.fails(INPUT, ["empty", "no sample stream"], "report", "empty")


if __name__ == "__main__":
    unittest.main()
