"""The camera view as a stream: decoded with GStreamer's elements, counted, compared with the window, announced by the
vehicle."""

import pathlib
import re
import signal
import socket
import statistics
import subprocess
import threading
import time

import numpy
import pytest
from PIL import Image
from pymavlink import mavutil

import asking
import display
import spandrel

# Number of decoded pictures that prove that the stream is running.
ENOUGH = 10
LIMIT_S = 400
# Maximum picture rate, Hz: the stream has at least 33 ms between pictures.
RATE_MAX_HZ = 30.4
# Maximum median difference from the window's picture, out of 255: coding and color subsampling cause about 2, and waves
# and noise in the meantime some more; a different picture causes over 30.
MAX_DIFFERENCE = 12
# Bytes that are buffered for the decoder while the machine is busy.
BUFFER = 4 << 20


class Relay(threading.Thread):
    """Forwards a stream and records the time of each picture's last packet and missing sequence numbers."""

    def __init__(self, to):
        super().__init__(daemon=True)
        self.to, self.pictures, self.lost, self.next = to, [], 0, None
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]

    def run(self):
        while packet := self.socket.recv(65536):
            number = int.from_bytes(packet[2:4], "big")
            if self.next is not None:
                self.lost += (number - self.next) % 65536
            self.next = (number + 1) % 65536
            if packet[1] & 0x80:
                self.pictures.append(time.monotonic())
            self.socket.sendto(packet, ("127.0.0.1", self.to))

    def close(self):
        """Ends the relay with an empty datagram."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
            own.sendto(b"", ("127.0.0.1", self.port))
        self.join()
        self.socket.close()


class Player:
    """udpsrc, rtph264depay, avdec_h264: stores each picture and the time when it was decoded."""

    def __init__(self, folder, port):
        self.folder, self.decoded = pathlib.Path(folder), []
        caps = "application/x-rtp,media=video,clock-rate=90000,encoding-name=H264,payload=96"
        self.process = subprocess.Popen(
            ["gst-launch-1.0", "-v", "-e", "udpsrc", f"port={port}", "address=127.0.0.1", f"buffer-size={BUFFER}", f"caps={caps}", "!",
             "rtph264depay", "!", "avdec_h264", "max-threads=1", "!", "identity", "silent=false", "name=decoded", "!", "videoconvert", "!",
             "pngenc", "!", "multifilesink", f"location={folder}/seen-%05d.png"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
        )
        self.ready = threading.Event()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            if "decoded: last-message = chain" in line:
                self.decoded.append(time.monotonic())
            elif "PLAYING" in line:
                self.ready.set()

    def picture_files(self):
        """Returns the files of the pictures."""
        return sorted(self.folder.glob("seen-*.png"))

    def close(self):
        """Ends the player after all received data has been decoded and written."""
        spandrel.end(self.process)
        self.reader.join()


def camera(screen):
    """Returns the camera view in the window, which is its right half."""
    photograph = screen.photograph()
    return photograph[:, photograph.shape[1] // 2 :]


def is_similar(file, shown):
    """Returns whether half of the pixels agree; the HUD in the window covers less than that."""
    picture = numpy.asarray(Image.open(file).convert("RGB")).astype(int)
    return picture.shape == shown.shape and numpy.median(numpy.abs(picture - shown).max(axis=2)) < MAX_DIFFERENCE


@pytest.mark.timeout(900)
def test_val_gstreamer_decodes_the_camera_stream(tmp_path, measured):
    """Every encoded picture must be decoded and match the window. The vehicle must announce the start and the end of
    the stream."""
    screen = display.Display(tmp_path, 640, 240)
    watcher, payload, video = (spandrel.free_udp_port() for _ in range(3))
    player, relay = Player(tmp_path, video), Relay(video)
    relay.start()
    assert player.ready.wait(LIMIT_S), "GStreamer did not start"
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, payload_port=payload)
    window = subprocess.Popen(
        [spandrel.COCKPIT, "view", "--scenario", "drill-hover", "--seed", "7", "--size", "640x240", "--connect",
         f"127.0.0.1:{payload}", "--stream", f"127.0.0.1:{relay.port}"],
        stdin=subprocess.DEVNULL, stderr=open(tmp_path / "view.txt", "w", encoding="utf-8"), env=screen.environment(),
    )
    try:
        spandrel.wait_for("decoded pictures", lambda: len(player.picture_files()) > ENOUGH, LIMIT_S)
        spandrel.wait_for("the window's picture", lambda: is_similar(player.picture_files()[-2], camera(screen)), LIMIT_S)
        link = asking.connect(watcher)
        running = lambda m: m.flags & 1 and m.resolution_h == 320 and m.resolution_v == 240  # noqa: E731
        send = lambda: link.mav.command_long_send(1, 100, mavutil.mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 269, 1, 0, 0, 0, 0, 0)  # noqa: E731
        told = asking.ask(link, send, "VIDEO_STREAM_INFORMATION", running)
        assert told.encoding == 1 and 0 < told.framerate <= RATE_MAX_HZ and told.bitrate > 0
        window.send_signal(signal.SIGINT)
        said = (tmp_path / "view.txt").read_text
        assert window.wait(timeout=60) == 0, said(encoding="utf-8")
        stopped = asking.ask(link, send, "VIDEO_STREAM_INFORMATION", lambda m: not m.flags & 1)
        assert stopped.count == 1
        spandrel.wait_for("everything is decoded", lambda: len(player.decoded) >= len(relay.pictures), LIMIT_S)
    finally:
        for process in (window, sim):
            spandrel.end(process)
        relay.close()
        player.close()
        screen.close()
    streamed, encoding_ms = re.search(r"streamed (\d+) frames, average encoding time ([\d.]+) ms", said(encoding="utf-8")).groups()
    streamed, encoding_ms = int(streamed), float(encoding_ms)
    assert relay.lost == 0 and len(relay.pictures) == streamed, "every encoded picture must be sent"
    assert len(player.decoded) == streamed, "every picture must be decoded"
    latency_ms = [1e3 * (decoded - sent) for sent, decoded in zip(relay.pictures, player.decoded)]
    assert min(latency_ms) > 0, "pictures must be decoded after they were sent"
    decoding_ms = statistics.median(latency_ms)
    measured(f"{streamed} pictures of 320 x 240; from a drawn picture to a decoded one {encoding_ms + decoding_ms:.1f} ms: "
             f"{encoding_ms:.1f} in the encoder (mean), {decoding_ms:.1f} from its last packet to the decoder's picture (median)")
