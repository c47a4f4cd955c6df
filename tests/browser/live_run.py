"""A run of softforce on two cameras that are served over loopback, with its live page."""

import re
import shutil
import signal
import socket
import subprocess
import sys
import time


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


class Cameras:
    """The last ten frames of a dataset, over and over: its weights hang still."""

    def __init__(self, root, folder, rate):
        folder.mkdir(parents=True, exist_ok=True)
        self.processes, self.options = [], []
        epoch = time.time()
        for name in ("left", "right"):
            file, port = folder / f"{name}.mjpeg", free_port()
            subprocess.run(
                ["ffmpeg", "-v", "error", "-y", "-i", root / f"datasets/sheet_two_weights/{name}.mp4",
                 "-vf", "trim=start_frame=20,setpts=PTS-STARTPTS", "-q:v", "3", "-f", "mjpeg", file],
                check=True)
            process = subprocess.Popen(
                [sys.executable, root / "benchmarks/live/serve_mjpeg", file, "--port", str(port),
                 "--rate", str(rate), "--epoch", str(epoch)], stdout=subprocess.PIPE)
            assert process.stdout.readline() == b"ready\n"
            self.processes.append(process)
            self.options += ["--camera", f"{name}=tcp://127.0.0.1:{port}"]

    def close(self):
        for process in self.processes:
            process.kill()
            process.wait()
            process.stdout.close()


class Run:
    """The program, from when it has told where its page is."""

    def __init__(self, program, scene, out, cameras, port=0, more=()):
        shutil.rmtree(out, ignore_errors=True)
        self.out = out
        self.process = subprocess.Popen(
            [program, "run", scene, "--out", out, "--serve", str(port), *cameras.options, *more],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.said = ""
        for line in self.process.stderr:
            self.said += line
            found = re.search(r"(http://127\.0\.0\.1:(\d+)/)#token=([0-9a-f]{32})", line)
            if found:
                self.url, self.port, self.token = found[1], int(found[2]), found[3]
                return
        raise RuntimeError(f"no live page: {self.said}")

    def kill(self):
        self.process.kill()
        self.close()

    def end(self):
        self.process.send_signal(signal.SIGINT)
        return self.close()

    def close(self):
        """Its exit code, when it has ended."""
        self.process.stderr.read()
        self.process.stderr.close()
        return self.process.wait(timeout=60)
