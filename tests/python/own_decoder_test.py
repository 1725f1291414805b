"""Decoders of one's own beside the methods of Stipple: in explorations, among rivals, in reports."""

import csv
import json
import time
import unittest
import warnings

import numpy as np

import stipple
from program import ProgramTest

SPACE = """
[axes]
footage = "light.npy"
sensor = "paper"
schedule = ["random", "full1x"]
[set]
"decoder.gain" = [1.0, 0.5]
[clip]
frames = 24
rows = 16
cols = 16
"""

SYSTEMS = """
[axes]
sensor = "paper"
[[systems]]
name = "coded best"
schedule = "random"
method = "best"
[[systems]]
name = "frames naive"
schedule = "full1x"
method = "naive"
[clip]
frames = 24
rows = 24
cols = 32
"""

QUALITY = ("psnr_db", "psnr_gamma_db", "pu21_psnr_db")


def own(stream, gain=1.0):
    return gain * stipple.decode(stream, "naive")


class OwnDecoderTest(ProgramTest):
    def setUp(self):
        super().setUp()
        light = np.random.default_rng(3).random((24, 16, 16))
        text = SPACE.replace("light.npy", str(self.folder / self.write_array("light.npy", light)))
        (self.folder / "space.toml").write_text(text)
        (self.folder / "plain.toml").write_text(text.replace('"decoder.gain" = [1.0, 0.5]', ""))
        (self.folder / "systems.toml").write_text(SYSTEMS)

    def explore(self, *methods, space="plain.toml", **more):
        return stipple.explore(self.folder / space, self.folder / "results", methods=methods, **more)

    def trials(self):
        return list((self.folder / "results/trials").glob("*"))

    def test_the_figures_are_those_of_the_method_that_is_called(self):
        def by_best(stream):
            return stipple.decode(stream, "best")

        rows = self.explore("best", by_best)
        self.assertEqual([row["method"] for row in rows], ["best", "by_best"] * 2)
        for ours, theirs in zip(rows[::2], rows[1::2]):
            self.assertEqual((ours["problem"], theirs["problem"]), ("", ""))
            for name in set(ours) - {"method", "decode_seconds", "decode_megabytes"}:
                self.assertEqual(ours[name], theirs[name], name)
            self.assertGreater(theirs["decode_seconds"], 0)
            self.assertEqual(ours["decode_megabytes"] is None, theirs["decode_megabytes"] is None)
        with open(self.folder / "results/table.csv", newline="") as table:
            self.assertEqual([row["psnr_db"] for row in csv.DictReader(table)], [f"{row['psnr_db']:.12g}" for row in rows])
        self.assertIn("with the decoder \\\"by_best\\\"", (self.folder / "results/report.html").read_text())

    def test_memory_is_measured_alike(self):
        def greedy(stream):
            more = np.ones(64 << 17)  # 64 MiB
            return own(stream) * more[0]

        plain, more = (self.explore(decoder)[0]["decode_megabytes"] for decoder in (own, greedy))
        if plain is None:
            self.skipTest("the system does not tell")
        self.assertGreater(more, 60)
        self.assertLess(plain, 60)

    def test_a_decoder_among_rivals_stands_in_the_table_of_the_program(self):
        def mine(stream):
            return stipple.decode(stream, "best")

        rows = stipple.rivals("pan", self.folder / "results", space=self.folder / "systems.toml", methods=[mine], seeds=2)
        self.assertEqual([row["system"] for row in rows], ["coded best", "frames naive", "coded mine"])
        program = self.figures("rivals", "pan", "-o", "program", "--space", "systems.toml", "--seeds", 2)["systems"]
        for row, line in zip(rows, program):
            for name in (*QUALITY, "psnr_db_low", "psnr_db_high", "light_throughput", "samples_per_voxel"):
                self.assertEqual(row[name], line[name])
        for name in (*QUALITY, "psnr_db_low", "psnr_db_high", "rank"):
            self.assertEqual(rows[0][name], rows[2][name])
        self.assertEqual((rows[0]["rank"], rows[2]["rank"]), ("1=", "1="))
        self.assertIn("<title>Rivals: pan</title>", (self.folder / "results/report.html").read_text())
        only = stipple.rivals("pan", self.folder / "results", space=self.folder / "systems.toml", methods=[mine], seeds=2,
                              systems=["coded mine"])
        self.assertEqual([row["system"] for row in only], ["coded mine"])

    def test_options_of_a_space_are_arguments(self):
        seen = []

        def taking(stream, gain):
            seen.append(gain)
            return own(stream, gain)

        rows = self.explore(taking, space="space.toml")
        self.assertEqual(seen, [1.0, 0.5] * 2)
        self.assertGreater(rows[0]["psnr_db"], rows[1]["psnr_db"])

    def test_results_are_known_by_name_and_version(self):
        calls = []

        def counting(stream):
            calls.append(stream.slots())
            return own(stream)

        for version, more in (("", 2), ("", 2), ("1", 2), ("1", 0), ("2", 2)):
            before = len(calls)
            rows = self.explore(stipple.Decoder(counting, "own", version))
            self.assertEqual((len(calls) - before, rows[0]["method"]), (more, "own"), version)
        self.assertEqual(set(calls), {24})

    def test_a_result_that_is_no_video_names_decoder_and_trial(self):
        nan = np.zeros((24, 16, 16))
        nan[3, 4, 5] = np.nan
        masked = np.ma.masked_equal(np.zeros((24, 16, 16)), 0)
        for result, message in ((np.zeros((23, 16, 16)), "gave 23 frames of 16 x 16 pixels and 1 plane, not 24 "),
                                (np.zeros((24, 16, 16, 3)), "and 3 planes, not 24 frames"),
                                (np.zeros((24, 16)), r"gave an array of shape \(24, 16\)"),
                                (np.zeros((24, 16, 16), int), "dtype int64, not an array"),
                                (masked, "without masks"), (None, "not an array"), ("text", "not an array"),
                                (nan, "its frame 3 has light nan at row 4, col 5")):
            with self.subTest(message):
                with self.assertRaisesRegex(ValueError, rf'^decoder "broken": .*{message}.*; in trial 1 \(random\)$'):
                    self.explore(stipple.Decoder(lambda stream: result, "broken"))
                self.assertEqual(self.trials(), [])

    def test_what_a_decoder_raises_is_the_cause_and_what_was_done_stays(self):
        def broken(stream):
            if stream.header["schedule"]["name"] == "full1x":
                raise KeyError("weights")
            return own(stream)

        with self.assertRaisesRegex(RuntimeError, '^decoder "broken" in trial 2 .full1x.: raised KeyError: ') as caught:
            self.explore(broken)
        self.assertIsInstance(caught.exception.__cause__, KeyError)
        self.assertEqual(len(self.trials()), 2)  # figures and picture of the first
        with open(self.folder / "results/table.csv", newline="") as table:
            self.assertEqual([row["schedule"] for row in csv.DictReader(table)], ["random"])

    def test_a_key_of_the_keyboard_ends_the_run(self):
        def stopped(stream):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            self.explore(stopped)
        self.assertEqual(self.trials(), [])

    def test_what_a_decoder_cannot_do_is_the_problem_of_the_point(self):
        def modest(stream):
            if stream.header["schedule"]["name"] == "full1x":
                raise NotImplementedError("needs codes")
            return own(stream)

        rows = self.explore(modest)
        self.assertEqual([row["problem"] for row in rows], ["", 'decoder "modest": needs codes'])

    def test_a_stream_is_closed_after_the_call(self):
        kept = []

        def keeping(stream):
            kept.append(stream)
            return own(stream)

        self.explore(keeping)
        with self.assertRaisesRegex(ValueError, "is closed"):
            kept[0].samples(0)

    def test_methods_that_are_none(self):
        for methods, error, message in (([stipple.Decoder(own, "best")], ValueError, "has the name of a method"),
                                        ([own, own], ValueError, '"own": has the name of another one'),
                                        ([stipple.Decoder(own, "")], None, ""),
                                        ([3], TypeError, "methods: 3 is neither"),
                                        ("best", TypeError, "methods: 'best' is a text; give a list")):
            with self.subTest(message):
                if error is None:
                    self.assertEqual(methods[0].name, "own")
                    continue
                with self.assertRaisesRegex(error, message):
                    stipple.explore(self.folder / "plain.toml", self.folder / "results", methods=methods)
                self.assertFalse((self.folder / "results").exists())
        rows = self.explore("nosuch")
        self.assertIn("nosuch", rows[0]["problem"])

    def test_reports_show_it(self):
        stream = stipple.emulate(self.folder / "light.npy", output=self.folder / "clip.stipple")
        figures = stipple.report(stream, self.folder / "own.html", truth=self.folder / "light.npy",
                                 methods=["fast", own, stipple.Decoder(own, "again")])
        naive, fast, mine, again = figures["videos"][1:]
        self.assertEqual([video["name"] for video in (fast, mine, again)], ["clip, fast", "clip, own", "clip, again"])
        self.assertEqual(mine["quality"], naive["quality"])
        self.assertNotEqual(fast["quality"], naive["quality"])
        with self.assertRaisesRegex(RuntimeError, 'decoder "<lambda>" in clip.stipple, <lambda>: raised ZeroDivision'):
            stipple.report(stream, self.folder / "other.html", methods=[lambda stream: 1 / 0])
        with self.assertRaisesRegex(ValueError, 'decoder "<lambda>": gave .*; in clip.stipple, <lambda>$'):
            stipple.report(stream, self.folder / "other.html", methods=[lambda stream: np.zeros((3, 16, 16))])
        self.assertFalse((self.folder / "other.html").exists())


