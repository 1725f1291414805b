"""Pages that the program makes, in a browser without a screen."""

import shutil

from program import ProgramTest

try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
    LACKING = next((f"{name} is not installed" for name in ("chromium", "chromedriver")
                    if shutil.which(name) is None), None)
except ImportError:
    webdriver = By = Keys = Select = WebDriverWait = None
    LACKING = "python3-selenium is not installed"


class BrowserTest(ProgramTest):
    """One browser for all tests of a class. A complaint in its console is a failure."""

    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",
                         "--window-size=1400,1000", "--force-device-scale-factor=1"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.chrome.service.Service(shutil.which("chromedriver"))
        options.binary_location = shutil.which("chromium")
        cls.browser = webdriver.Chrome(service=service, options=options)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        super().setUp()
        self.addCleanup(self.expect_no_complaint)

    def expect_no_complaint(self):
        self.assertEqual([entry["message"] for entry in self.browser.get_log("browser")], [])

    def open_file(self, name):
        self.browser.get((self.folder / name).as_uri())
        self.wait(lambda: self.script("return document.documentElement.dataset.ready === 'true'"))

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def wait(self, condition):
        WebDriverWait(self.browser, 20).until(lambda _: condition())

    def element(self, name):
        return self.browser.find_element(By.ID, name)

    def use_width(self, width):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": False})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        self.wait(lambda: self.script("return window.innerWidth") == width)

    def use_colours(self, scheme):
        """"light" or "dark"."""
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
