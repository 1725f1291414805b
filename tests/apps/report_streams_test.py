"""The page of `stipple report` on streams of all kinds: each part has its numbers, and can be read in light and dark,
on a wide and on a narrow screen."""

import unittest

import numpy as np
from browser import LACKING, BrowserTest, Keys

NO_NUMBERS = ("NaN", "undefined", "Infinity", "null", "[object")
# Texts on the page whose contrast with the nearest opaque background is below that of WCAG 2.1, 1.4.3.
PALE = """
const channel = (v) => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
const parts = (colour) => colour.match(/[\\d.]+/g).map(Number);
const luminance = (c) => 0.2126 * channel(c[0]) + 0.7152 * channel(c[1]) + 0.0722 * channel(c[2]);
const behind = (e) => { for (; e; e = e.parentElement) {
  const c = parts(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] === 1) return c; } return [255, 255, 255]; };
const pale = [];
for (const e of document.body.querySelectorAll('*')) {
  const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  if (!own || e.closest('script, .stage, option') || !e.getClientRects().length) continue;
  const style = getComputedStyle(e);
  const text = parts(e instanceof SVGElement ? style.fill : style.color);
  const [a, b] = [luminance(text), luminance(behind(e))].sort((x, y) => y - x);
  if ((a + 0.05) / (b + 0.05) < 4.5) pale.push(`${e.id || e.className || e.tagName}: ${e.textContent.slice(0, 40)}`);
}
return pale;"""
# Elements that hide a part of their content. Names on pictures end in an ellipsis, and the lists say them in full.
CLIPPED = """
return [...document.body.querySelectorAll('*')].filter((e) => e.getClientRects().length && !e.closest('.tag, .stage'))
  .filter((e) => { const style = getComputedStyle(e);
    return style.overflowX === 'hidden' && e.scrollWidth > e.clientWidth + 1
        || e.getBoundingClientRect().right > window.innerWidth + 1 && !e.closest('.scroll'); })
  .map((e) => `${e.id || e.className.baseVal || e.className || e.tagName}: ${e.textContent.slice(0, 40)}`);"""


@unittest.skipIf(LACKING, LACKING)
class ReportStreamsTest(BrowserTest):
    def write_scene(self, slots=24, size="64x48", light=1):
        self.succeed("synth", "pan", "-o", "rendered.npy", "--frames", slots, "--size", size, "--force")
        self.write_array("scene.npy", self.array("rendered.npy") * light)

    def emulate(self, *options, name="clip", footage="scene.npy"):
        self.succeed("emulate", footage, "-o", f"{name}.stipple", *options)

    def open_report(self, *arguments):
        self.succeed("report", *arguments)
        self.open_file("report.html")
        self.wait(lambda: "sample" in self.element("pixel-name").text)
        self.wait(lambda: self.script("return document.querySelectorAll('#schedule-lanes .box').length") > 0)

    def expect_readable(self):
        text = self.script("return document.body.innerText")
        for word in NO_NUMBERS:
            self.assertNotIn(word, text)
        for width in (1400, 390):
            self.use_width(width)
            self.wait(lambda: self.script("return document.documentElement.scrollWidth") <= width)
            self.assertEqual(self.script(CLIPPED), [])
        for scheme in ("light", "dark"):
            self.use_colours(scheme)
            self.assertEqual(self.script(PALE), [])
        return text

    def chosen_rows(self):
        """Upper edges of the boxes of the chosen pixel's lane."""
        self.wait(lambda: self.script("return document.querySelectorAll('.chosen .box').length") > 0)
        return set(self.script("return [...document.querySelectorAll('.chosen .box')].map((b) => b.getAttribute('y'))"))

    def test_two_buckets_are_two_rows_of_a_lane(self):
        self.write_scene()
        self.emulate("--schedule", "two_bucket", "--set", "sensor.charge_stores=2")
        self.open_report("clip.stipple", "--truth", "scene.npy", "--method", "naive")
        self.assertEqual(len(self.chosen_rows()), 2)
        self.assertIn("a charge store", self.expect_readable())

    def test_a_pixel_of_a_mosaic_names_its_filter(self):
        self.write_scene()
        self.emulate("--set", "sensor.mode=physical", "--set", "sensor.cfa=rggb")
        self.open_report("clip.stipple", "--truth", "scene.npy", "--method", "naive")
        for row, col, colour in ((20, 20, "red"), (20, 21, "green"), (21, 20, "green"), (21, 21, "blue")):
            self.script("choosePixel(arguments[0], arguments[1])", row, col)
            self.wait(lambda: f"row {row}, column {col}, {colour} filter" in self.element("pixel-name").text)
            self.assertNotIn(": 0 samples", self.element("pixel-name").text)
        self.expect_readable()

    def test_conventional_schedules_in_one_page(self):
        self.write_scene()
        runs = ("full1x", "full4x", "rolling", "random")
        for schedule in runs:
            self.emulate("--schedule", schedule, name=schedule)
        self.open_report(*(f"{run}.stipple" for run in runs), "--truth", "scene.npy")
        self.assertEqual(self.script("return new Set(data.videos.map((_, i) => videoColour(i) + videoDash(i))).size"), 9)
        self.expect_readable()

    def test_dark_and_bright_light_are_seen_at_once(self):
        for light, low, high in ((0.02, 1, 8), (1, 0, 0), (8, -8, -1)):
            self.write_scene(light=light)
            self.emulate("--force")
            self.open_report("clip.stipple", "--truth", "scene.npy", "--method", "naive", "--force")
            self.wait(lambda: low <= self.script("return state.stops") <= high)
            self.expect_readable()

    def test_saturated_samples_and_dropped_rows(self):
        self.write_scene(light=4)
        self.emulate("--sensor", "lux1310", "--set", "sensor.slot_us=10", "--overrun", "drop")
        self.open_report("clip.stipple", "--method", "naive")
        self.assertIn("dropped in", self.expect_readable())

    def test_one_slot(self):
        self.write_scene(slots=1)
        self.emulate("--schedule", "full1x")
        self.open_report("clip.stipple", "--truth", "scene.npy", "--method", "naive")
        self.assertNotIn("without the first", self.expect_readable())
        self.browser.switch_to.active_element.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(self.script("return state.slot"), 0)

    def test_a_wide_frame_is_shown_in_part(self):
        self.write_array("scene.npy", np.random.default_rng(1).random((4, 64, 2048)))
        self.emulate()
        self.open_report("clip.stipple", "--truth", "scene.npy", "--method", "naive")
        self.assertIn("The pictures show 640 x 64 of 2048 x 64 pixels", self.expect_readable())


if __name__ == "__main__":
    unittest.main()
