"""The live page of a real run in Firefox: what live_page_test.py looks at in Chromium, in short.

live_page_firefox_test.py PROGRAM ROOT FOLDER, as ctest calls it; ends with 77 without Firefox.
"""

import pathlib
import shutil
import sys
import unittest

from live_run import Cameras, Run
from marionette import Firefox

PROGRAM, ROOT, FOLDER = (pathlib.Path(argument) for argument in sys.argv[1:4])


class LivePageInFirefox(unittest.TestCase):
    def test_shows_a_run_tares_and_tells_how_it_ended(self):
        cameras = Cameras(ROOT, FOLDER / "cameras", rate=10)
        self.addCleanup(cameras.close)
        run = Run(PROGRAM, ROOT / "datasets/sheet_two_weights/scene.yaml", FOLDER / "out", cameras,
                  more=["--no-overlay", "--no-report"])
        self.addCleanup(lambda: run.process.poll() is None and run.kill())
        with Firefox() as browser:
            browser.open(f"{run.url}#token={run.token}")
            browser.wait("return document.getElementById('link').textContent === 'live'")
            browser.wait("return document.getElementById('picture').naturalWidth === 1280")
            line = "return document.querySelector('#forces path.line')?.getAttribute('d')"
            drawn = browser.wait(line)
            browser.wait(f"{line} !== {drawn!r}")
            # The 3-D view, or why there is none: without a graphics card Firefox has no WebGL.
            browser.wait("return document.getElementById('view').dataset.ready === 'yes' ||"
                         "/WebGL|without/.test(document.getElementById('view-caption').textContent)")
            browser.run("document.querySelector('[data-post=tare]').click()")
            browser.wait("return document.getElementById('said').textContent === 'tared'")
            # N; of 0.56: what noise leaves
            browser.wait("return parseFloat(document.querySelector('#cards b').textContent) < 0.1")
            browser.run("document.querySelector('[data-post=stop]').click()")
            browser.wait("return document.getElementById('link').textContent"
                         ".startsWith('run ended')")
        self.assertEqual(run.close(), 0)


if __name__ == "__main__":
    absent = [name for name in ("firefox-esr", "ffmpeg") if not shutil.which(name)]
    if absent:
        print(f"SKIPPED: not installed: {', '.join(absent)}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
