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

# Wall time for the window to notice the loss and for the words to end, s (ten times the usual).
SPEECH_LIMIT_S = 100
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
# Length of the pieces in which the words are recognized, s: longer than a vowel's period, shorter than the audio buffer, because a busy machine
# interrupts the playback for the length of a buffer.
PIECE_S = 0.05
# Median correlation of the pieces with the recording. Other words of the same voice have about 0.6 at most, because they share vowels.
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


def pieces(words):
    """Returns the louder pieces of words."""
    size = int(PIECE_S * RATE_HZ)
    cut = [words[k : k + size] for k in range(0, len(words) - size, size)]
    return [piece for piece in cut if (piece**2).mean() > (words**2).mean() / 4]


def correlation(recorded, piece):
    """Returns the largest correlation coefficient of a piece with a part of the recording."""
    size = len(recorded) + len(piece)
    products = numpy.fft.irfft(numpy.fft.rfft(recorded, size) * numpy.conj(numpy.fft.rfft(piece, size)), size)[: len(recorded) - len(piece) + 1]
    sums = numpy.concatenate([[0.0], numpy.cumsum(recorded**2)])
    energies = sums[len(piece) :] - sums[: -len(piece)]
    return (products / numpy.sqrt(numpy.maximum(energies, 0.01 * energies.max()))).max() / numpy.sqrt((piece**2).sum())


def likeness(recorded, words):
    """Returns the median correlation of the pieces of words with the recording; 0 for a recording that is silent or shorter than a piece."""
    cut = pieces(words)
    return numpy.median([correlation(recorded, piece) for piece in cut]) if len(recorded) > len(cut[0]) else 0.0


def heard(recording):
    """Returns the recording without the silence before and after the sound."""
    data = recording.read_bytes()
    samples = numpy.frombuffer(data[: len(data) // 2 * 2], dtype="<i2").astype(float)
    (sounds,) = numpy.nonzero(samples)
    return samples[sounds[0] : sounds[-1] + 1] if len(sounds) else samples[:0]


@pytest.mark.timeout(900)
def test_wire_a_warning_is_spoken(screen, speakers, tmp_path):  # noqa: F811
    """When the simulator ends, the window says so in the voice of espeak-ng."""
    keys = tmp_path / "keys.toml"
    keys.write_text(KEYS, encoding="utf-8")
    watcher, payload = spandrel.free_udp_port(), spandrel.free_udp_port()
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, payload_port=payload)
    window = None
    recorded = lambda: heard(speakers.recording)  # noqa: E731
    try:
        window, _ = open_view(screen, tmp_path, "--connect", f"127.0.0.1:{payload}", "--keys", str(keys), environment=speakers.environment())
        asking.connect(watcher)
        spandrel.wait_for("a picture of the flight", lambda: screenshot_with_hud(screen), DRAW_LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        assert len(recorded()) == 0, "there is nothing to say yet"
        spandrel.end(sim)
        words = synthesized(WORDS)
        spandrel.wait_for("the words", lambda: likeness(recorded(), words) > MIN_CORRELATION, SPEECH_LIMIT_S, pause_s=spandrel.LOOK_PAUSE_S)
        assert likeness(recorded(), synthesized("Too fast")) < MIN_CORRELATION, "other words must differ"
    finally:
        for process in filter(None, (window, sim)):
            spandrel.end(process)
