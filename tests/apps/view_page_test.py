"""The page of `stipple view` in a browser: pictures that become better, zoom, region, line, time line,
readout, keys; no complaint in its console."""

import unittest

import numpy as np
from browser import LACKING, BrowserTest, By, Keys, webdriver
from view_camera_test import ServedCamera
from view_test import Viewer, light_of

COLS, ROWS, SLOTS = 64, 48, 60


@unittest.skipIf(LACKING, LACKING)
class ViewPageTest(BrowserTest):
    def setUp(self):
        super().setUp()
        self.succeed("synth", "pan", "-o", "scene.npy", "--frames", SLOTS, "--size", f"{COLS}x{ROWS}")
        self.succeed("emulate", "scene.npy", "-o", "clip.stipple", "--sensor", "lux1310", "--luminance")
        self.viewer = Viewer(self, "clip.stipple", "--truth", "scene.npy", "--luminance", "--method", "fast")
        self.addCleanup(self.browser.get, "about:blank")  # before its server ends
        self.browser.get(self.viewer.url)
        self.addCleanup(self.browser.get, "about:blank")  # before its server ends
        self.wait(lambda: self.script("return document.documentElement.dataset.ready === 'true'"))

    def press(self, *keys):
        webdriver.ActionChains(self.browser).send_keys(*keys).perform()

    def drag(self, start, end, key=None):
        """Between two places of the stage, as fractions of its sides."""
        stage = self.element("stage")
        self.script("arguments[0].scrollIntoView({block: 'center'})", stage)
        size = stage.size
        from_middle = [(round((x - 0.5) * size["width"]), round((y - 0.5) * size["height"])) for x, y in (start, end)]
        actions = webdriver.ActionChains(self.browser)
        if key:
            actions.key_down(key)
        actions.move_to_element_with_offset(stage, *from_middle[0]).click_and_hold()
        actions.move_to_element_with_offset(stage, *from_middle[1]).release()
        if key:
            actions.key_up(key)
        actions.perform()

    def test_the_decoded_picture_becomes_that_of_the_method(self):
        self.wait(lambda: self.element("name-a").text == "clip, fast")
        slot = int(self.script("return state.slot"))
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "fast")
        codes = self.script(f"return plane('v0-{slot}').then((codes) => [...codes])")
        np.testing.assert_allclose(light_of(np.array(codes)), self.array("decoded.npy")[slot].ravel(), rtol=0.0028, atol=1e-4)

    def test_zoom_keeps_the_pixel_under_the_pointer(self):
        before = self.script("return pixelAt({x: 0.3, y: 0.7})")
        self.script("chooseZoom(4, {x: 0.3, y: 0.7})")
        self.assertEqual(self.script("return pixelAt({x: 0.3, y: 0.7})"), before)
        self.drag((0.2, 0.3), (0.45, 0.3))  # a quarter of what is shown, which is a quarter of the frame
        moved = self.script("return pixelAt({x: 0.3, y: 0.7})")
        self.assertAlmostEqual(moved["col"], before["col"] - COLS / 16, delta=1)
        self.press("0")
        self.assertEqual(self.script("return state.zoom.scale"), 1)
        self.press("z", "z", "x")
        self.assertAlmostEqual(self.script("return state.zoom.scale"), 1.5)

    def test_a_region_has_the_statistics_of_the_truth(self):
        self.script("choose({slot: 20})")
        self.drag((0.25, 0.25), (0.5, 0.75), Keys.SHIFT)
        region = self.script("return state.region")
        self.assertAlmostEqual(region["rows"], ROWS / 2, delta=2)
        rows, cols = slice(region["row"], region["row"] + region["rows"]), slice(region["col"], region["col"] + region["cols"])
        light = self.array("scene.npy")[20] @ [0.2126, 0.7152, 0.0722]
        part = light[rows, cols]

        def told():
            cells = self.script("return [...document.querySelectorAll('#region-table tr:last-child td')].map(c => c.innerText)")
            return cells if cells and cells[0] == "truth" and "slot 20" in self.element("region-name").text else None
        self.wait(told)
        cells = told()
        self.assertEqual(int(cells[1]), part.size)
        self.assertAlmostEqual(float(cells[2]), part.mean(), delta=0.003 * part.mean())
        self.assertAlmostEqual(float(cells[3]), part.std(), delta=0.01 * part.std())
        self.press(Keys.ESCAPE)
        self.assertFalse(self.element("region").is_displayed())

    def test_a_line_has_a_profile(self):
        self.drag((0.1, 0.5), (0.9, 0.5), Keys.ALT)
        line = self.script("return state.line")
        self.assertEqual(line["from"]["row"], line["to"]["row"])
        light = self.array("scene.npy") @ [0.2126, 0.7152, 0.0722]
        chart = "Chart.getChart('profile-chart')"
        self.wait(lambda: self.script(f"return {chart}?.data.datasets.length === 2"))
        points = self.script(f"return {chart}.data.datasets[1].data.map(({{y}}) => y)")
        slot = self.script("return state.slot")
        expected = light[slot, line["from"]["row"], line["from"]["col"]:line["to"]["col"] + 1]
        np.testing.assert_allclose(points, expected, rtol=0.003)

    def test_false_colour_and_limits_of_the_picture(self):
        self.press("d", "d", "d", "d")
        self.assertEqual(self.script("return state.display"), "colour")
        self.press("l")
        light = self.array("scene.npy")[self.script("return state.slot")]
        self.wait(lambda: self.script("return state.high") != 1)
        self.assertLess(self.script("return state.high"), 1.5 * light.max())
        self.assertTrue(self.script("const p = document.getElementById('picture-a').getContext('2d').getImageData(0, 0, 64, 48).data;"
                                    "return p.some((v, i) => i % 4 === 0 && v !== p[i + 1])"))

    def test_the_time_line_leads_to_a_slot_and_the_readout_is_shown(self):
        self.wait(lambda: "0 slots missing" in self.element("timeline-hint").text)
        strip = self.element("timeline-strip")
        webdriver.ActionChains(self.browser).move_to_element(strip).click().perform()
        self.assertAlmostEqual(self.script("return state.slot"), SLOTS / 2, delta=1)
        self.wait(lambda: "rows read in" in self.element("lanes-hint").text)

    def test_the_samples_of_a_pixel_are_shown_with_their_errors(self):
        self.script("choosePixel(10, 20)")
        self.wait(lambda: "row 10, column 20" in self.element("pixel-name").text)
        listed = self.viewer.json("samples", run=0, row=10, col=20, **dict(zip(("first", "end"), self.script("return chartSlots()"))))
        self.wait(lambda: self.element("pixel-name").text.endswith(f"{len(listed)} samples"))

    def test_help_lists_the_keys_and_play_goes_on(self):
        self.press("?")
        self.assertIn("play", self.element("help-table").text)
        self.press(Keys.ESCAPE)
        slot = self.script("return state.slot")
        self.press(" ")
        self.wait(lambda: self.script("return state.slot") != slot)
        self.press(" ")

    def test_all_of_it_fits_a_narrow_and_a_dark_screen(self):
        self.use_colours("dark")
        for width in (420, 1280):
            self.use_width(width)
            self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), width)

    def test_a_server_that_ends_is_told(self):
        self.wait(lambda: self.element("name-a").text == "clip, fast")
        self.viewer.program.terminate()
        self.viewer.program.wait(timeout=20)
        self.script("chooseSlot(3)")
        self.wait(lambda: "has ended" in self.element("state").text)
        self.browser.get_log("browser")  # of requests that find nobody


