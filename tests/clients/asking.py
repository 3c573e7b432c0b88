"""Helpers for pymavlink scripts. UDP may lose datagrams on a busy machine, so every request is repeated until a
response arrives."""

import os
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

# Time limit for a response from a simulator on a busy machine, wall seconds (ten times the usual time).
LIMIT_S = 120
# Wall seconds after which a request is repeated; responses usually arrive within milliseconds.
AGAIN_S = 2.0
# Maximum number of repetitions.
TIMES = int(LIMIT_S / AGAIN_S)


class Repeater:
    """Sends a message immediately, and repeats it as long as `if_due` is called."""

    def __init__(self, say, again_s=AGAIN_S):
        self.say, self.again_s, self.at = say, again_s, 0.0

    def if_due(self):
        """Sends the message again if the interval has passed."""
        if time.monotonic() > self.at:
            self.at = time.monotonic() + self.again_s
            self.say()


def connect(port, system=255, kind="udpin", dialect="all"):
    """Opens a pymavlink link and waits for the first heartbeat. The dialect is global to the process, so each test sets
    its own."""
    link = mavutil.mavlink_connection(f"{kind}:127.0.0.1:{port}", source_system=system, source_component=190, dialect=dialect)
    assert link.wait_heartbeat(timeout=LIMIT_S) is not None, "no heartbeat"
    return link


def receive(link, kinds, fits=lambda message: True, limit_s=LIMIT_S):
    """Returns the next message of these kinds that `fits` accepts."""
    end = time.monotonic() + limit_s
    while (left := end - time.monotonic()) > 0:
        message = link.recv_match(type=kinds, blocking=True, timeout=left)
        if message is not None and fits(message):
            return message
    raise AssertionError(f"no {kinds} within {limit_s} s")


def ask(link, send, kinds, fits=lambda message: True, again_s=AGAIN_S):
    """Repeats a request until a matching response arrives, and returns the response."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        send()
        try:
            return receive(link, kinds, fits, again_s)
        except AssertionError:
            pass
    raise AssertionError(f"no {kinds} within {LIMIT_S} s, requested every {again_s} s")


def command(link, number, *params, system=1, component=1):
    """Sends a command and returns its result."""
    values = (list(params) + [0] * 7)[:7]
    send = lambda: link.mav.command_long_send(system, component, number, 0, *values)  # noqa: E731
    return ask(link, send, "COMMAND_ACK", lambda ack: ack.command == number and ack.get_srcSystem() == system).result


def message(link, number, kind, fits=lambda message: True, param=0):
    """Requests a message by its number and returns it."""
    send = lambda: link.mav.command_long_send(1, 1, mavutil.mavlink.MAV_CMD_REQUEST_MESSAGE, 0, number, param, 0, 0, 0, 0, 0)  # noqa: E731
    return ask(link, send, kind, fits)


def parameters(link):
    """Returns the PARAM_VALUE of every parameter, by name. Requests values missing from the list by index."""
    found = {}
    first = ask(link, lambda: link.mav.param_request_list_send(1, 1), "PARAM_VALUE", lambda m: m.param_index < m.param_count)
    found[first.param_index] = first
    while len(found) < first.param_count:
        value = link.recv_match(type="PARAM_VALUE", blocking=True, timeout=AGAIN_S)
        if value is None:
            missing = next(k for k in range(first.param_count) if k not in found)
            send = lambda: link.mav.param_request_read_send(1, 1, b"", missing)  # noqa: B023, E731
            value = ask(link, send, "PARAM_VALUE", lambda m: m.param_index == missing)  # noqa: B023
        if value.param_index < first.param_count:
            found[value.param_index] = value
    return {value.param_id: value for value in found.values()}
