"""Spoken warnings in the window: a speech synthesizer's words leave through the window's own audio output."""

import io
import subprocess
import wave

import numpy
import pytest

import asking
import spandrel
from speakers import RATE_HZ
from test_flow import speakers  # noqa: F401 (fixture)
from test_view import DRAW_LIMIT_S, open_view, screen, screenshot_with_hud  # noqa: F401 (fixture)

# Only words are heard.
KEYS = """
format = 1
[sound]
propellers = false
warnings = false
speech = true
volume = 1.0
"""
# Words for the loss of the link (crates/text/catalog/en/flight.ftl).
WORDS = "Link lost"
# Smallest correlation of the recording with the words: two conversions of the sample rate, which the sound server and the window make, leave more;
# other words of the same voice, less.
MIN_CORRELATION = 0.8


def synthesized(words):
    """Returns the synthesizer's samples of the words, at the rate of the recording."""
    done = subprocess.run(["espeak-ng", "--stdout", "-v", "en", words], capture_output=True, check=True, timeout=spandrel.FLIGHT_LIMIT_S)
    # In a pipe, the length in the head of the file is unknown.
    head, _, data = done.stdout.partition(b"data")
    rate_hz = wave.open(io.BytesIO(head + b"data" + (0).to_bytes(4, "little"))).getframerate()
    samples = numpy.frombuffer(data[4 : 4 + (len(data) - 4) // 2 * 2], dtype="<i2").astype(float)
    times = numpy.arange(int(len(samples) * RATE_HZ / rate_hz)) * rate_hz / RATE_HZ
    return numpy.interp(times, numpy.arange(len(samples)), samples)


def correlation(recorded, words):
    """Returns the largest correlation coefficient of the words with a part of the recording."""
    if len(recorded) < len(words):
        return 0.0
    size = len(recorded) + len(words)
    products = numpy.fft.irfft(numpy.fft.rfft(recorded, size) * numpy.conj(numpy.fft.rfft(words, size)), size)[: len(recorded) - len(words) + 1]
    energies = numpy.convolve(recorded**2, numpy.ones(len(words)), "valid")
    energy = energies.max()
    return 0.0 if energy == 0.0 else float((products / numpy.sqrt(numpy.maximum(energies, 0.01 * energy))).max() / numpy.sqrt((words**2).sum()))


@pytest.mark.timeout(900)
def test_wire_a_warning_is_spoken(screen, speakers, tmp_path):  # noqa: F811
    """When the simulator ends, the window says so in the voice of espeak-ng."""
    keys = tmp_path / "keys.toml"
    keys.write_text(KEYS, encoding="utf-8")
    watcher, payload = spandrel.free_udp_port(), spandrel.free_udp_port()
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, payload_port=payload)
    window = None
    recorded = lambda: numpy.frombuffer((data := speakers.recording.read_bytes())[: len(data) // 2 * 2], dtype="<i2").astype(float)  # noqa: E731
    try:
        window, _ = open_view(screen, tmp_path, "--connect", f"127.0.0.1:{payload}", "--keys", str(keys), environment=speakers.environment())
        asking.connect(watcher)
        spandrel.wait_for("a picture of the flight", lambda: screenshot_with_hud(screen), DRAW_LIMIT_S)
        assert not recorded().any(), "there is nothing to say yet"
        spandrel.end(sim)
        words = synthesized(WORDS)
        spandrel.wait_for("the words", lambda: correlation(recorded(), words) > MIN_CORRELATION, DRAW_LIMIT_S)
        assert correlation(recorded(), synthesized("Video link weak")) < MIN_CORRELATION, "other words must differ"
    finally:
        for process in filter(None, (window, sim)):
            spandrel.end(process)
