"""The vehicle in process."""

from __future__ import annotations

import math
import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ._spandrel import Flight, LateError, RefusedError, SpandrelError, State

if TYPE_CHECKING:
    from .connection import LockstepConnection

NS = 1_000_000_000
TICK_NS = 1_000_000
"""One physics tick, ns."""
LOOK_NS = 20_000_000
"""Conditions are checked, and datagrams exchanged, this often, ns of simulation time."""
ANSWER_NS = NS
"""A command that is not answered within this simulation time was lost, ns."""
RETRY_NS = NS // 2
"""Arming is tried again after this simulation time, ns."""
SERVING_SLEEP_S = 0.002
"""How long the serving thread rests between two looks at the clock, s of wall time."""

ACCEPTED, IN_PROGRESS = 0, 5
ARM_DISARM, TAKEOFF, LAND, REPOSITION, SET_MODE = 400, 22, 21, 192, 176


def _free_port() -> int:
    """A UDP port of the loopback that was free a moment ago."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


class Link:
    """A MAVLink link of your own: datagrams in and out, without a socket."""

    def __init__(self, flight: Flight, number: int) -> None:
        self._flight, self._number = flight, number

    def send(self, datagram: bytes) -> None:
        """Sends MAVLink frames to the vehicle; they act at the next tick."""
        self._flight.send(self._number, datagram)

    def receive(self) -> list[bytes]:
        """Returns the datagrams that the vehicle has sent since the last call, oldest first."""
        return self._flight.take(self._number)

    def close(self) -> None:
        """Closes the link. Raises SpandrelError when it is closed already."""
        self._flight.close(self._number)


class Vehicle:
    """A simulated drone on its pad, motors off.

    `scenario` and `vehicle` are the name of a shipped one (`spandrel.scenarios()`, `spandrel.vehicles()`) or the path of a TOML file.
    `seed` decides gusts, sensor noise, traffic and defects. `flavour` is the autopilot protocol: px4, ardupilot or generic.
    `after_crash` is continue, respawn, end or scenario (the scenario's own rule).

    Simulation time passes only inside `step`, `run_for`, `run_until` and the commands, as fast as the machine allows, or in real time
    while `serve` is active. The same calls give the same bits in every run: compare `digest`.
    """

    def __init__(
        self,
        scenario: str | os.PathLike[str] = "drill-hover",
        vehicle: str | os.PathLike[str] = "phantom2",
        seed: int = 1,
        *,
        flavour: str = "px4",
        after_crash: str = "scenario",
    ) -> None:
        self._flight = Flight(os.fspath(scenario), os.fspath(vehicle), seed, flavour, after_crash)
        self._connections: list[LockstepConnection] = []
        self._server: threading.Thread | None = None
        self._stop = threading.Event()
        self._advanced = threading.Condition()

    @property
    def state(self) -> State:
        """The true state now."""
        return self._flight.state()

    @property
    def time_s(self) -> float:
        """Simulation time, s."""
        return self._flight.now_ns() / NS

    @property
    def digest(self) -> str:
        """SHA-256 over the state of every tick so far, 64 hexadecimal digits."""
        return self._flight.digest()

    def step(self, n: int = 1) -> State:
        """Runs `n` physics ticks of 1 ms and returns the state after them."""
        if n < 0:
            raise ValueError(f"n is {n}; allowed: 0 and more")
        self._advance_to(self._flight.now_ns() + n * TICK_NS)
        return self.state

    def run_for(self, sim_s: float) -> State:
        """Runs for `sim_s` seconds of simulation time and returns the state after them."""
        if not 0.0 <= sim_s < math.inf:
            raise ValueError(f"sim_s is {sim_s}; allowed: 0 and more")
        self._advance_to(self._flight.now_ns() + round(sim_s * NS))
        return self.state

    def run_until(self, condition: Callable[[State], bool], sim_s: float) -> State:
        """Runs until `condition(state)` holds and returns that state.

        The condition is checked every 20 ms of simulation time. Raises LateError when it does not hold within `sim_s` seconds of
        simulation time.
        """
        limit = self._flight.now_ns() + round(sim_s * NS)
        while not condition(state := self.state):
            now = self._flight.now_ns()
            if now >= limit:
                raise LateError(
                    f"the condition did not hold within {sim_s} s of simulation time; the vehicle said: {state.text}"
                )
            self._advance_to(min(limit, now + LOOK_NS))
        return state

    def command(
        self, command: int, *params: float, place_enu_m: tuple[float, float, float] | None = None
    ) -> None:
        """Sends a MAVLink command by its number and waits for the answer.

        With `place_enu_m` it goes as COMMAND_INT at that place of the scenario's frame (east, north, up, m), else as COMMAND_LONG.
        Raises RefusedError when it is refused, or not answered within a second of simulation time.
        """
        self._flight.ask(int(command), list(params), place_enu_m)
        limit = self._flight.now_ns() + ANSWER_NS
        while self._flight.now_ns() < limit:
            self._advance_to(self._flight.now_ns() + TICK_NS)
            answer = self._flight.answer()
            if answer == ACCEPTED:
                return
            if answer is not None and answer != IN_PROGRESS:
                raise self._flight.refusal(answer)
        raise self._flight.refusal(None)

    def arm(self, sim_s: float = 30.0) -> None:
        """Arms as soon as the vehicle allows it. Raises the last RefusedError after `sim_s` seconds of simulation time."""
        limit = self._flight.now_ns() + round(sim_s * NS)
        while True:
            try:
                self.command(ARM_DISARM, 1.0)
            except RefusedError:
                if self._flight.now_ns() >= limit:
                    raise
                self._advance_to(self._flight.now_ns() + RETRY_NS)
            else:
                return

    def take_off(self, height_m: float) -> None:
        """Starts a take-off to a height over the pad, m. Returns when the command is accepted: `run_until` waits for the height."""
        guided = self._flight.guided_mode()
        if guided is not None:
            self.command(SET_MODE, 1.0, float(guided))
            self.command(TAKEOFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m)
            return
        state = self.state
        east, north, up = state.position_enu_m
        self.command(TAKEOFF, 0.0, 0.0, 0.0, math.nan, place_enu_m=(east, north, up + height_m - state.height_m))

    def go_to(self, east_m: float, north_m: float, up_m: float) -> None:
        """Starts a flight to a place of the scenario's frame, m, and a hold there. Returns when the command is accepted."""
        # Parameter 2, bit 0: change to the mode that flies there.
        self.command(REPOSITION, -1.0, 1.0, 0.0, math.nan, place_enu_m=(east_m, north_m, up_m))

    def land(self) -> None:
        """Starts a landing where the vehicle is. Returns when the command is accepted."""
        self.command(LAND, 0.0, 0.0, 0.0, math.nan)

    def sticks(self, forward: float, right: float, up: float, yaw: float) -> None:
        """Sends the sticks once: forward, right and yaw from -1 to 1, up from 0 to 1 with 0.5 to hold. Send them twice a second or more."""
        self._flight.sticks(forward, right, up, yaw)

    def open_link(self, kind: str = "gcs") -> Link:
        """Opens a MAVLink link without a socket. `kind` decides the usual streams: gcs, sdk, or payload (truth and scoring values)."""
        return Link(self._flight, self._flight.open_mailbox(kind))

    @contextmanager
    def record(self, path: str | os.PathLike[str]) -> Iterator[None]:
        """Writes the telemetry into a .tlog file meanwhile: `spandrel.assess` scores it, QGroundControl and Mission Planner open it."""
        link = self._flight.open_log(path)
        try:
            yield
        finally:
            self._flight.close(link)

    def connect(self) -> LockstepConnection:
        """Returns a pymavlink connection over UDP in lockstep with the vehicle.

        It is a `mavutil` connection in all respects but one: its clock is the simulation's. `recv_match(blocking=True, timeout=5)` lets
        simulation time pass until the message is there, 5 s at most. Needs pymavlink.
        """
        from .connection import LockstepConnection

        if self._server is not None:
            raise SpandrelError("the vehicle is served in real time: connect before serve() or use a connection of your own")
        connection = LockstepConnection(self)
        _, port = self._flight.open_udp("gcs", connection.endpoint, True)
        connection.destination_addr = ("127.0.0.1", port)
        self._connections.append(connection)
        return connection

    @contextmanager
    def serve(self, speed: float = 1.0, kind: str = "sdk") -> Iterator[str]:
        """Serves the vehicle over UDP for clients with a clock of their own, such as MAVSDK.

        Yields the address for MAVSDK's `add_any_connection`, `udpin://127.0.0.1:PORT`: the vehicle sends to that port, which was free, and
        the client listens there. Meanwhile simulation time runs `speed` times as fast as the wall clock, in a thread. What such a client
        sends arrives when the operating system delivers it, so two runs differ in their bits.
        """
        if self._server is not None or self._connections:
            raise SpandrelError("the vehicle is connected already: serve() needs it alone")
        if not 0.0 < speed <= 100.0:
            raise ValueError(f"speed is {speed}; allowed: more than 0, at most 100")
        port = _free_port()
        link, _ = self._flight.open_udp(kind, ("127.0.0.1", port))
        self._stop.clear()
        self._server = threading.Thread(target=self._keep_pace, args=(speed,), name="spandrel", daemon=True)
        self._server.start()
        try:
            yield f"udpin://127.0.0.1:{port}"
        finally:
            self._stop.set()
            self._server.join()
            self._server = None
            self._flight.close(link)

    def close(self) -> None:
        """Closes all connections."""
        for connection in self._connections:
            connection.close()
        self._connections.clear()

    def __enter__(self) -> Vehicle:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _keep_pace(self, speed: float) -> None:
        """Runs what is due by the wall clock until `serve` ends."""
        begun_ns, begun = self._flight.now_ns(), time.monotonic()
        while not self._stop.wait(SERVING_SLEEP_S):
            self._flight.run(begun_ns + round(speed * (time.monotonic() - begun) * NS))
            with self._advanced:
                self._advanced.notify_all()

    def _advance_to(self, until_ns: int) -> None:
        """Lets simulation time pass: by running it, or by waiting while the vehicle is served."""
        if self._server is not None:
            with self._advanced:
                self._advanced.wait_for(lambda: self._stop.is_set() or self._flight.now_ns() >= until_ns)
            return
        while self._flight.run(until_ns):
            answered = [connection.answer() for connection in self._connections]
            if not any(answered):
                raise SpandrelError("a connection in lockstep does not answer: was it closed without Vehicle.close()?")
