"""`softforce run --view` on a virtual display, with keys pressed as a person would.

view_test.py PROGRAM ROOT FOLDER, as ctest calls it; ends with 77 if there is no virtual display.
The tests build on each other, in the order of their names.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

PROGRAM, ROOT, FOLDER = (pathlib.Path(argument) for argument in sys.argv[1:4])
sys.path.insert(0, str(ROOT / "tests/browser"))

from live_run import Cameras  # noqa: E402

SCENE = ROOT / "datasets/sheet_two_weights/scene.yaml"
PATIENCE_S = 60


def environment(display=None):
    names = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    variables = {name: value for name, value in os.environ.items() if name not in names}
    return variables if display is None else {**variables, "DISPLAY": display}


class Screen:
    def __init__(self):
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1000x24", "-nolisten", "tcp"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.display = ":" + number.readline().strip()

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *arguments], env=environment(self.display),
                              capture_output=True, text=True, check=False).stdout.split()

    def close(self):
        self.process.terminate()
        self.process.wait()


def wait(condition):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.1)
    raise AssertionError("waited for nothing")


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        cls.screen = Screen()
        cls.cameras = Cameras(ROOT, FOLDER / "cameras", rate=10)
        cls.out = FOLDER / "out"
        cls.process = subprocess.Popen(
            [PROGRAM, "run", SCENE, "--view", "--out", cls.out, "--no-overlay", "--no-report",
             *cls.cameras.options], env=environment(cls.screen.display),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.window = wait(lambda: cls.screen.tool("search", "--name", "^softforce: "))[0]

    @classmethod
    def tearDownClass(cls):
        if cls.process.poll() is None:
            cls.process.kill()
            cls.process.wait()
        cls.cameras.close()
        cls.screen.close()

    def press(self, key):
        self.screen.tool("windowfocus", "--sync", self.window)
        self.screen.tool("key", key)

    def rows(self, table="forces.csv"):
        file = self.out / (table if self.process.poll() is not None else
                           table.replace(".csv", ".partial.csv"))
        if not file.exists():
            return []
        with open(file, newline="") as lines:
            return [row for row in csv.DictReader(lines) if None not in row.values()]

    def test_1_is_as_wide_as_its_pictures(self):
        wait(lambda: len(self.rows()) > 5)
        size = wait(lambda: [line for line in self.screen.tool(
            "getwindowgeometry", "--shell", self.window) if line == "WIDTH=1280"])
        self.assertEqual(size, ["WIDTH=1280"])

    def test_2_s_writes_what_is_shown(self):
        self.press("s")
        shot = wait(lambda: next(self.out.glob("screenshot-1.png"), None))
        wait(lambda: shot.stat().st_size > 50_000)  # bytes: pictures, not a blank page

    def test_3_t_makes_the_forces_at_hand_zero(self):
        self.assertGreater(float(self.rows()[-1]["norm_N"]), 0.2)  # the weights hang still
        self.press("t")
        wait(lambda: float(self.rows()[-1]["norm_N"]) < 0.1)  # N; noise alone

    def test_4_p_pauses_and_goes_on(self):
        self.press("p")
        time.sleep(2)  # frames at work come to their end
        standing = len(self.rows())
        time.sleep(1)
        self.assertEqual(len(self.rows()), standing)
        self.press("p")
        wait(lambda: len(self.rows()) > standing)

    def test_5_r_records_until_it_is_pressed_again(self):
        self.press("r")
        wait(lambda: list(self.out.glob("recording-1/*")))
        self.press("r")

    def test_6_q_ends_the_run_with_complete_files(self):
        self.press("q")
        self.assertEqual(self.process.wait(PATIENCE_S), 0)
        self.assertGreater(len(self.rows()), 10)
        self.assertTrue((self.out / "summary.json").exists())

    def test_7_is_refused_where_there_is_no_screen(self):
        out = FOLDER / "refused"
        for display in (None, ":9999"):
            run = subprocess.run([PROGRAM, "run", SCENE, "--view", "--out", out],
                                 env=environment(display), capture_output=True, text=True,
                                 check=False)
            self.assertEqual(run.returncode, 2)
            self.assertIn("--view: ", run.stderr)
            self.assertIn("--serve", run.stderr)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        print("skipped: Xvfb or xdotool is missing")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
