"""Decodes vehicle telemetry with a dialect that pymavlink's own generator created from the official XML. No message may
be unknown."""

import time

from pymavlink import mavutil

import asking
import dialect
import spandrel

# Wall seconds of telemetry, several times as many in vehicle time.
LISTEN_S = 3
# Messages that PyPI's pymavlink does not contain.
ASKED = {397: "COMPONENT_METADATA", 435: "AVAILABLE_MODES", 440: "ILLUMINATOR_STATUS"}


def test_wire_official_dialect_decodes_all_messages(tmp_path):
    """Every frame has a known message, and messages requested by number arrive under their official name."""
    usual = mavutil.current_dialect
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port)
    try:
        link = asking.connect(port, dialect=dialect.generate(tmp_path))
        heard, end = set(), time.monotonic() + LISTEN_S
        while time.monotonic() < end:
            message = link.recv_match(blocking=True, timeout=1)
            heard.add(message.get_type() if message else "HEARTBEAT")
        assert len(heard) > 20 and not [name for name in heard if name.startswith(("UNKNOWN", "BAD"))], heard
        for number, name in ASKED.items():
            asking.message(link, number, name, param=1 if number == 435 else 0)
    finally:
        mavutil.set_dialect(usual)
        spandrel.end(process)
