"""Cameras that ffmpeg serves over loopback, and the recorder that takes them. See README.md."""
import json
import os
import resource
import signal
import socket
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "release"
RATE = 30  # Hz
# Container and options of ffmpeg, by the name that --transport takes.
TRANSPORTS = {
    "mjpeg": "-f mjpeg",  # no time stamps
    "matroska": "-f matroska -live 1 -cluster_time_limit 1",  # with time stamps
}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def listens(port):
    wanted = f"0100007F:{port:04X} 00000000:0000 0A"
    return wanted in Path("/proc/net/tcp").read_text()


class Camera:
    """Picture n is taken at n / RATE on the computer's clock and carries the number n."""

    def __init__(self, name, width, height, transport="mjpeg"):
        self.name = name
        self.port = free_port()
        self.command = (
            f"exec '{BUILD}/tests/vision/paint_frames' {width} {height} {RATE} | "
            "exec ffmpeg -nostdin -loglevel error -probesize 32 -analyzeduration 0 -f nut -i - "
            f"-fps_mode passthrough -threads 1 -flush_packets 1 -c:v mjpeg -q:v 3 {TRANSPORTS[transport]} "
            f"'tcp://127.0.0.1:{self.port}?listen=1' 2>/dev/null")
        self.process = None

    @property
    def source(self):
        return f"{self.name}=tcp://127.0.0.1:{self.port}"

    def start(self):
        self.process = subprocess.Popen(["sh", "-c", self.command], start_new_session=True)

    def wait_until_it_listens(self):
        for _ in range(200):
            if listens(self.port):
                return
            time.sleep(0.05)
        raise SystemExit(f"camera {self.name} is not served")

    def kill(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


def start_recorder(cameras, folder, *options):
    command = [BUILD / "apps" / "softforce", "record", "--out", folder, *options]
    for camera in cameras:
        command += ["--camera", camera.source]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def start_feeder(folder, width, height):
    return subprocess.Popen([BUILD / "benchmarks" / "feed_recorder", folder, str(width), str(height), str(RATE)])


def check(folder, width, height):
    found = subprocess.run([BUILD / "benchmarks" / "check_recording", folder, str(width), str(height), str(RATE)],
                           capture_output=True, text=True, check=False)
    if found.returncode != 0:
        return {"error": found.stderr.strip()}
    return json.loads(found.stdout)


def cpu_seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
