"""A UDP relay between a vehicle and its client that loses, duplicates and reorders datagrams in both directions,
reproducibly from a seed."""

import dataclasses
import heapq
import random
import select
import socket
import threading
import time

# Minimum and maximum delay of a reordered datagram, wall seconds; later datagrams overtake it (estimate: Wi-Fi
# retransmissions).
REORDER_DELAY_S = (0.005, 0.05)
# Interval for checking whether to stop, wall seconds.
LOOK_S = 0.1


@dataclasses.dataclass(frozen=True)
class Link:
    """Impairments in each direction, as fractions from 0 to 1."""

    name: str
    loss: float = 0.0
    duplicates: float = 0.0
    reordered: float = 0.0


CLEAN = Link("clean")
LOSS_10 = Link("10% loss", loss=0.10)
LOSS_30 = Link("30% loss", loss=0.30)
LOSS_15 = Link("15% loss", loss=0.15)
ROUGH = Link("15% loss, duplicates, reordering", loss=0.15, duplicates=0.10, reordered=0.10)
LINKS = (CLEAN, LOSS_10, LOSS_30, ROUGH)


class Relay:
    """A relay; the vehicle connects to `port`, the client listens on `client_port`."""

    def __init__(self, client_port, link, seed):
        self.link, self.random = link, random.Random(f"{link.name} {seed}")
        self.vehicle_side, self.client_side = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        for side in (self.vehicle_side, self.client_side):
            side.bind(("127.0.0.1", 0))
            side.setblocking(False)
        self.port = self.vehicle_side.getsockname()[1]
        self.client, self.vehicle = ("127.0.0.1", client_port), None
        self.passed, self.lost, self.late, self.ends = 0, 0, [], False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        while not self.ends:
            wait = min(LOOK_S, max(self.late[0][0] - time.monotonic(), 0.0)) if self.late else LOOK_S
            for side in select.select([self.vehicle_side, self.client_side], [], [], wait)[0]:
                self._take(side)
            while self.late and self.late[0][0] <= time.monotonic():
                _, _, side, datagram = heapq.heappop(self.late)
                self._send(side, datagram)

    def _take(self, side):
        try:
            datagram, sender = side.recvfrom(65_536)
        except OSError:
            return
        if side is self.vehicle_side:
            self.vehicle = sender
        onward = self.client_side if side is self.vehicle_side else self.vehicle_side
        if self.random.random() < self.link.loss:
            self.lost += 1
            return
        for _ in range(2 if self.random.random() < self.link.duplicates else 1):
            if self.random.random() < self.link.reordered:
                due = time.monotonic() + self.random.uniform(*REORDER_DELAY_S)
                heapq.heappush(self.late, (due, self.passed, onward, datagram))
            else:
                self._send(onward, datagram)
            self.passed += 1

    def _send(self, side, datagram):
        to = self.client if side is self.client_side else self.vehicle
        if to is not None:
            try:
                side.sendto(datagram, to)
            except OSError:
                pass

    def close(self):
        """Stops the relay."""
        self.ends = True
        self.thread.join()
        for side in (self.vehicle_side, self.client_side):
            side.close()
