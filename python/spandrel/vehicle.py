"""The in-process vehicle."""

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
"""Physics time step, ns."""
POLL_INTERVAL_NS = 20_000_000
"""Interval for checking conditions and exchanging datagrams, ns of simulation time."""
COMMAND_TIMEOUT_NS = NS
"""Timeout for a command's reply, ns of simulation time."""
ARM_RETRY_INTERVAL_NS = NS // 2
"""Interval between arming attempts, ns of simulation time."""
SERVE_POLL_INTERVAL_S = 0.002
"""Time that the serving thread sleeps between steps, s of wall time."""

ACCEPTED, IN_PROGRESS = 0, 5
ARM_DISARM, TAKEOFF, LAND, REPOSITION, SET_MODE = 400, 22, 21, 192, 176


def _free_port() -> int:
    """Returns a UDP port that is currently free on the loopback interface."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


class Link:
    """A MAVLink link without a socket. Your code sends and receives the datagrams directly."""

    def __init__(self, flight: Flight, number: int) -> None:
        self._flight, self._number = flight, number

    def send(self, datagram: bytes) -> None:
        """Sends MAVLink frames to the vehicle, which handles them in the next tick."""
        self._flight.send(self._number, datagram)

    def receive(self) -> list[bytes]:
        """Returns the datagrams received from the vehicle since the last call, oldest first."""
        return self._flight.take(self._number)

    def close(self) -> None:
        """Closes the link. Raises SpandrelError if it is already closed."""
        self._flight.close(self._number)


class Vehicle:
    """A simulated drone, which starts disarmed on its pad.

    `scenario` and `vehicle` are shipped names (`spandrel.scenarios()`, `spandrel.vehicles()`) or paths to TOML files.
    `seed` determines gusts, sensor noise, traffic and defects. `flavor` is the autopilot protocol: px4, ardupilot or
    generic. `after_crash` is continue, respawn, end or scenario (the scenario's own rule).

    Simulation time advances only inside `step`, `run_for`, `run_until` and the commands, as fast as the machine allows,
    or in real time while `serve` is active. Identical calls produce bit-identical results in every run; compare
    `digest` to check.
    """

    def __init__(
        self,
        scenario: str | os.PathLike[str] = "drill-hover",
        vehicle: str | os.PathLike[str] = "phantom2",
        seed: int = 1,
        *,
        flavor: str = "px4",
        after_crash: str = "scenario",
    ) -> None:
        self._flight = Flight(os.fspath(scenario), os.fspath(vehicle), seed, flavor, after_crash)
        self._connections: list[LockstepConnection] = []
        self._server: threading.Thread | None = None
        self._stop = threading.Event()
        self._advanced = threading.Condition()

    @property
    def state(self) -> State:
        """Current true state."""
        return self._flight.state()

    @property
    def time_s(self) -> float:
        """Simulation time, s."""
        return self._flight.now_ns() / NS

    @property
    def digest(self) -> str:
        """SHA-256 of the state at every tick so far, as 64 hexadecimal digits."""
        return self._flight.digest()

    def step(self, n: int = 1) -> State:
        """Runs `n` physics ticks of 1 ms and returns the state after them."""
        if n < 0:
            raise ValueError(f"n is {n}; allowed: 0 or more")
        self._advance_to(self._flight.now_ns() + n * TICK_NS)
        return self.state

    def run_for(self, sim_s: float) -> State:
        """Runs for `sim_s` seconds of simulation time and returns the state after them."""
        if not 0.0 <= sim_s < math.inf:
            raise ValueError(f"sim_s is {sim_s}; allowed: 0 or more")
        self._advance_to(self._flight.now_ns() + round(sim_s * NS))
        return self.state

    def run_until(self, condition: Callable[[State], bool], sim_s: float) -> State:
        """Runs until `condition(state)` is true and returns that state.

        The condition is checked every 20 ms of simulation time. Raises LateError if it is not met within `sim_s`
        seconds of simulation time.
        """
        limit = self._flight.now_ns() + round(sim_s * NS)
        while not condition(state := self.state):
            now = self._flight.now_ns()
            if now >= limit:
                raise LateError(
                    f"the condition was not met within {sim_s} s of simulation time; last status text: {state.text}"
                )
            self._advance_to(min(limit, now + POLL_INTERVAL_NS))
        return state

    def command(
        self, command: int, *params: float, place_enu_m: tuple[float, float, float] | None = None
    ) -> None:
        """Sends a MAVLink command by number and waits for the reply.

        Uses COMMAND_INT if `place_enu_m`, a position in the scenario's frame (east, north, up, m), is given, otherwise
        COMMAND_LONG. Raises RefusedError if the command is rejected, or if there is no reply within one second of
        simulation time.
        """
        self._flight.ask(int(command), list(params), place_enu_m)
        limit = self._flight.now_ns() + COMMAND_TIMEOUT_NS
        while self._flight.now_ns() < limit:
            self._advance_to(self._flight.now_ns() + TICK_NS)
            answer = self._flight.answer()
            if answer == ACCEPTED:
                return
            if answer is not None and answer != IN_PROGRESS:
                raise self._flight.refusal(answer)
        raise self._flight.refusal(None)

    def arm(self, sim_s: float = 30.0) -> None:
        """Arms as soon as the vehicle allows it. Raises the last RefusedError after `sim_s` seconds of simulation
        time."""
        limit = self._flight.now_ns() + round(sim_s * NS)
        while True:
            try:
                self.command(ARM_DISARM, 1.0)
            except RefusedError:
                if self._flight.now_ns() >= limit:
                    raise
                self._advance_to(self._flight.now_ns() + ARM_RETRY_INTERVAL_NS)
            else:
                return

    def take_off(self, height_m: float) -> None:
        """Starts a takeoff to a height above the pad, given in meters. Returns once the command is accepted; use
        `run_until` to wait for the height."""
        guided = self._flight.guided_mode()
        if guided is not None:
            self.command(SET_MODE, 1.0, float(guided))
            self.command(TAKEOFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m)
            return
        state = self.state
        east, north, up = state.position_enu_m
        self.command(TAKEOFF, 0.0, 0.0, 0.0, math.nan, place_enu_m=(east, north, up + height_m - state.height_m))

    def go_to(self, east_m: float, north_m: float, up_m: float) -> None:
        """Starts a flight to a position in the scenario's frame, given in meters, and holds there. Returns once the
        command is accepted."""
        # Parameter 2, bit 0: switch to the mode that executes the command.
        self.command(REPOSITION, -1.0, 1.0, 0.0, math.nan, place_enu_m=(east_m, north_m, up_m))

    def land(self) -> None:
        """Starts a landing at the current position. Returns once the command is accepted."""
        self.command(LAND, 0.0, 0.0, 0.0, math.nan)

    def sticks(self, forward: float, right: float, up: float, yaw: float) -> None:
        """Sends one manual control input: forward, right and yaw from -1 to 1, up from 0 to 1 (0.5 holds). Repeat at 2
        Hz or more."""
        self._flight.sticks(forward, right, up, yaw)

    def open_link(self, kind: str = "gcs") -> Link:
        """Opens a MAVLink link without a socket. `kind` selects the default streams: gcs, sdk, or payload (truth and
        scoring values)."""
        return Link(self._flight, self._flight.open_mailbox(kind))

    @contextmanager
    def record(self, path: str | os.PathLike[str]) -> Iterator[None]:
        """Records telemetry to a .tlog file within the context, for `spandrel.assess`, QGroundControl or Mission
        Planner."""
        link = self._flight.open_log(path)
        try:
            yield
        finally:
            self._flight.close(link)

    def connect(self) -> LockstepConnection:
        """Returns a pymavlink connection over UDP in lockstep with the vehicle.

        It behaves like any `mavutil` connection, except that it runs on simulation time: `recv_match(blocking=True,
        timeout=5)` advances the simulation until the message arrives, by at most 5 s. Requires pymavlink.
        """
        from .connection import LockstepConnection

        if self._server is not None:
            raise SpandrelError("the vehicle is served in real time; call connect() before serve(), or open your own connection")
        connection = LockstepConnection(self)
        _, port = self._flight.open_udp("gcs", connection.endpoint, True)
        connection.destination_addr = ("127.0.0.1", port)
        self._connections.append(connection)
        return connection

    @contextmanager
    def serve(self, speed: float = 1.0, kind: str = "sdk") -> Iterator[str]:
        """Serves the vehicle over UDP for clients that run on wall time, such as MAVSDK.

        Yields the address for MAVSDK's `add_any_connection`, `udpin://127.0.0.1:PORT`: the client listens on that port,
        and the vehicle sends to it. Within the context, a thread runs the simulation at `speed` times wall time. The
        arrival time of the client's datagrams depends on the operating system, so runs are not reproducible.
        """
        if self._server is not None or self._connections:
            raise SpandrelError("the vehicle is already connected; serve() requires exclusive access")
        if not 0.0 < speed <= 100.0:
            raise ValueError(f"speed is {speed}; allowed: more than 0, at most 100")
        port = _free_port()
        link, _ = self._flight.open_udp(kind, ("127.0.0.1", port))
        self._stop.clear()
        self._server = threading.Thread(target=self._follow_wall_clock, args=(speed,), name="spandrel", daemon=True)
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

    def _follow_wall_clock(self, speed: float) -> None:
        """Keeps simulation time in step with wall time until `serve` ends."""
        begun_ns, begun = self._flight.now_ns(), time.monotonic()
        while not self._stop.wait(SERVE_POLL_INTERVAL_S):
            self._flight.run(begun_ns + round(speed * (time.monotonic() - begun) * NS))
            with self._advanced:
                self._advanced.notify_all()

    def _advance_to(self, until_ns: int) -> None:
        """Advances to a simulation time, by running the simulation or, while the vehicle is served, by waiting."""
        if self._server is not None:
            with self._advanced:
                self._advanced.wait_for(lambda: self._stop.is_set() or self._flight.now_ns() >= until_ns)
            return
        while self._flight.run(until_ns):
            answered = [connection.answer() for connection in self._connections]
            if not any(answered):
                raise SpandrelError("a lockstep connection does not reply; was it closed without Vehicle.close()?")
