"""The camera's view as a stream: decoded by GStreamer's own elements, announced by the vehicle."""

import signal
import subprocess
import time

import pytest
from PIL import Image
from pymavlink import mavutil

import asking
import display
import spandrel

# Decoded pictures that prove that the stream runs.
ENOUGH = 10
LIMIT_S = 400


@pytest.mark.timeout(900)
def test_val_gstreamer_shows_what_the_camera_sees(tmp_path):
    """udpsrc, rtph264depay, avdec_h264: pictures come, are no single grey, and the vehicle tells that the stream runs."""
    screen = display.Display(tmp_path)
    watcher, payload, video = (spandrel.free_udp_port() for _ in range(3))
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, payload_port=payload)
    caps = "application/x-rtp,media=video,clock-rate=90000,encoding-name=H264,payload=96"
    player = subprocess.Popen(
        ["gst-launch-1.0", "-e", "udpsrc", f"port={video}", f"caps={caps}", "!", "rtph264depay", "!", "avdec_h264", "!", "videoconvert",
         "!", "jpegenc", "!", "multifilesink", f"location={tmp_path}/seen-%05d.jpg"],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
    )
    window = None
    try:
        window = subprocess.Popen(
            [spandrel.PROGRAM, "view", "--scenario", "drill-hover", "--seed", "7", "--size", "640x240", "--connect",
             f"127.0.0.1:{payload}", "--stream", f"127.0.0.1:{video}"],
            stdin=subprocess.DEVNULL, stderr=open(tmp_path / "view.txt", "w", encoding="utf-8"), env=screen.environment(),
        )
        seen = lambda: sorted(tmp_path.glob("seen-*.jpg"))  # noqa: E731
        spandrel.wait_for("decoded pictures", lambda: len(seen()) >= ENOUGH, LIMIT_S)
        link = asking.connect(watcher)
        running = lambda m: m.flags & 1 and m.resolution_h == 320 and m.resolution_v == 240  # noqa: E731
        send = lambda: link.mav.command_long_send(1, 100, mavutil.mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 269, 1, 0, 0, 0, 0, 0)  # noqa: E731
        told = asking.ask(link, send, "VIDEO_STREAM_INFORMATION", running)
        assert told.uri.rstrip("\0") == "5600" and told.encoding == 1
        picture = Image.open(seen()[ENOUGH - 2])
        assert picture.size == (320, 240)
        low, high = picture.convert("L").getextrema()
        assert high - low > 60, "a picture, not one grey"
        window.send_signal(signal.SIGINT)
        assert window.wait(timeout=60) == 0
        stopped = asking.ask(link, send, "VIDEO_STREAM_INFORMATION", lambda m: not m.flags & 1)
        assert stopped.count == 1
    finally:
        for process in filter(None, (window, player, sim)):
            spandrel.end(process)
        screen.close()
