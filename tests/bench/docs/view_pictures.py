#!/usr/bin/python3
"""The pictures of docs/view.md: `stipple view` of a stream and of a running camera, in a browser without a screen.

    tests/bench/docs/view_pictures.py build/release/stipple docs/figures

Needs Aravis, chromium, chromedriver and python3-selenium."""

import contextlib
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.support.ui import WebDriverWait

SIZE, FRAMES, ADDRESS = "640x480", 96, "127.77.0.1"
WINDOW = (1280, 900)


@contextlib.contextmanager
def running(*command, folder):
    """A program until the end of the block, and the first line that it prints."""
    with subprocess.Popen([str(part) for part in command], cwd=folder, text=True, stdout=subprocess.PIPE) as process:
        try:
            yield process.stdout.readline().strip()
        finally:
            process.terminate()


@contextlib.contextmanager
def browser():
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--window-size={WINDOW[0]},{WINDOW[1]}"):
        options.add_argument(argument)
    options.binary_location = "/usr/bin/chromium"
    opened = webdriver.Chrome(service=webdriver.chrome.service.Service("/usr/bin/chromedriver"), options=options)
    try:
        yield opened
    finally:
        opened.quit()


def take(page, url, script, ready, picture):
    """Opens a page, runs a script, waits until `ready` is true, and keeps what is seen."""
    page.get(url)
    WebDriverWait(page, 60).until(lambda _: page.execute_script("return document.documentElement.dataset.ready === 'true'"))
    page.execute_script(script)
    WebDriverWait(page, 300).until(lambda _: page.execute_script(f"return {ready}"))
    time.sleep(1)
    page.save_screenshot(str(picture))


def main(program, target):
    program, target = Path(program).resolve(), Path(target).resolve()
    with tempfile.TemporaryDirectory() as folder, browser() as page:
        def run(*arguments):
            subprocess.run([program, *map(str, arguments)], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        run("synth", "dice", "-o", "scene.npy", "--frames", FRAMES, "--size", SIZE)
        run("emulate", "scene.npy", "-o", "clip.stipple", "--sensor", "lux1310")
        with running(program, "view", "clip.stipple", "--truth", "scene.npy", "--method", "fast", folder=folder) as url:
            take(page, url, "choose({slot: 40, a: 'samples-0', b: 'light-0', pixel: {row: 300, col: 250}, divider: 45})",
                 "element('name-b').textContent.startsWith('clip, fast')", target / "view.png")
        serve = ("capture", "serve", "scene.npy", "--repeat", "--address", ADDRESS, "--frames-hz", 50)
        with running(program, *serve, folder=folder), \
                running(program, "view", f"gige:{ADDRESS}", "--sensor", "lux1310", folder=folder) as url:
            take(page, url, "choose({a: 'focus'}); element('features').open = true; element('feature-filter').value = 'rate'",
                 "data.slots > 150 && element('name-b').textContent.startsWith('decoded, live')", target / "view_camera.png")


if __name__ == "__main__":
    main(*sys.argv[1:])
