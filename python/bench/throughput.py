"""Measures environment steps per second, compared with gym-pybullet-drones in the same run. Run with `tools/python
--bench`.

    tools/python --bench                       fails below the minimum ratio
    tools/python --bench --peer DIR            uses gym-pybullet-drones from a source checkout

Both packages run the hover task with all effects that they model. Spandrel models wind, gusts, ground effect, drag,
sensor noise and an autopilot. gym-pybullet-drones models ground effect, drag and downwash (PYB_GND_DRAG_DW). Each
package runs in one process in its fastest mode: Spandrel with native threads, gym-pybullet-drones as one environment,
because it has no vectorized stepping. To reduce the effect of other load, the rounds alternate, and only the best round
of each package counts. Measure on an idle computer, because threads gain nothing on busy cores.
"""

import argparse
import os
import sys
import time
import warnings

import gymnasium
import numpy as np

import spandrel.gymnasium_envs  # noqa: F401 (registers the environments)

# Minimum ratio of our throughput to that of gym-pybullet-drones, in simulation time.
MIN_RATIO = 20.0
# Used if gym-pybullet-drones is not installed: its speed on a dedicated machine with two cores, as a multiple of real time.
FALLBACK_PEER_SPEED = 27.0
# Wall time per round, s, and number of rounds.
ROUND_S, ROUNDS = 3.0, 5
# High enough that no episode ends while steps are measured. Resets are measured separately.
MAX_STEPS = 10**9
# Vehicles per batch: several per thread on a large machine.
BATCH_SIZE = 64
# The control rate nearest to our 50 Hz; physics at the default 240 Hz.
PEER_HZ, PEER_PHYSICS_HZ = 48, 240


def steps_per_second(step, each):
    """Returns steps per second of wall time. Each call steps `each` environments."""
    calls, start = 0, time.perf_counter()
    while (passed := time.perf_counter() - start) < ROUND_S:
        step()
        calls += 1
    return calls * each / passed


def make_batch_step(name, count, threads):
    """Returns a function that steps all environments of a batch with varying actions, and the simulation time per step
    in seconds."""
    env = gymnasium.make_vec(
        name, num_envs=count, vectorization_mode="vector_entry_point", threads=threads, max_episode_steps=MAX_STEPS
    )
    env.reset(seed=1)
    env.action_space.seed(1)
    actions = [env.action_space.sample() * np.float32(0.2) for _ in range(16)]
    turn = iter(range(sys.maxsize))
    return lambda: env.step(actions[next(turn) % len(actions)]), env.step_s


def make_single_step(name):
    """Returns a function that steps one environment, and the simulation time per step in seconds."""
    env = gymnasium.make(name, max_episode_steps=MAX_STEPS)
    env.reset(seed=1)
    action = np.zeros(env.action_space.shape, np.float32)
    return lambda: env.step(action), env.unwrapped.step_s


def reset_ms(env):
    """Returns the best wall time of ten resets, each with a new seed, in ms."""
    times = []
    for seed in range(10):
        start = time.perf_counter()
        env.reset(seed=seed)
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def peer(checkout, action):
    """Returns a step function for gym-pybullet-drones, or None if it is not installed."""
    if checkout:
        sys.path.insert(0, checkout)
    try:
        from gym_pybullet_drones.envs.HoverAviary import HoverAviary
        from gym_pybullet_drones.utils.enums import ActionType, Physics
    except ImportError as error:
        print(f"gym-pybullet-drones is not installed ({error}); pass a checkout with --peer. Using its published result.")
        return None
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        said, sys.stdout = sys.stdout, nowhere
        env = HoverAviary(physics=Physics.PYB_GND_DRAG_DW, pyb_freq=PEER_PHYSICS_HZ, ctrl_freq=PEER_HZ, act=ActionType[action])
        sys.stdout = said
    print(f"gym-pybullet-drones, time per reset: {reset_ms(env):.1f} ms")
    still = np.zeros(env.action_space.shape, np.float32)
    return lambda: env.step(still), 1.0 / PEER_HZ


def main():
    """Runs the benchmark, prints a table and fails below the minimum ratio."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--peer", help="checkout of gym-pybullet-drones")
    checkout = arguments.parse_args().peer
    warnings.filterwarnings("ignore")
    cores = len(os.sched_getaffinity(0))
    for name in ("Spandrel-Hover-v0", "Spandrel-Inspect-v0"):
        print(f"{name}, time per reset (a flight from the pad to the start position): {reset_ms(gymnasium.make(name)):.1f} ms")
    rows = {
        f"Spandrel-Hover-v0, {BATCH_SIZE} vehicles, {cores} threads": (*make_batch_step("Spandrel-Hover-v0", BATCH_SIZE, cores), BATCH_SIZE),
        f"Spandrel-Hover-v0, {BATCH_SIZE} vehicles, 1 thread": (*make_batch_step("Spandrel-Hover-v0", BATCH_SIZE, 1), BATCH_SIZE),
        "Spandrel-Hover-v0, one environment": (*make_single_step("Spandrel-Hover-v0"), 1),
        f"Spandrel-Inspect-v0, 16 vehicles, {cores} threads": (*make_batch_step("Spandrel-Inspect-v0", 16, cores), 16),
    }
    peers = {}
    for action in ("RPM", "VEL"):
        found = peer(checkout, action)
        if found is None:
            break
        peers[f"gym-pybullet-drones HoverAviary, actions {action}"] = (*found, 1)
    rates = dict.fromkeys([*rows, *peers], 0.0)
    for _ in range(ROUNDS):
        for name, (step, _, each) in (rows | peers).items():
            rates[name] = max(rates[name], steps_per_second(step, each))
    speeds = {name: rates[name] * step_s for name, (_, step_s, _) in (rows | peers).items()}
    for name, rate in rates.items():
        print(f"{name}: {rate:.0f} steps/s, {speeds[name]:.0f} times real time")
    # Comparable tasks: velocity setpoints, tracked by our autopilot and by their controller.
    theirs = next((speeds[name] for name in peers if name.endswith("VEL")), FALLBACK_PEER_SPEED)
    ratio = max(speeds[name] for name in rows if name.startswith("Spandrel-Hover")) / theirs
    print(f"ratio with velocity setpoints: {ratio:.1f} (minimum {MIN_RATIO:.0f})")
    sys.exit(0 if ratio >= MIN_RATIO else 1)


if __name__ == "__main__":
    main()
