"""A small part of the table in docs/src/measured/bad-link.md; `bad_link.py` measures all of it."""

import pytest

import bad_link
import px4
import relay

# Tasks that succeed at this loss with a probability of more than 99.9% (because of the clients' own retries,
# docs/src/measured/bad-link.md).
RELIABLE_TASKS = [
    ("Upload of a 200-item mission", relay.LOSS_10),
    ("Download of all parameters", relay.LOSS_30),
    ("FTP download of 50 kB, burst reads", relay.LOSS_30),
    ("FTP download of 50 kB, MAVProxy", relay.LOSS_10),
    ("Download of a 50 kB log", relay.LOSS_10),
]


@pytest.mark.timeout(600)
@pytest.mark.parametrize(("name", "link"), RELIABLE_TASKS)
def test_wire_stock_clients_succeed_over_a_bad_link(name, link, measured):
    """Runs MAVSDK and MAVProxy behind a relay that loses datagrams in both directions, reproducibly from a seed."""
    measured(f"{name}, {link.name}: {bad_link.run(name, link, 1):.1f} s")


@pytest.mark.skipif(not px4.BUILD, reason="SPANDREL_PX4 is not set to the build folder of a PX4")
@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    "name",
    [
        "Upload of a 200-item mission",
        "Download of all parameters",
        "FTP download of 50 kB, burst reads",
        "Download of a 50 kB log",
    ],
)
def test_wire_stock_clients_succeed_with_a_real_px4(name, measured):
    """Basis of the comparison in docs/src/measured/bad-link.md: without losses, the clients succeed with both
    vehicles."""
    measured(f"{name}, PX4 {px4.version()}: {bad_link.run(name, relay.CLEAN, 1, bad_link.PX4):.1f} s")