class ReportTest(ProgramTest):
    def test_the_page_is_that_of_the_program(self):
        self.succeed("synth", "pan", "-o", "scene.npy", "--frames", 20, "--size", "32x24")
        for schedule in ("random", "full4x"):
            self.succeed("emulate", "scene.npy", "-o", f"{schedule}.stipple", "--schedule", schedule)
        told = self.figures("report", "random.stipple", "full4x.stipple", "-o", "program.html", "--truth", "scene.npy",
                            "--method", "best", "--until", 12, "--crop", "16x16", "--title", "Both")
        names = [self.folder / f"{schedule}.stipple" for schedule in ("random", "full4x")]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            figures = stipple.report(names, self.folder / "python.html", truth=self.folder / "scene.npy",
                                     methods=["best"], until=12, crop="16x16", title="Both")
        self.assertEqual([str(warning.message) for warning in caught], told.pop("warnings"))
        size = (self.folder / "python.html").stat().st_size
        self.assertEqual(figures, {**told, "file": str(self.folder / "python.html"), "bytes": size})
        command = json.dumps("stipple report random.stipple full4x.stipple -o program.html --truth scene.npy --method best"
                             " --until 12 --crop 16x16 --title Both --json -")
        page = (self.folder / "program.html").read_text()
        self.assertEqual(page.count(f'"command":{command}'), 1)
        self.assertEqual((self.folder / "python.html").read_text(), page.replace(command, '""'))

    def test_the_truth_can_be_an_array(self):
        video = np.full((12, 16, 16), 0.25, np.float32)
        stipple.emulate(video, output=self.folder / "clip.stipple")
        figures = stipple.report(self.folder, self.folder / "a.html", truth=video, methods=["naive"])
        self.assertEqual([video["name"] for video in figures["videos"]], ["truth", "clip, naive"])
        with self.assertRaisesRegex(ValueError, "video: has frames of 8 x 8 x 1"):
            stipple.report(self.folder, self.folder / "b.html", truth=video[:, :8, :8])

    def test_bad_input(self):
        stream = stipple.emulate(np.full((12, 16, 16), 0.25, np.float32))
        with self.assertRaisesRegex(ValueError, "temporary file"):
            stipple.report(stream, self.folder / "a.html")
        stream.save(self.folder / "clip.stipple")
        clip = self.folder / "clip.stipple"
        for more, message in (({"until": 0}, "until: 0 is not"), ({"crop": "big"}, 'crop: "big" is not'),
                              ({"max_size": "3"}, 'max_size: "3" is not'), ({"max_value": -1.0}, "max_value: -1"),
                              ({"methods": ["nosuch"]}, "nosuch")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.report(clip, self.folder / "a.html", **more)
        with self.assertRaisesRegex(ValueError, "a report is a .html"):
            stipple.report(clip, self.folder / "a.txt")

        class Enough(Exception):
            pass

        def tell(done, slots):
            raise Enough

        def slow(stream):
            time.sleep(0.15)  # progress is told every 0.1 s at most
            return own(stream)

        with self.assertRaises(Enough):
            stipple.report(clip, self.folder / "a.html", methods=[slow], progress=tell)
        self.assertEqual(self.names(), ["clip.stipple"])


if __name__ == "__main__":
    unittest.main()
