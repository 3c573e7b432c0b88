"""A pymavlink connection that runs on simulation time."""

from __future__ import annotations

import os
import socket
from collections import deque
from typing import TYPE_CHECKING, Any

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402

if TYPE_CHECKING:
    from .vehicle import Vehicle

POLL_INTERVAL_S = 0.02
"""Polling interval of a blocking read, s of simulation time."""


class LockstepConnection(mavutil.mavudp):  # type: ignore[misc]
    """A `mavutil` connection over loopback UDP that replies to the vehicle's TIMESYNC requests and waits in simulation time."""

    def __init__(self, vehicle: Vehicle) -> None:
        super().__init__("127.0.0.1:0", input=False)
        self.port.bind(("127.0.0.1", 0))
        self._vehicle = vehicle
        self._pending: deque[Any] = deque()

    @property
    def endpoint(self) -> tuple[str, int]:
        """Host and port that the vehicle sends to."""
        host, port = self.port.getsockname()
        return host, port

    def answer(self) -> bool:
        """Reads all received messages and replies to lockstep requests. Returns True if there was one."""
        answered = False
        while (message := self._read()) is not None:
            if message.get_type() == "TIMESYNC" and message.tc1 == 0:
                self.mav.timesync_send(message.ts1, message.ts1)
                answered = True
            # Requests stay in the stream, because a gap in the sequence numbers would count as packet loss.
            self._pending.append(message)
        return answered

    def _read(self) -> Any:
        try:
            return self.mav.parse_char(self.recv())
        except (socket.error, ValueError):
            # The socket is closed or has no data.
            return None

    def recv_msg(self) -> Any:
        """Returns the next message; None if there is none."""
        self.pre_message()
        self.answer()
        if not self._pending:
            return None
        message = self._pending.popleft()
        self.post_message(message)
        return message

    def recv_match(
        self, condition: Any = None, type: Any = None, blocking: bool = False, timeout: float | None = None
    ) -> Any:
        """Returns the next matching message, as in pymavlink; `timeout` is in seconds of simulation time."""
        limit_s = None if timeout is None else self._vehicle.time_s + timeout
        while True:
            message = super().recv_match(condition, type)
            if message is not None or not blocking:
                return message
            if limit_s is not None and self._vehicle.time_s >= limit_s:
                return None
            self.select(POLL_INTERVAL_S)

    def select(self, timeout: float) -> bool:
        """Advances simulation time instead of waiting."""
        self._vehicle.run_for(timeout)
        return bool(self._pending)
