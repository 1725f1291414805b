"""The page of `stipple explore` in a browser: the frontier, ranges of axes, the table, a point with its pictures and
its commands; keys, dark mode, a narrow screen; no error, no network."""

import base64
import csv
import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from browser import LACKING, By, BrowserTest, Keys, Select, webdriver
from program import INPUT, OK, PROGRAM

SPACE = """
[axes]
sensor = "lux1310"
schedule = ["random", "tiled", "full1x", "full4x"]
method = "naive"
[set]
"sensor.slot_us" = 333.333
"sensor.bit_depth" = [6, 10]
[clip]
frames = 16
rows = 32
cols = 48
[readout]
rows = 1024
cols = 1280
"""


@unittest.skipIf(LACKING, LACKING)
class ExplorePageTest(BrowserTest):
    """Each test opens the page again. The trials of SPACE are run once."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.trials = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        (cls.trials / "space.toml").write_text(SPACE)
        subprocess.run([PROGRAM, "explore", "space.toml", "-o", "results", "--quiet", "--no-sync"], cwd=cls.trials, check=True)

    def open_page(self, space=SPACE, *more, code=OK):
        if space is SPACE:
            self.folder = self.trials
        else:
            (self.folder / "space.toml").write_text(space)
            done = self.run_program("explore", "space.toml", "-o", "results", "--no-sync", *more)
            self.assertEqual(done.returncode, code, done.stderr)
        self.open_file("results/report.html")
        with open(self.folder / "results/table.csv", newline="") as table:
            self.rows = list(csv.DictReader(table))

    def press(self, *keys):
        webdriver.ActionChains(self.browser).send_keys(*keys).perform()

    def table(self):
        """Numbers of the points in the order of the table."""
        return self.script("return [...document.querySelectorAll('#points-table tbody tr')].map((r) => +r.dataset.number)")

    def values(self, name):
        return np.array([float(row[name]) for row in self.rows])

    def need_charts(self):
        if self.script("return typeof Chart === 'undefined'"):
            self.skipTest("the build has no Chart.js (libjs-chart.js)")

    def test_the_frontier_is_that_of_the_table(self):
        self.open_page()
        self.need_charts()
        for x, better in (("slots_per_second", 1), ("energy_uj_per_slot", -1)):
            Select(self.element("x-column")).select_by_value(x)
            a, b = better * self.values(x), self.values("psnr_db")
            expected = [i + 1 for i in range(len(a))
                        if not any((a[j] >= a[i]) & (b[j] >= b[i]) & ((a[j] > a[i]) | (b[j] > b[i]))
                                   for j in range(len(a)))]
            line = self.script("return charts.get('frontier-chart').chart.data.datasets[1].data.map((p) => p.row.number)")
            self.assertEqual(sorted(line), expected)
            self.assertIn(f"({', '.join(map(str, expected))})", self.element("frontier-hint").text)
        Select(self.element("x-column")).select_by_value("schedule")
        self.assertIn("no frontier", self.element("frontier-hint").text)
        inked = self.script("const c = document.getElementById('frontier-chart'); return c.getContext('2d')"
                            ".getImageData(0, 0, c.width, c.height).data.some((v) => v > 0)")
        self.assertTrue(inked)

    def test_all_points_are_in_the_chart(self):
        self.open_page()
        self.need_charts()
        for x in ("slots_per_second", "energy_uj_per_slot", "psnr_gamma_db", "sample_range_stops"):
            Select(self.element("x-column")).select_by_value(x)
            ends, values = self.script("""
                const {chart} = charts.get('frontier-chart'), {x} = chart.scales;
                return [[x.min, x.max], chart.data.datasets[0].data.map((p) => p.x)]""")
            self.assertEqual(len(values), 8)
            self.assertLessEqual(ends[0], min(values), x)
            self.assertGreaterEqual(ends[1], max(values), x)

    def test_a_click_on_the_chart_chooses_the_point(self):
        self.open_page()
        self.need_charts()
        place = self.script("const {chart} = charts.get('frontier-chart'); const p = chart.getDatasetMeta(0).data[3];"
                            "const b = chart.canvas.getBoundingClientRect();"
                            "return [p.x - b.width / 2, p.y - b.height / 2, chart.data.datasets[0].data[3].row.number]")
        webdriver.ActionChains(self.browser).move_to_element_with_offset(
            self.element("frontier-chart"), round(place[0]), round(place[1])).click().perform()
        self.wait(lambda: self.element("point-heading").text == f"Point {place[2]}")

    def test_pictures_are_those_of_the_trial(self):
        self.open_page()
        truth = self.script("return rows.map((row) => row.picture)")
        self.assertEqual(len(set(truth)), 8)
        png = base64.b64decode(truth[0])
        self.assertEqual(struct.unpack(">II", png[16:24]), (4 * 48, 32))
        files = sorted(path.read_bytes() for path in self.folder.glob("results/trials/*.png"))
        self.assertEqual(sorted(map(base64.b64decode, truth)), files)
        self.wait(lambda: self.script("return document.getElementById('pictures').dataset.number") is not None)
        tiles = self.browser.find_elements(By.CSS_SELECTOR, "#pictures div")
        self.assertEqual([tile.get_attribute("aria-label") for tile in tiles], ["truth", "naive", "decoded", "error"])
        for tile in tiles:
            self.assertAlmostEqual(tile.rect["width"] / tile.rect["height"], 48 / 32, delta=0.05)
            self.assertIn("data:image/png", tile.value_of_css_property("background-image"))
        places = [float(tile.value_of_css_property("background-position-x").rstrip("%")) for tile in tiles]
        np.testing.assert_allclose(places, [0, 100 / 3, 200 / 3, 100], atol=0.01)

    def test_the_commands_repeat_the_figures(self):
        """Of the page into a shell; the figures are the same to all digits."""
        self.open_page(SPACE.replace('"naive"', '"fast"').replace('"full1x", "full4x"', '"full1x"'))
        environment = {**os.environ, "PATH": f"{Path(PROGRAM).parent}:{os.environ['PATH']}"}
        for index in (0, 3):
            number, commands = self.script("const row = inOrder[arguments[0]]; choose({point: row});"
                                           "return [row.number, document.getElementById('point-commands').textContent]", index)
            folder = self.folder / f"point_{number}"
            folder.mkdir()
            commands = commands.replace("--max-value 2\n", "--max-value 2 --json compared.json\n")
            done = subprocess.run(["sh", "-e"], input=commands, text=True, cwd=folder, env=environment, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            row = self.rows[number - 1]
            with open(folder / "point/table.csv", newline="") as table:
                again, = csv.DictReader(table)
            for name in ("psnr_db", "slots_per_second", "energy_uj_per_slot", "light_throughput"):
                self.assertEqual(again[name], row[name])
            self.assertIn(f'"psnr_db": {row["psnr_db"][:12]}', (folder / "compared.json").read_text())

    def test_headings_sort_the_table(self):
        self.open_page()
        for name in ("psnr_db", "schedule"):
            button = self.browser.find_element(By.CSS_SELECTOR, f'#points-table button[data-sort="{name}"]')
            button.click()
            values = [self.rows[number - 1][name] for number in self.table()]
            if name == "psnr_db":
                self.assertEqual(list(map(float, values)), sorted(map(float, values), reverse=True))
            else:
                self.assertEqual(values, sorted(values, key=["random", "tiled", "full1x", "full4x"].index))
            self.press(Keys.ENTER)  # the heading has kept the focus: the other way round
            self.wait(lambda: self.table()[0] != 0)
            self.assertEqual([self.rows[number - 1][name] for number in self.table()][::-1][0], values[0])

    def test_a_range_of_an_axis_chooses_points(self):
        self.open_page()
        self.assertEqual(len(self.table()), 8)
        names = self.script("return columns.map((column) => column.name)")
        index = names.index("psnr_db")
        middle = np.median(self.values("psnr_db"))
        grip = self.browser.find_element(By.CSS_SELECTOR, f"#scale-{index} .grip")
        self.script("arguments[0].scrollIntoView({block: 'center'})", grip)
        height = self.script("return heightOf(0) - heightOf(1)")
        share = (middle - self.values("psnr_db").min()) / np.ptp(self.values("psnr_db"))
        webdriver.ActionChains(self.browser).move_to_element_with_offset(grip, 0, round(-height / 2 - 5)).click_and_hold() \
            .move_to_element_with_offset(grip, 0, round(height / 2 - share * height)).release().perform()
        expected = {i + 1 for i, value in enumerate(self.values("psnr_db")) if value > middle}
        self.wait(lambda: set(self.table()) == expected)
        self.assertEqual(self.script("return +document.getElementById('lines').dataset.chosen"), len(expected))
        self.assertIn(f"{len(expected)} of 8", self.element("brushed").text)
        self.element("clear").click()
        self.wait(lambda: len(self.table()) == 8)

    def test_keys_set_ranges_and_choose_points(self):
        self.open_page()
        index = self.script("return columns.findIndex((column) => column.name === 'schedule')")
        self.script("document.getElementById(`scale-${arguments[0]}`).focus()", index)
        self.press(Keys.ARROW_UP)
        self.wait(lambda: len(self.table()) == 6)
        self.assertNotIn("random", {self.rows[number - 1]["schedule"] for number in self.table()})
        self.assertEqual(self.script("return document.activeElement.getAttribute('aria-valuetext')"), "tiled, full1x, full4x")
        self.press(Keys.ARROW_DOWN)
        self.wait(lambda: {self.rows[number - 1]["schedule"] for number in self.table()} == {"tiled", "full1x"})
        self.press(Keys.DELETE)
        self.wait(lambda: len(self.table()) == 8)
        order = self.table()
        self.script("document.activeElement.blur(); choose({point: sortedRows()[0]})")
        for key, expected in ((Keys.ARROW_RIGHT, order[1]), (Keys.ARROW_RIGHT, order[2]), (Keys.ARROW_LEFT, order[1])):
            self.press(key)
            self.wait(lambda: self.element("point-heading").text == f"Point {expected}")

    def test_a_line_between_axes_chooses_its_point(self):
        self.open_page()
        left, top, height = self.script("""
            const row = inOrder[5], at = (i) => heightOf(shareOf(columns[i], columns[i].value(row)));
            document.getElementById('axes').scrollIntoView({block: 'center'});
            const box = document.getElementById('axes').getBoundingClientRect();
            return [box.left + (acrossOf(1) + acrossOf(2)) / 2, box.top, (at(1) + at(2)) / 2]""")
        # In the window, as the axes may be wider than it.
        actions = webdriver.ActionChains(self.browser).w3c_actions
        actions.pointer_action.move_to_location(round(left), round(top + height)).click()
        actions.perform()
        # Lines may cross there: any that passes within a pixel is as good.
        self.wait(lambda: self.script("""
            const row = state.point, at = (i) => heightOf(shareOf(columns[i], columns[i].value(row)));
            return Math.abs((at(1) + at(2)) / 2 - arguments[0]) < 2""", height))

    def test_dark_mode_and_a_narrow_screen(self):
        self.open_page()
        for scheme in ("light", "dark"):
            self.use_colours(scheme)
            brightness = self.script("return getComputedStyle(document.body).backgroundColor.match(/\\d+/g)"
                                     ".slice(0, 3).reduce((sum, part) => sum + Number(part), 0)")
            self.assertEqual(brightness < 200, scheme == "dark", brightness)
            for width in (390, 1400):
                self.use_width(width)
                self.wait(lambda: self.script("return document.documentElement.scrollWidth") <= width)
                self.wait(lambda: self.script("return Math.abs(document.getElementById('lines').width - "
                                              "document.getElementById('axes').clientWidth) < 2"))

    def test_every_control_has_a_name_and_can_be_reached_by_tab(self):
        self.open_page()
        reached = set()
        for _ in range(60):
            self.press(Keys.TAB)
            reached.add(self.script("return document.activeElement.id"))
        self.assertTrue(reached.issuperset({"x-column", "y-column", "z-column", "scale-0", "scale-1", "next",
                                            "point-commands"}), reached)
        nameless = self.script(
            "return [...document.querySelectorAll('input, select, button, [role], canvas')].filter((e) => "
            "!(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim())).map((e) => e.id || e.outerHTML)")
        self.assertEqual(nameless, [])

    def test_one_point_and_points_that_all_fail(self):
        one = SPACE.replace('["random", "tiled", "full1x", "full4x"]', '"tiled"').replace("[6, 10]", "8")
        self.open_page(one)
        self.assertFalse(self.element("parallel").is_displayed())
        self.assertEqual(self.element("point-heading").text, "Point 1")
        self.assertEqual(self.table(), [1])
        self.open_page(SPACE.replace("lux1310", "nosuch"), "--force", code=INPUT)
        for name in ("frontier", "parallel"):
            self.assertFalse(self.element(name).is_displayed(), name)
        self.assertEqual(len(self.table()), 8)
        self.assertIn("nosuch", self.element("points-table").text)
        self.assertIn("nosuch", self.element("point-values").text)

    def test_hostile_names_run_nothing(self):
        name = "<img src=x onerror=window.hit=1></script><script>window.hit=1</script>"
        self.open_page(SPACE.replace("lux1310", name), code=INPUT)
        self.assertIsNone(self.script("return window.hit ?? null"))
        self.assertIn(name, self.element("point-values").text)

    def test_rungs_are_told(self):
        self.open_page(SPACE.replace("frames = 16", "frames = 24"), "--budget", "100", "--rank", "psnr_db")
        self.assertIn("12, 24", self.browser.find_element(By.CLASS_NAME, "facts").text)
        rung = self.script("return rows.map((row) => row.rung)")
        self.assertEqual(rung, sorted(rung, reverse=True))
        self.assertEqual(rung.count(2), 4)
        for down in (True, False):
            order = self.script("choose({sort: {name: 'psnr_db', down: arguments[0]}});"
                                "return sortedRows().map((row) => row.rung)", down)
            self.assertEqual(order, sorted(rung, reverse=True))
        dropped = len(self.browser.find_elements(By.CSS_SELECTOR, "#points-table tr.dropped"))
        self.assertEqual(dropped, rung.count(1))
        best = self.script("return [...frontierOf(rows, columnOf(state.x), columnOf('psnr_db')), ...unbeatenOf(rows)]"
                                ".map((row) => row.rung)")
        self.assertEqual(set(best), {2})

    def test_seeds_have_intervals_and_ranks(self):
        self.open_page(SPACE + "\n", "--seeds", "3")  # a space of its own, so that it is run
        ranks = self.script("return inOrder.map((row) => row.rank)")
        self.assertEqual(ranks, [row["rank"] for row in self.rows])
        text = self.script("return columnOf('psnr_db').text(inOrder[0])")
        half = (float(self.rows[0]["psnr_db_high"]) - float(self.rows[0]["psnr_db_low"])) / 2
        self.assertAlmostEqual(float(text.split(" ± ")[1]), half, delta=0.06 * half)
        self.assertIn("--seeds 3", self.script("return inOrder[0].commands"))


if __name__ == "__main__":
    unittest.main()
