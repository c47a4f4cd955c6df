"""Drives Firefox by its own protocol, Marionette, with nothing but Python's library."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time


class Firefox:
    """Firefox without a window and with an empty profile; `with Firefox() as browser`."""

    def __init__(self, width=1100, height=900):
        self.profile = tempfile.mkdtemp(prefix="softforce_firefox_")
        self.count = 0
        with socket.socket() as trial:
            trial.bind(("127.0.0.1", 0))
            port = trial.getsockname()[1]
        pathlib.Path(self.profile, "user.js").write_text(f'user_pref("marionette.port", {port});\n')
        self.process = subprocess.Popen(
            ["firefox-esr", "--headless", "--marionette", "--profile", self.profile,
             "--width", str(width), "--height", str(height)],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self.profile})
        self.socket = self._connect(port)
        self.answers = self.socket.makefile("rb")
        self._receive()
        self._call("WebDriver:NewSession", capabilities={})

    @staticmethod
    def _connect(port):
        end = time.monotonic() + 60
        while True:
            try:
                return socket.create_connection(("127.0.0.1", port))
            except OSError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.1)

    def _receive(self):
        length = b""
        while (byte := self.answers.read(1)) != b":":
            length += byte
        return json.loads(self.answers.read(int(length)))

    def _call(self, command, **values):
        self.count += 1
        message = json.dumps([0, self.count, command, values])
        self.socket.sendall(f"{len(message)}:{message}".encode())
        _, _, error, value = self._receive()
        if error:
            raise RuntimeError(error["message"])
        return value

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.answers.close()
        self.socket.close()
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, url):
        self._call("WebDriver:Navigate", url=url)

    def run(self, script):
        return self._call("WebDriver:ExecuteScript", script=script, args=[])["value"]

    def wait(self, script, seconds=30):
        """Until a script returns something true, which is returned."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = self.run(script)
            if value:
                return value
            time.sleep(0.05)
        raise RuntimeError(f"in {seconds} s this did not become true: {script}")
