"""Tests of the Gymnasium environments."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import spandrel.gymnasium_envs

HOVER, INSPECT = "Spandrel-Hover-v0", "Spandrel-Inspect-v0"
# Seeds of the episodes to compare.
SEED = 5


def velocity_toward_target(observation, limit):
    """Returns a velocity, in m/s, toward the point whose offset starts the observation: the offset in meters times
    1/s."""
    return np.clip(observation[:3], -limit, limit)


def hover_action(observation):
    return np.append(velocity_toward_target(observation, 4.0), 0.0).astype(np.float32)


def inspect_action(observation, snapshot):
    """Flies to the next point, level until close, points the camera at the target there, and takes pictures."""
    velocity = velocity_toward_target(observation, 3.0)
    if np.hypot(observation[0], observation[1]) > 8.0:
        velocity[2] = 0.0
    yaw_rate = np.clip(np.arctan2(observation[4], observation[3]), -1.0, 1.0)
    gimbal = np.arctan2(observation[5], np.hypot(observation[3], observation[4]))
    return np.array([*velocity, yaw_rate, gimbal, 1.0, float(snapshot)], dtype=np.float32)


@pytest.mark.parametrize("name", [HOVER, INSPECT])
def test_environments_pass_the_gymnasium_checker(name):
    with warnings.catch_warnings():
        # Only a recommendation: actions and observations are in SI units, not normalized.
        warnings.filterwarnings("ignore", message=".*(symmetric and normalized|infinity).*")
        check_env(gymnasium.make(name).unwrapped)


@pytest.mark.parametrize("name", [HOVER, INSPECT])
def test_exact_same_seed_is_bit_identical(name):
    env = gymnasium.make(name)
    runs = []
    for seed in (SEED, SEED, SEED + 1):
        observations = [env.reset(seed=seed)[0]]
        env.action_space.seed(3)
        observations += [env.step(env.action_space.sample())[0] for _ in range(20)]
        runs.append((np.array(observations).tobytes(), env.unwrapped.digest))
    assert runs[0] == runs[1] != runs[2]


def test_exact_new_and_reused_environments_are_bit_identical():
    """The cached initial state of the latest seed must not change the results."""
    kept, digests = gymnasium.make(HOVER), []
    for env in (kept, kept, gymnasium.make(HOVER)):
        env.reset(seed=SEED)
        env.step(np.ones(4, np.float32))
        digests.append(env.unwrapped.digest)
    assert digests[0] == digests[1] == digests[2]


def test_flight_hover_reward_increases_near_the_target():
    env = gymnasium.make(HOVER)
    observation, _ = env.reset(seed=SEED)
    rewards = []
    for _ in range(1_000):
        observation, reward, terminated, truncated, info = env.step(hover_action(observation))
        assert reward == -info["distance_m"]
        assert np.linalg.norm(observation[:3]) == pytest.approx(info["distance_m"], abs=1e-4)
        rewards.append(reward)
    assert rewards[0] < -14.0
    assert min(rewards[-100:]) > -0.5
    assert truncated and not terminated


def test_flight_actions_move_the_vehicle_as_documented():
    """Forward, left, up in heading axes; yaw counterclockwise."""
    env = gymnasium.make(HOVER)
    for axis in range(4):
        env.reset(seed=SEED)
        action = np.zeros(4, np.float32)
        action[axis] = 1.0
        for _ in range(150):
            observation = env.step(action)[0]
        moved = [observation[3], observation[4], observation[5], observation[11]]
        assert moved[axis] == pytest.approx(1.0, abs=0.35)
        assert all(abs(value) < 0.35 for other, value in enumerate(moved) if other != axis)


def test_flight_crash_ends_the_episode():
    env = gymnasium.make(HOVER)
    env.reset(seed=SEED)
    # Move sideways first, because a soft contact with the pad is a landing.
    for _ in range(200):
        env.step(np.array([4.0, 0.0, 0.0, 0.0], np.float32))
    for _ in range(600):
        _, _, terminated, _, info = env.step(np.array([4.0, 0.0, -4.0, 0.0], np.float32))
        if terminated:
            break
    assert terminated and info["hits"] > 0


def test_flight_inspect_rewards_paths_and_defects():
    env = gymnasium.make(INSPECT)
    observation, info = env.reset(seed=SEED)
    assert info == {"flown_share": 0.0, "found_share": 0.0}
    total = 0.0
    for step in range(2_500):
        observation, reward, terminated, _, info = env.step(inspect_action(observation, step % 10 == 0))
        assert reward >= 0.0
        total += reward
        if terminated or (info["flown_share"] > 0.05 and info["found_share"] > 0.0):
            break
    assert total == pytest.approx(info["flown_share"] + info["found_share"], abs=1e-9)
    assert info["flown_share"] > 0.05
    assert info["found_share"] > 0.0


def test_exact_invalid_actions_raise_errors():
    env = gymnasium.make(HOVER).unwrapped
    with pytest.raises(ValueError, match="reset every environment"):
        env.step(np.zeros(4, np.float32))
    env.reset(seed=SEED)
    with pytest.raises(ValueError, match="not finite"):
        env.step(np.full(4, np.nan, np.float32))
    with pytest.raises(ValueError, match="1 x 4 numbers"):
        env.step(np.zeros(3, np.float32))


@pytest.mark.parametrize("mode", ["sync", "vector_entry_point"])
def test_exact_vector_and_single_environments_are_bit_identical(mode):
    singles = [gymnasium.make(HOVER) for _ in range(3)]
    starts = np.array([env.reset(seed=SEED + k)[0] for k, env in enumerate(singles)])
    vector = gymnasium.make_vec(HOVER, num_envs=3, vectorization_mode=mode)
    assert np.array_equal(vector.reset(seed=SEED)[0], starts)
    for step in range(30):
        actions = np.full((3, 4), 0.1 * step, np.float32)
        alone = [env.step(action) for env, action in zip(singles, actions)]
        observations, rewards, terminated, truncated, infos = vector.step(actions)
        assert np.array_equal(observations, [one[0] for one in alone])
        assert np.array_equal(rewards, [one[1] for one in alone])
        assert not terminated.any() and not truncated.any()
        assert np.array_equal(infos["distance_m"], [one[4]["distance_m"] for one in alone])
        assert infos["_distance_m"].all()


def test_exact_next_episode_starts_one_step_after_the_end():
    vector = gymnasium.make_vec(HOVER, num_envs=2, vectorization_mode="vector_entry_point", max_episode_steps=5)
    first, _ = vector.reset(seed=[SEED, None])
    actions = np.ones((2, 4), np.float32)
    ends = [vector.step(actions)[3].all() for _ in range(5)]
    assert ends == [False] * 4 + [True]
    observations, rewards, terminated, truncated, _ = vector.step(actions)
    assert not rewards.any() and not terminated.any() and not truncated.any()
    assert not np.array_equal(observations, first)
    assert [vector.step(actions)[3].all() for _ in range(5)] == ends


def test_exact_number_of_threads_does_not_affect_results():
    digests = []
    for threads in (1, 3):
        vector = spandrel.gymnasium_envs.SpandrelVectorEnv("hover", "drill-hover", num_envs=5, threads=threads)
        vector.reset(seed=SEED)
        for _ in range(10):
            vector.step(np.ones((5, 4), np.float32))
        digests.append([vector.digest(k) for k in range(5)])
    assert digests[0] == digests[1]
    assert len(set(digests[0])) == 5
