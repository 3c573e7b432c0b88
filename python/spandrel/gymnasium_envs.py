"""Gymnasium environments. Importing this module registers Spandrel-Hover-v0 and Spandrel-Inspect-v0."""

from __future__ import annotations

import os
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._spandrel import Batch

SEED_LIMIT = 2**31
"""Exclusive upper bound for episode seeds, which is the limit for seeds in telemetry."""
INFO_KEYS = {"hover": ("distance_m", "hits"), "inspect": ("flown_share", "found_share")}
"""Keys of `info`, by environment kind."""
HOVER_MAX_STEPS = 1_000
"""Maximum episode length: 20 s of simulation time."""
INSPECT_MAX_STEPS = 15_000
"""Maximum episode length: 25 minutes of simulation time, the time limit in the shipped inspection."""

Observation = NDArray[np.float32]
Action = NDArray[np.float32]


class _Native:
    """A batch of native environments with its spaces."""

    def __init__(self, kind: str, scenario: str, vehicle: str, count: int, threads: int) -> None:
        self.batch = Batch(kind, scenario, vehicle, count, threads)
        self.count, self.width = count, self.batch.observations()
        low, high = np.array(self.batch.action_limits(), dtype=np.float32).T
        self.action_space = gymnasium.spaces.Box(low, high, dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (self.width,), np.float32)
        self.keys = INFO_KEYS[kind]

    def unpack_arrays(
        self, turn: tuple[bytes, bytes, bytes, bytes]
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], dict[str, Any]]:
        """Returns observations, rewards, terminations and measures as arrays."""
        observations = np.frombuffer(turn[0], np.float32).reshape(self.count, self.width).copy()
        measures = np.frombuffer(turn[3], np.float64).reshape(self.count, 2)
        infos: dict[str, Any] = {key: measures[:, k].copy() for k, key in enumerate(self.keys)}
        return observations, np.frombuffer(turn[1], np.float64).copy(), np.frombuffer(turn[2], np.bool_).copy(), infos


class SpandrelEnv(gymnasium.Env[Observation, Action]):
    """Environment with one vehicle. `kind` is hover or inspect; `scenario` and `vehicle` are shipped names or file
    paths."""

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self, kind: str, scenario: str | os.PathLike[str], vehicle: str | os.PathLike[str] = "phantom2", render_mode: str | None = None
    ) -> None:
        if render_mode is not None:
            raise ValueError(f"render_mode is {render_mode}; allowed: None (draw flights with `spandrel render`)")
        self.render_mode = None
        self._native = _Native(kind, os.fspath(scenario), os.fspath(vehicle), 1, 1)
        self.action_space, self.observation_space = self._native.action_space, self._native.observation_space
        self.step_s = self._native.batch.step_s()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """Starts an episode with the vehicle in flight above the pad. The same seed reproduces the episode bit for
        bit."""
        super().reset(seed=seed)
        episode = int(self.np_random.integers(SEED_LIMIT))
        observations, _, _, infos = self._native.unpack_arrays(self._native.batch.reset([episode]))
        return observations[0], {key: float(values[0]) for key, values in infos.items()}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Runs one step. Actions are clamped to the action space; a value that is not finite raises ValueError."""
        row = np.asarray(action, dtype=np.float32)
        observations, rewards, over, infos = self._native.unpack_arrays(self._native.batch.step(row.tobytes(), [None]))
        info = {key: float(values[0]) for key, values in infos.items()}
        return observations[0], float(rewards[0]), bool(over[0]), False, info

    @property
    def digest(self) -> str:
        """SHA-256 of the state at every tick of the episode."""
        return self._native.batch.digest(0)


class SpandrelVectorEnv(VectorEnv[Observation, Action, Any]):
    """Several vehicles, stepped by native threads (`threads=0`: one per processor). An environment resets in the step
    after its episode ends."""

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        kind: str,
        scenario: str | os.PathLike[str],
        vehicle: str | os.PathLike[str] = "phantom2",
        num_envs: int = 1,
        max_episode_steps: int | None = None,
        threads: int = 0,
    ) -> None:
        self._native = _Native(kind, os.fspath(scenario), os.fspath(vehicle), num_envs, threads)
        self.num_envs = num_envs
        self.single_action_space = self._native.action_space
        self.single_observation_space = self._native.observation_space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.step_s = self._native.batch.step_s()
        self._limit = max_episode_steps
        self._steps = np.zeros(num_envs, dtype=np.int64)
        self._over = np.zeros(num_envs, dtype=np.bool_)
        self._streams = [np.random.default_rng(k) for k in range(num_envs)]

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts all episodes. An integer seeds the environments with seed, seed + 1, ..., as in Gymnasium's other
        vector environments."""
        seeds: list[int | None] = [seed + k for k in range(self.num_envs)] if isinstance(seed, int) else list(seed or [])
        for k, one in enumerate(seeds):
            if one is not None:
                self._streams[k] = gymnasium.utils.seeding.np_random(one)[0]
        self._steps[:], self._over[:] = 0, False
        turn = self._native.batch.reset([int(stream.integers(SEED_LIMIT)) for stream in self._streams])
        observations, _, _, infos = self._native.unpack_arrays(turn)
        return observations, self._masked(infos)

    def _masked(self, infos: dict[str, Any]) -> dict[str, Any]:
        """Adds the mask that Gymnasium expects for each key. All masks are true, because every environment provides
        every value."""
        return infos | {f"_{key}": np.ones(self.num_envs, dtype=np.bool_) for key in infos}

    def step(
        self, actions: Action
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Runs one step in each environment. If the previous step ended an episode, starts the next one instead."""
        seeds = [int(stream.integers(SEED_LIMIT)) if over else None for stream, over in zip(self._streams, self._over)]
        rows = np.ascontiguousarray(actions, dtype=np.float32)
        observations, rewards, terminated, infos = self._native.unpack_arrays(self._native.batch.step(rows.tobytes(), seeds))
        self._steps = np.where(self._over, 0, self._steps + 1)
        truncated = np.zeros(self.num_envs, dtype=np.bool_) if self._limit is None else self._steps >= self._limit
        self._over = terminated | truncated
        return observations, rewards, terminated, truncated, self._masked(infos)

    def digest(self, index: int) -> str:
        """SHA-256 of the state at every tick of one environment's episode."""
        return self._native.batch.digest(index)


def _register(name: str, steps: int, **arguments: str) -> None:
    if name not in gymnasium.registry:
        gymnasium.register(
            name,
            entry_point="spandrel.gymnasium_envs:SpandrelEnv",
            vector_entry_point="spandrel.gymnasium_envs:SpandrelVectorEnv",
            max_episode_steps=steps,
            kwargs=arguments,
        )


_register("Spandrel-Hover-v0", HOVER_MAX_STEPS, kind="hover", scenario="drill-hover")
_register("Spandrel-Inspect-v0", INSPECT_MAX_STEPS, kind="inspect", scenario="two-bridges")
