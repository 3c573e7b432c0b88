"""A short part of the table in docs/bad-link.md; `bad_link.py` measures all of it."""

import pytest

import bad_link
import relay

# Tasks that their clients finish at this loss but for a chance of less than one in a thousand (their own retries, docs/bad-link.md).
SURE = [
    ("Mission of 200 items, upload", relay.LOSS_10),
    ("All parameters", relay.LOSS_30),
    ("FTP, 50 kB, burst", relay.LOSS_30),
    ("FTP, 50 kB, MAVProxy", relay.LOSS_10),
    ("Log of 50 kB", relay.LOSS_10),
]


@pytest.mark.timeout(600)
@pytest.mark.parametrize(("name", "link"), SURE)
def test_wire_stock_clients_finish_over_a_bad_link(name, link, measured):
    """MAVSDK and MAVProxy behind a relay that loses datagrams, each way, from a seed."""
    measured(f"{name}, {link.name}: {bad_link.run(name, link, 1):.1f} s")