@unittest.skipIf(LACKING, LACKING)
class CameraPageTest(BrowserTest, ServedCamera):
    def setUp(self):
        super().setUp()
        self.serve()
        self.viewer = Viewer(self, self.address)
        self.browser.get(self.viewer.url)
        self.addCleanup(self.browser.get, "about:blank")  # before its server ends
        self.wait(lambda: self.script("return document.documentElement.dataset.ready === 'true'"))

    def test_the_newest_slot_is_shown_until_another_one_is_chosen(self):
        first = int(self.script("return state.slot"))
        self.wait(lambda: int(self.script("return state.slot")) > first + 20)
        self.wait(lambda: "after its light" in self.element("state").text)
        self.script("chooseSlot(state.slot - 5)")
        self.wait(lambda: not self.element("follow").is_selected())
        still = self.script("return state.slot")
        newest = self.script("return data.slots")
        self.wait(lambda: self.script("return data.slots") > newest + 20)
        self.assertEqual(self.script("return state.slot"), still)

    def test_a_click_begins_and_ends_a_recording(self):
        self.element("record").click()
        self.wait(lambda: ".strec" in self.element("recording").text)
        self.wait(lambda: " 0 frames" not in self.element("recording").text)
        self.element("record").click()
        self.wait(lambda: ".strec" in self.element("camera-events").text)
        self.assertEqual(len(list(self.folder.glob("*.strec"))), 1)

    def set_feature(self, name, value):
        """Types a value into the table of features. The fields of this name."""
        self.script("document.getElementById('features').open = true")
        self.element("feature-filter").send_keys(name)

        def fields():
            return self.browser.find_elements(By.CSS_SELECTOR, f"#features-table input[aria-label={name}]")
        self.wait(fields)
        self.script("const [input, value] = arguments; input.value = value; input.dispatchEvent(new Event('change'))",
                    fields()[0], value)
        return fields

    def test_features_are_set_on_the_page(self):
        fields = self.set_feature("GevHeartbeatTimeout", "2000")
        self.wait(lambda: self.element("feature-answer").text == "GevHeartbeatTimeout = 2000")
        self.wait(lambda: fields() and fields()[0].get_attribute("value") == "2000")

    def test_a_region_is_set_by_opening_the_camera_anew(self):
        self.set_feature("Height", "24")
        self.wait(lambda: self.script("return data.frame.rows") == 24)

    def test_another_schedule_is_chosen_on_the_page(self):
        self.script("document.getElementById('sensor').open = true")
        self.wait(lambda: self.element("sensor-schedule").get_attribute("value") == "random")
        self.element("sensor-schedule").find_element(By.CSS_SELECTOR, "option[value=tiled]").click()
        self.element("sensor-keys").send_keys("sensor.full_scale_e=8000")
        self.element("sensor-form").find_element(By.TAG_NAME, "button").click()
        self.wait(lambda: "schedule=tiled,sensor.full_scale_e=8000" in self.element("camera-events").text)
        self.wait(lambda: "on: schedule tiled." in self.element("schedule-hint").text)
        self.wait(lambda: self.script("return data.runs[0].samples.responses.length") == 2)
        self.script("choosePixel(10, 10)")
        self.wait(lambda: self.element("pixel-name").text.endswith("samples"))

    def test_edges_and_clipped_pixels_are_marked(self):
        self.script("choose({a: 'focus', b: 'focus'})")
        self.wait(lambda: self.element("name-a").text == "camera, focus and clipping")
        self.wait(lambda: "0 % at full scale" in self.element("camera-clipping").text)
        colours = self.script("""return focusImage(data.slots - 1).then((image) => {
          let edges = 0;
          for (let i = 0; i < pixelCount; ++i) edges += image.data[4 * i] === 40 && image.data[4 * i + 1] === 255;
          return edges / pixelCount;
        })""")
        self.assertAlmostEqual(colours, 0.02, delta=0.01)


if __name__ == "__main__":
    unittest.main()
