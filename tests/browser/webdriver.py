"""Drives Chromium by the WebDriver protocol, with nothing but Python's library."""

import base64
import json
import shutil
import struct
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
import zlib

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of an element in the protocol


def missing():
    """The programs that are not there."""
    return [name for name in ("chromium", "chromedriver") if not shutil.which(name)]


class Browser:
    """Chromium without a window and with an empty profile; `with Browser() as browser`."""

    def __init__(self, width=1100, height=900):
        self.profile = tempfile.mkdtemp(prefix="softforce_chromium_")
        # Whatever proxy the environment names is not asked for this machine.
        self.opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        self.driver = subprocess.Popen(
            ["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            text=True)
        self.address = f"http://127.0.0.1:{self._port()}"
        # Without a graphics card WebGL is computed by the processor.
        arguments = [
            "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync",
            "--disable-dev-shm-usage", "--force-color-profile=srgb",
            f"--user-data-dir={self.profile}", f"--window-size={width},{height}"]
        session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": arguments},
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        }}})
        self.session = f"/session/{session['sessionId']}"

    def _port(self):
        for line in self.driver.stdout:
            if "started successfully on port" in line:
                return int(line.rsplit(" ", 1)[1].strip(". \n"))
        raise RuntimeError("chromedriver ended")

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(
            self.address + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with self.opener.open(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", self.session)
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.driver.stdout.close()
            shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, url):
        self._call("POST", self.session + "/url", {"url": url})

    def run(self, script, *arguments):
        """What a script returns, whose body is `script`."""
        return self._call("POST", self.session + "/execute/sync",
                          {"script": script, "args": list(arguments)})

    def wait(self, script, seconds=20):
        """Until a script returns something true, which is returned."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = self.run(script)
            if value:
                return value
            time.sleep(0.05)
        raise RuntimeError(f"in {seconds} s this did not become true: {script}")

    def emulate(self, what, **values):
        """A setting of Chromium's domain Emulation."""
        self._call("POST", self.session + "/goog/cdp/execute",
                   {"cmd": "Emulation." + what, "params": values})

    def element(self, selector):
        return self._call("POST", self.session + "/element",
                          {"using": "css selector", "value": selector})

    def click(self, selector):
        self._call("POST", f"{self.session}/element/{self.element(selector)[ELEMENT]}/click", {})

    def point_at(self, selector, x=0, y=0, drag=None):
        """Moves the pointer to pixels off an element's middle; with `drag` pulls it on so far."""
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        steps = [{"type": "pointerMove", "duration": 0, "origin": self.element(selector),
                  "x": x, "y": y}]
        if drag:
            steps += [{"type": "pointerDown", "button": 0},
                      {"type": "pointerMove", "duration": 100, "origin": "pointer",
                       "x": drag[0], "y": drag[1]},
                      {"type": "pointerUp", "button": 0}]
        self._call("POST", self.session + "/actions", {"actions": [
            {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
             "actions": steps}]})

    def picture(self, selector):
        """An element as it is on the screen, in the middle of it."""
        self.run(f"document.querySelector({selector!r}).scrollIntoView({{block: 'center'}})")
        number = self.element(selector)[ELEMENT]
        return Picture(base64.b64decode(
            self._call("GET", f"{self.session}/element/{number}/screenshot")))

    def drawn(self, selector, seconds=20):
        """An element once something is to be seen of it: a busy machine draws late."""
        end = time.monotonic() + seconds
        while True:
            picture = self.picture(selector)
            # Shaded surface, markers, arrows; a blank canvas has one colour.
            if picture.colours() > 100:
                return picture
            if time.monotonic() > end:
                raise RuntimeError(f"{selector} still has {picture.colours()} colours "
                                   f"after {seconds} s")
            time.sleep(0.2)

    def log(self, kind):
        """What came since the last call: of "browser" the console, of "performance" events."""
        return self._call("POST", self.session + "/se/log", {"type": kind})

    def errors(self):
        return [entry["message"] for entry in self.log("browser") if entry["level"] == "SEVERE"]

    def requests(self, page):
        """The addresses that a page asked for."""
        events = (json.loads(entry["message"])["message"] for entry in self.log("performance"))
        return [event["params"]["request"]["url"] for event in events
                if event["method"] == "Network.requestWillBeSent" and
                event["params"]["documentURL"] == page]


class Picture:
    """The pixels of a PNG of 8 bits, RGB or RGBA."""

    def __init__(self, png):
        self.png = png
        self.width, self.height, depth, colour = struct.unpack(">IIBB", png[16:26])
        if depth != 8 or colour not in (2, 6):
            raise ValueError(f"PNG of {depth} bits and colour type {colour}")
        self.channels = 3 if colour == 2 else 4
        packed, at = b"", 8
        while at < len(png):
            length, kind = struct.unpack(">I4s", png[at:at + 8])
            if kind == b"IDAT":
                packed += png[at + 8:at + 8 + length]
            at += 12 + length
        self.rows = self._unfilter(zlib.decompress(packed))

    def _unfilter(self, raw):
        stride, step = self.width * self.channels, self.channels
        rows, above = [], bytearray(stride)
        for y in range(self.height):
            start = y * (stride + 1)
            rule, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
            for i in range(stride if rule else 0):
                left = row[i - step] if i >= step else 0
                corner = above[i - step] if i >= step else 0
                if rule == 1:
                    guess = left
                elif rule == 2:
                    guess = above[i]
                elif rule == 3:
                    guess = (left + above[i]) // 2
                else:
                    guess = min((left, above[i], corner),
                                key=lambda p, t=left + above[i] - corner: abs(t - p))
                row[i] = (row[i] + guess) & 255
            rows.append(row)
            above = row
        return rows

    def at(self, x, y):
        return tuple(self.rows[y][x * self.channels:x * self.channels + 3])

    def colours(self):
        """How many different ones there are."""
        return len({self.at(x, y) for y in range(0, self.height, 2)
                    for x in range(0, self.width, 2)})
