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
JPEG = "-c:v mjpeg -q:v 3"
H264 = "-c:v libx264 -preset ultrafast -tune zerolatency -crf 18 -g 30 -pix_fmt yuv420p"
MATROSKA = "-f matroska -live 1 -cluster_time_limit 1"
# Options of ffmpeg, by the name that --transport takes.
TRANSPORTS = {
    "mjpeg": f"{JPEG} -f mjpeg",  # no time stamps
    "http": f"{JPEG} -f mjpeg",  # from there on by serve_http, multipart, as network cameras give it; no time stamps
    "matroska": f"{JPEG} {MATROSKA}",  # with time stamps
    # From there on by serve_rtsp. RTP knows JPEG with the usual tables and without 4:4:4 only.
    "rtsp": f"{JPEG} -pix_fmt yuvj420p -huffman default -f rtp",
    "rtsp-h264": f"{H264} -f rtp",
}
PYTHON = "/usr/bin/python3"  # Debian's, which has its packages


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
        self.port = self.tcp_port = free_port()
        # Else the end of a picture waits for the next one (Nagle), and pictures come two by two.
        where = f"tcp://127.0.0.1:{self.tcp_port}?listen=1&tcp_nodelay=1"
        self.url = f"tcp://127.0.0.1:{self.port}"
        self.server = None
        self.rtp = transport.startswith("rtsp")
        if transport == "http":
            self.port = free_port()
            self.url = f"http://127.0.0.1:{self.port}/camera"
            self.server = f"exec {PYTHON} '{ROOT}/benchmarks/live/serve_http' --port {self.port} --source {self.tcp_port}"
        if self.rtp:
            self.port = free_port()
            where = f"rtp://127.0.0.1:{self.tcp_port}"
            self.url = f"rtsp://127.0.0.1:{self.port}/camera"
            self.server = (f"exec {PYTHON} '{ROOT}/benchmarks/live/serve_rtsp' --port {self.port} --source {self.tcp_port} "
                           f"--codec {'h264' if transport == 'rtsp-h264' else 'jpeg'}")
        self.command = (
            f"exec '{BUILD}/tests/vision/paint_frames' {width} {height} {RATE} | "
            "exec ffmpeg -nostdin -loglevel error -probesize 32 -analyzeduration 0 -f nut -i - "
            f"-fps_mode passthrough -threads 1 -flush_packets 1 {TRANSPORTS[transport]} '{where}' 2>/dev/null")
        self.processes = []

    @property
    def source(self):
        return f"{self.name}={self.url}"

    def start(self):
        commands = [self.command] + ([self.server] if self.server else [])
        self.processes = [subprocess.Popen(["sh", "-c", command], start_new_session=True, stdout=subprocess.DEVNULL)
                          for command in commands]

    def wait_until_it_listens(self):
        for _ in range(200):
            if listens(self.port) and (self.rtp or listens(self.tcp_port)):
                return
            time.sleep(0.05)
        raise SystemExit(f"camera {self.name} is not served")

    def kill(self):
        for process in self.processes:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()


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
