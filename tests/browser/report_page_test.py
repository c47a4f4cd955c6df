"""report.html of a real run in a real browser.

report_page_test.py PROGRAM SCENE FOLDER, as ctest calls it; ends with 77 if there is no browser.
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest

import webdriver

PROGRAM, SCENE, FOLDER = (pathlib.Path(argument) for argument in sys.argv[1:4])


def report():
    return (FOLDER / "report.html").as_uri()


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run = subprocess.run(
            [PROGRAM, "run", SCENE, "--out", FOLDER, "--frames", "0:12", "--overlay-width", "640"],
            capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        cls.browser = webdriver.Browser()
        cls.browser.open(report())

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def data(self):
        return json.loads(self.browser.run(
            "return document.getElementById('chart-data').textContent"))

    def need_view(self):
        if not self.browser.run("return !!document.getElementById('view')"):
            self.skipTest("built without the 3-D view")
        self.assertEqual(self.browser.wait(
            "return document.getElementById('view').dataset.ready"), "yes")

    def test_loads_without_errors_and_without_asking_anyone(self):
        self.browser.open(report())
        self.browser.wait("return document.readyState === 'complete'")
        self.assertEqual(self.browser.errors(), [])
        asked = self.browser.requests(report())
        self.assertIn(report(), asked)
        self.assertEqual([url for url in asked if not re.match("file:|data:|blob:", url)], [])
        self.assertEqual([url for url in asked if url.startswith("file:") and url != report()], [])

    def test_charts_hold_the_forces_of_the_table(self):
        rows = (FOLDER / "forces.csv").read_text().splitlines()
        header = rows[0].split(",")
        last = dict(zip(header, rows[-1].split(",")))
        data = self.data()
        self.assertEqual(len(data["first"]), 12)
        line = next(line for line in data["charts"]["norm"]
                    if line["name"] == "F" + last["candidate"])
        # N; the page has five digits, the table at least four decimals
        self.assertAlmostEqual(line["low"][-1], float(last["norm_N"]), delta=1e-4)
        self.assertLess(line["bandLow"][-1], line["low"][-1])
        # The drawn line rises as the load does: pixels, downwards.
        path = self.browser.run("return document.querySelector('[data-chart=norm] path.line')"
                                ".getAttribute('d')")
        points = re.findall(r"[ML]([\d.]+) ([\d.]+)", path)
        self.assertEqual(len(points), 12)
        self.assertLess(float(points[-1][1]), float(points[0][1]) - 50)

    def test_pointer_reads_a_chart(self):
        self.browser.point_at("[data-chart=norm] svg", x=60)
        text = self.browser.run("return document.getElementById('tip').innerText")
        self.assertRegex(text, r"frame \d+, [\d.]+ s")
        self.assertRegex(text, r"F0: [\d.]+ N \(95 %: [\d.]+ … [\d.]+\)")
        shown = int(re.search(r"frame (\d+)", text)[1])
        value = self.data()["charts"]["norm"][0]["low"][shown]
        self.assertAlmostEqual(float(re.search(r"F0: ([\d.]+)", text)[1]), value, delta=1e-3)
        # Another place, another frame.
        self.browser.point_at("[data-chart=norm] svg", x=-200)
        self.assertNotIn(f"frame {shown},",
                         self.browser.run("return document.getElementById('tip').innerText"))

    def test_pointer_reads_the_timeline(self):
        self.browser.point_at("[data-chart=markers] svg")
        self.assertRegex(self.browser.run("return document.getElementById('tip').innerText"),
                         r"marker \d+: seen")

    def test_body_is_drawn_and_turns(self):
        self.need_view()
        before = self.browser.drawn("#view canvas")
        self.browser.point_at("#view canvas", drag=(150, 20))
        after = self.browser.picture("#view canvas")
        changed = sum(before.at(x, y) != after.at(x, y) for y in range(0, before.height, 4)
                      for x in range(0, before.width, 4))
        self.assertGreater(changed, 200)  # of 30,000 pixels looked at

    def test_body_shows_key_frames(self):
        self.need_view()
        self.browser.run("[...document.querySelectorAll('#view button')]"
                         ".find((one) => one.textContent.includes('first frame')).click()")
        self.assertEqual(self.browser.run("return document.getElementById('view').dataset.frame"),
                         "0")
        self.browser.run("[...document.querySelectorAll('#view button')]"
                         ".find((one) => one.textContent.includes('last frame')).click()")
        self.assertEqual(self.browser.run("return document.getElementById('view').dataset.frame"),
                         "11")

    def test_pictures_are_in_the_page(self):
        sizes = self.browser.run("return [...document.querySelectorAll('.pictures img')]"
                                 ".map((one) => one.complete && one.naturalWidth)")
        self.assertGreaterEqual(len(sizes), 2)
        self.assertTrue(all(width == 640 for width in sizes), sizes)

    def test_page_is_dark_where_screens_are(self):
        colours = []
        for scheme in ("light", "dark"):
            self.browser.emulate("setEmulatedMedia", features=[
                {"name": "prefers-color-scheme", "value": scheme}])
            colours.append(self.browser.run("return getComputedStyle(document.body)"
                                            ".backgroundColor"))
        self.browser.emulate("setEmulatedMedia", features=[])
        light, dark = (sum(map(int, re.findall(r"\d+", colour)[:3])) for colour in colours)
        self.assertGreater(light, 600)  # of 765
        self.assertLess(dark, 150)

    def test_page_is_no_wider_than_a_small_screen(self):
        self.browser.emulate("setDeviceMetricsOverride", width=400, height=800,
                             deviceScaleFactor=1, mobile=True)
        widths = self.browser.run("return [document.documentElement.scrollWidth, innerWidth]")
        self.browser.emulate("clearDeviceMetricsOverride")
        self.assertEqual(widths, [400, 400])


if __name__ == "__main__":
    absent = webdriver.missing()
    if absent:
        print(f"SKIPPED: not installed: {', '.join(absent)}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
