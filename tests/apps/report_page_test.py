"""The page of `stipple report` in a browser: what is shown follows the slot, the exposure, the divider
and the pixel; keys, dark mode, a narrow screen; no error, no network."""

import unittest

import numpy as np
from browser import LACKING, By, BrowserTest, Keys, Select, webdriver

COLS, ROWS, SLOTS = 64, 48, 24


@unittest.skipIf(LACKING, LACKING)
class ReportPageTest(BrowserTest):
    """Each test opens the page again."""

    def setUp(self):
        super().setUp()
        self.succeed("synth", "pan", "-o", "scene.npy", "--frames", SLOTS, "--size", f"{COLS}x{ROWS}")
        for schedule in ("random", "full4x"):
            self.succeed("emulate", "scene.npy", "-o", f"{schedule}.stipple", "--schedule", schedule)

    def open_page(self, *arguments):
        self.succeed("report", *(arguments or ("random.stipple", "full4x.stipple", "--truth", "scene.npy",
                                               "--method", "naive")))
        self.open_file("report.html")

    def picture(self, side, slot):
        """Pixels of a picture as (row, col, colour), once it shows the slot."""
        canvas = f"document.getElementById('picture-{side}')"
        self.wait(lambda: self.script(f"return {canvas}.dataset.slot") == str(slot))
        values = self.script(f"return [...{canvas}.getContext('2d').getImageData(0, 0, {COLS}, {ROWS}).data]")
        return np.array(values).reshape(ROWS, COLS, 4)[..., :3]

    def press(self, *keys):
        webdriver.ActionChains(self.browser).send_keys(*keys).perform()

    def test_the_truth_is_shown_as_the_tone_curve_says(self):
        self.open_page()
        light = self.array("scene.npy")
        slot = SLOTS // 2
        for stops in (0, -2):
            self.script("chooseStops(arguments[0])", stops)
            x = np.minimum(light[slot] * 2.0**stops, 4)
            expected = 255 * (x * (1 + x / 16) / (1 + x)) ** (1 / 2.2)
            # Half a step of rounding, and 0.27 % of light: at most 0.35.
            self.wait(lambda: np.abs(self.picture("b", slot) - expected).max() < 0.9)

    def test_the_slot_follows_scrubber_and_keys(self):
        self.open_page()
        middle = SLOTS // 2
        before = self.picture("a", middle)
        self.press(Keys.ARROW_RIGHT)
        self.assertGreater(np.abs(self.picture("a", middle + 1) - before).max(), 0)
        self.press(Keys.HOME)
        self.picture("a", 0)
        self.press(Keys.END, Keys.ARROW_RIGHT)
        self.picture("a", SLOTS - 1)
        self.script("const s = document.getElementById('slot'); s.value = 5; s.dispatchEvent(new Event('input'))")
        self.picture("b", 5)
        self.assertTrue(self.element("slot-text").text.startswith("5 of"), self.element("slot-text").text)

    def test_each_view_is_a_picture_of_its_own(self):
        self.open_page()
        slot = SLOTS // 2
        shown = []
        select = Select(self.element("view-a"))
        names = [option.text for option in select.options]
        self.assertEqual(names, ["truth", "random, naive", "full4x, naive", "samples, random", "samples, full4x",
                                 "error, random, naive", "error, full4x, naive"])
        for name in names:
            self.script("delete document.getElementById('picture-a').dataset.slot")
            select.select_by_visible_text(name)
            shown.append(self.picture("a", slot).tobytes())
            self.assertEqual(self.element("name-a").text, name)
        self.assertEqual(len(set(shown)), len(names))

    def test_a_slot_after_the_end_of_the_truth_has_no_picture_of_it(self):
        np.save(self.folder / "begin.npy", self.array("scene.npy")[:SLOTS // 2])
        self.open_page("random.stipple", "--truth", "begin.npy", "--method", "naive")
        last, first = SLOTS // 2 - 1, SLOTS // 2
        self.script("chooseSlot(arguments[0])", last)
        self.assertGreater(self.picture("b", last).max(), 0)
        self.assertEqual(self.element("name-b").text, "truth")
        self.script("chooseSlot(arguments[0])", first)
        self.assertEqual(np.unique(self.picture("b", first)).size, 3)  # of one colour, not the one of the slot before
        self.assertEqual(self.element("name-b").text, "truth: no picture of this slot")
        self.assertGreater(self.picture("a", first).max(), 0)

    def test_the_divider_moves_by_pointer_and_keys(self):
        self.open_page()
        divider = self.element("divider")
        webdriver.ActionChains(self.browser).drag_and_drop_by_offset(divider, 100, 0).perform()
        width = self.element("stage").rect["width"]
        self.assertAlmostEqual(self.script("return state.divider"), 50 + 100 * 100 / width, delta=1)
        before = self.script("return state.divider")
        self.script("arguments[0].focus()", divider)
        self.press(Keys.ARROW_LEFT)
        self.assertAlmostEqual(self.script("return state.divider"), before - 2)
        self.assertEqual(self.script("return state.slot"), SLOTS // 2)  # the divider has taken the key
        self.assertIn("inset", self.script("return document.getElementById('layer-a').style.clipPath"))

    def test_a_click_shows_the_samples_of_the_pixel(self):
        self.open_page()
        stage = self.element("stage")
        box = stage.rect
        row, col = 12, 16
        webdriver.ActionChains(self.browser).move_to_element_with_offset(
            stage, round((col + 0.5 - COLS / 2) * box["width"] / COLS),
            round((row + 0.5 - ROWS / 2) * box["height"] / ROWS)).click().perform()
        self.wait(lambda: f"row {row}, column {col}" in self.element("pixel-name").text)
        self.expect_table(row, col)
        webdriver.ActionChains(self.browser).key_down(Keys.SHIFT).send_keys(Keys.ARROW_DOWN).key_up(Keys.SHIFT).perform()
        self.wait(lambda: f"row {row + 1}, column {col}" in self.element("pixel-name").text)

    def expect_table(self, row, col):
        """The paper's sensor: DN / 255 x 2 is light; shot noise, 10 e read noise, rounding of 1 DN."""
        rows = self.script("return [...document.querySelectorAll('#pixel-table tr')].slice(1)"
                           ".map((r) => [...r.cells].map((c) => c.textContent))")
        self.assertGreater(len(rows), 4)
        truth = self.array("scene.npy")
        for slots, opened, dn, light, deviation, mean in rows:
            first, last = (int(slots.split(" to ")[i]) for i in (0, -1))
            self.assertEqual(last - first + 1, int(opened))
            if "saturated" in dn:
                continue
            total = int(dn) / 255 * 2
            sigma = ((1000 * total + 100) / 1e6 + (2 / 255)**2 / 12) ** 0.5
            self.assertAlmostEqual(float(light), total / int(opened), delta=1e-3 * total + 1e-6)
            self.assertAlmostEqual(float(deviation), sigma / int(opened), delta=0.06 * sigma)
            expected = truth[first:last + 1, row, col, 1].mean()
            self.assertAlmostEqual(float(mean), expected, delta=4e-3 * expected)

    def test_all_charts_are_drawn(self):
        self.open_page()
        self.wait(lambda: "sample" in self.element("pixel-name").text)
        if self.script("return typeof Chart === 'undefined'"):
            self.skipTest("the build has no Chart.js (libjs-chart.js)")
        self.assertEqual(self.script("return [...charts.keys()].sort()"), ["load-chart", "pixel-chart", "quality-chart"])
        for name in ("load-chart", "pixel-chart", "quality-chart"):
            inked = self.script("const c = document.getElementById(arguments[0]); return c.getContext('2d')"
                                ".getImageData(0, 0, c.width, c.height).data.some((v) => v > 0)", name)
            self.assertTrue(inked, name)
        self.assertGreater(len(self.browser.find_elements(By.CSS_SELECTOR, "#schedule-lanes rect")), 50)

    def test_the_logarithmic_axis_begins_near_the_least_light(self):
        self.open_page()
        self.wait(lambda: "sample" in self.element("pixel-name").text)
        if self.script("return typeof Chart === 'undefined'"):
            self.skipTest("the build has no Chart.js (libjs-chart.js)")
        self.element("log-light").click()
        scale = "const {y, x} = Chart.getChart('pixel-chart').scales; return "
        self.wait(lambda: self.script(scale + "y.type") == "logarithmic")
        least = self.script("return Math.min(...shownSamples.map((s) => s.light), ...Chart.getChart('pixel-chart').data"
                            ".datasets.flatMap((line) => line.data.map(({y}) => y)).filter((y) => y > 0))")
        self.assertAlmostEqual(self.script(scale + "y.min"), least / 2, delta=1e-6)
        self.assertEqual(self.script(scale + "x.options.title.text"), "time, slots of 5 ms")

    def test_damage_is_in_the_colour_of_a_warning(self):
        self.write_stream()
        self.change_byte("clip.stipple", (self.folder / "clip.stipple").stat().st_size // 2)
        self.run_program("report", "clip.stipple")
        self.open_file("report.html")
        warning, = self.browser.find_elements(By.CSS_SELECTOR, "#notes .warning")
        self.assertIn("clip: the stream is damaged", warning.text)

    def test_dark_mode_and_a_narrow_screen(self):
        self.open_page()
        for scheme in ("light", "dark"):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                "features": [{"name": "prefers-color-scheme", "value": scheme}]})
            brightness = self.script("return getComputedStyle(document.body).backgroundColor.match(/\\d+/g)"
                                     ".slice(0, 3).reduce((sum, part) => sum + Number(part), 0)")
            self.assertEqual(brightness < 200, scheme == "dark", brightness)
            self.expect_charts_as_wide_as_their_cards()
            for width in (390, 1400):
                self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                    "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": False})
                self.wait(lambda: self.script("return window.innerWidth") == width)
                self.wait(lambda: self.script("return document.documentElement.scrollWidth") <= width)
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def expect_charts_as_wide_as_their_cards(self):
        self.wait(lambda: self.script(
            "return [...document.querySelectorAll('.chart canvas')].filter((c) => c.parentElement.clientWidth > 0)"
            ".every((c) => Math.abs(c.clientWidth - c.parentElement.clientWidth) < 2)"))

    def test_every_control_has_a_name_and_can_be_reached_by_tab(self):
        self.open_page()
        reached = set()
        for _ in range(40):
            self.press(Keys.TAB)
            reached.add(self.script("return document.activeElement.id"))
        self.assertTrue(reached.issuperset({"view-a", "view-b", "stops", "divider", "play", "slot", "plane", "run",
                                            "log-light", "metric", "load-run", "schedule-run"}), reached)
        nameless = self.script(
            "return [...document.querySelectorAll('input, select, button, [role], canvas')].filter((e) => "
            "!(e.labels?.length || e.getAttribute('aria-label') || (e.matches('button') && /\\w\\w/.test(e.textContent)))).map((e) => e.id || e.outerHTML)")
        self.assertEqual(nameless, [])

    def test_without_truth_and_with_one_plane_the_rest_is_shown(self):
        self.write_stream("mono.stipple", rows=16, cols=20)
        self.open_page("mono.stipple")
        self.wait(lambda: "sample" in self.element("pixel-name").text)
        self.assertFalse(self.element("quality").is_displayed())
        self.assertFalse(self.element("plane").is_displayed())
        self.assertTrue(self.element("load").is_displayed())

    def test_a_single_picture_is_shown_once(self):
        self.open_page("random.stipple", "--method", "naive")  # one video, no truth
        for name in ("divider", "name-b"):
            self.assertFalse(self.element(name).is_displayed(), name)
        self.assertTrue(self.element("play").is_enabled())
        Select(self.element("view-b")).select_by_visible_text("samples, random")
        for name in ("divider", "name-b"):
            self.assertTrue(self.element(name).is_displayed(), name)

    def test_a_single_slot_cannot_be_played_and_fills_its_charts(self):
        self.succeed("synth", "pan", "-o", "still.npy", "--frames", 1, "--size", f"{COLS}x{ROWS}")
        self.succeed("emulate", "still.npy", "-o", "still.stipple")
        self.open_page("still.stipple", "--truth", "still.npy", "--method", "naive")
        for name in ("play", "slot"):
            self.assertFalse(self.element(name).is_enabled(), name)
        self.press(Keys.SPACE)
        self.assertTrue(self.script("return playing === null"))
        if self.script("return typeof Chart === 'undefined'"):
            self.skipTest("the build has no Chart.js (libjs-chart.js)")
        bar, slot = self.script("const {chart} = charts.get('load-chart'), {x} = chart.scales;"
                                "return [chart.getDatasetMeta(1).data[0].width,"
                                "x.getPixelForValue(1) - x.getPixelForValue(0)]")
        self.assertAlmostEqual(bar / slot, 0.9, delta=0.05)  # its categoryPercentage

    def test_nothing_is_left_free_for_a_choice_of_one_run(self):
        for streams, choice in ((["random.stipple"], False), (["random.stipple", "full4x.stipple"], True)):
            self.open_page(*streams, "--method", "naive", "--force")
            self.assertEqual(self.element("load-run").is_displayed(), choice)
            gap = self.script("const box = (s) => document.querySelector(s).getBoundingClientRect();"
                              "return box('#load .chart').top - box('#load-heading').bottom")
            self.assertEqual(gap > 30, choice, gap)

    def test_hostile_names_run_nothing(self):
        name = "<img src=x onerror=window.hit=1>.stipple"
        (self.folder / "random.stipple").rename(self.folder / name)
        self.open_page(name, "--title", "</script><script>window.hit=1</script>", "--method", "naive")
        self.wait(lambda: "sample" in self.element("pixel-name").text)
        self.assertIsNone(self.script("return window.hit ?? null"))
        self.assertEqual(self.element("title").text, "</script><script>window.hit=1</script>")

    def test_figures_of_a_camera_alone(self):
        self.succeed("characterize", "--sensor", "grasshopper", "-o", "series")
        self.open_file("series/report.html")
        self.assertTrue(self.element("camera").is_displayed())
        self.assertFalse(self.element("viewer").is_displayed())
        self.assertIn("system gain K", self.element("camera-table").text)
        self.assertRegex(self.element("camera-table").text, r"dynamic range [\d.]+ \([\d.]+ dB\)")


if __name__ == "__main__":
    unittest.main()
