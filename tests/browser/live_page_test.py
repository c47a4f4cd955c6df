"""The live page of a real run in a real browser.

live_page_test.py PROGRAM ROOT FOLDER, as ctest calls it; ends with 77 if there is no browser.
The tests build on each other, in the order of their names.
"""

import http.client
import pathlib
import shutil
import sys
import unittest

import webdriver
from live_run import Cameras, Run

PROGRAM, ROOT, FOLDER = (pathlib.Path(argument) for argument in sys.argv[1:4])
SCENE = ROOT / "datasets/sheet_two_weights/scene.yaml"
OPTIONS = ["--no-overlay", "--no-report"]
CARD = "document.querySelector('#cards b')"
SAID = "document.getElementById('said').textContent"
LINK = "document.getElementById('link').textContent"


class LivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cameras = Cameras(ROOT, FOLDER / "cameras", rate=10)
        cls.run_ = Run(PROGRAM, SCENE, FOLDER / "out", cls.cameras, more=OPTIONS)
        cls.browser = webdriver.Browser()
        cls.browser.open(cls.run_.url)

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        if cls.run_.process.poll() is None:
            cls.run_.kill()
        cls.cameras.close()

    def wait(self, script, seconds=30):
        return self.browser.wait(f"return {script}", seconds)

    def norm(self):
        """N, of the first force as the page has it."""
        return float(self.browser.run(f"return {CARD}.textContent").split()[0])

    def test_1_loads_without_errors_and_without_asking_others(self):
        self.wait(f"{LINK} === 'live'")
        self.wait("Number(document.getElementById('forces').dataset.points) > 10")
        self.wait("document.getElementById('picture').naturalWidth === 1280")
        if self.browser.run("return !!window.softforceBody"):
            self.wait("document.getElementById('view').dataset.ready === 'yes'")
            self.browser.drawn("#view canvas")
        self.assertEqual(self.browser.errors(), [])
        asked = self.browser.requests(self.run_.url)
        self.assertIn(self.run_.url + "events", asked)
        self.assertEqual([url for url in asked if not url.startswith(
            (self.run_.url, "blob:", "data:"))], [])

    def test_2_shows_forces_markers_and_stages(self):
        self.assertAlmostEqual(self.norm(), 0.559, delta=0.1)  # N; the weight, with room for noise
        self.assertGreater(self.browser.run(
            "return document.querySelectorAll('#markers .s0').length"), 5)
        self.assertIn("estimate", self.browser.run(
            "return document.getElementById('stages').innerText"))

    def test_3_plots_move(self):
        line = "document.querySelector('#forces path.line').getAttribute('d')"
        band = "document.querySelector('#forces path.band').getAttribute('d')"
        before, before_band = self.browser.run(f"return [{line}, {band}]")
        self.browser.wait(f"return {line} !== {before!r} && {band} !== {before_band!r}")
        moment = "document.getElementById('moment').textContent"
        shown = self.browser.run(f"return {moment}")
        self.browser.wait(f"return {moment} !== {shown!r}")
        picture = "document.getElementById('picture').src"
        shown = self.browser.run(f"return {picture}")
        self.browser.wait(f"return {picture} !== {shown!r}")

    def test_4_tare_is_refused_without_the_token(self):
        for token in ("", "0" * 32):
            self.type_token(token)
            self.browser.click("[data-post=tare]")
            self.wait(f"{SAID}.includes('token')")
        self.assertGreater(self.norm(), 0.4)
        self.assertTrue(all("403" in error for error in self.browser.errors()))

    def type_token(self, token):
        self.browser.run("const box = document.getElementById('token'); box.value = arguments[0];"
                         "box.dispatchEvent(new Event('input'))", token)

    def test_5_tare_works_with_the_token(self):
        # As the address that is printed has it; the page does not keep it in the address.
        self.browser.open("about:blank")
        self.browser.open(f"{self.run_.url}#token={self.run_.token}")
        self.wait(f"{LINK} === 'live'")
        self.assertEqual(self.browser.run("return location.hash"), "")
        self.browser.click("[data-post=tare]")
        self.wait(f"{SAID} === 'tared'")
        self.wait(f"parseFloat({CARD}.textContent) < 0.1")  # N; of 0.56: what noise leaves

    def test_6_records_on_request(self):
        self.browser.click("#record")
        self.wait("document.getElementById('record').textContent === 'Stop recording'")
        self.browser.click("#record")
        self.wait("document.getElementById('record').textContent === 'Record'")
        self.assertIn("complete: true",
                      (self.run_.out / "recording-1/recording.yaml").read_text())

    def test_7_connects_again_after_the_program_was_started_again(self):
        port, url = self.run_.port, self.run_.url
        self.run_.kill()
        self.wait(f"{LINK}.includes('connection lost')")
        type(self).run_ = Run(PROGRAM, SCENE, FOLDER / "out", self.cameras, port, OPTIONS)
        self.assertEqual(self.run_.url, url)
        self.wait(f"{LINK} === 'live'")
        self.wait("Number(document.getElementById('forces').dataset.points) > 3")
        # Another run has another token.
        self.browser.click("[data-post=tare]")
        self.wait(f"{SAID}.includes('wrong token')")
        self.browser.errors()

    def test_8_stands_on_a_small_screen_and_in_the_dark(self):
        self.browser.emulate("setDeviceMetricsOverride", width=400, height=800,
                             deviceScaleFactor=1, mobile=True)
        self.browser.emulate("setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark"}])
        widths = self.browser.run("return [document.documentElement.scrollWidth, innerWidth]")
        dark = self.browser.run("return getComputedStyle(document.body).backgroundColor")
        self.browser.emulate("setEmulatedMedia", features=[])
        self.browser.emulate("clearDeviceMetricsOverride")
        self.assertEqual(widths, [400, 400])
        self.assertEqual(dark, "rgb(17, 21, 26)")

    def test_9_stops_and_says_how_it_ended(self):
        self.type_token(self.run_.token)
        self.browser.click("[data-post=stop]")
        self.wait(f"{LINK}.startsWith('run ended')")
        self.assertEqual(self.run_.close(), 0)
        with self.assertRaises(ConnectionRefusedError):
            http.client.HTTPConnection("127.0.0.1", self.run_.port).request("GET", "/")


if __name__ == "__main__":
    absent = webdriver.missing() + [name for name in ("ffmpeg",) if not shutil.which(name)]
    if absent:
        print(f"SKIPPED: not installed: {', '.join(absent)}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
