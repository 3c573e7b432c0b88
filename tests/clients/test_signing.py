"""pymavlink with and without the vehicle's signing key."""

import hashlib
import time

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

import spandrel

PASSPHRASE = "bridge over water"
# Wall seconds to wait for an answer that must not come; answers come within milliseconds.
SILENCE_S = 1.0


@pytest.fixture
def vehicle(tmp_path):
    """A simulator that demands signatures, and its port."""
    key = tmp_path / "key"
    key.write_text(PASSPHRASE + "\n", encoding="utf-8")
    key.chmod(0o600)
    port = spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, port, "--signing-key", str(key))
    yield port
    spandrel.end(process)


def acknowledged(link):
    """Whether a command is answered."""
    link.mav.command_long_send(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, mavlink.MAVLINK_MSG_ID_HEARTBEAT, 0, 0, 0, 0, 0, 0)
    return link.recv_match(type="COMMAND_ACK", blocking=True, timeout=SILENCE_S) is not None


@pytest.mark.timeout(120)
def test_wire_pymavlink_is_obeyed_only_with_the_key(vehicle):
    """Unsigned, signed with another key, signed with the key; and what the vehicle says bears good signatures."""
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{vehicle}", dialect="common", source_system=255)
    assert link.wait_heartbeat(timeout=60)
    assert not acknowledged(link)
    link.setup_signing(hashlib.sha256(b"another bridge").digest(), sign_outgoing=True)
    link.mav.signing.timestamp = int((time.time() - 1420070400) * 1e5)
    assert not acknowledged(link)
    link.setup_signing(hashlib.sha256(PASSPHRASE.encode()).digest(), sign_outgoing=True)
    assert acknowledged(link)
    for _ in range(200):
        message = link.recv_match(blocking=True, timeout=10)
        assert message is not None
        # pymavlink does not verify what its dialect does not know.
        assert message.get_type().startswith("UNKNOWN") or message.get_signed(), message
    link.close()
