"""`aeye/Drive-v0` drives what `aeye drive` drives, alone and in company, and is what Gymnasium expects of an environment."""

import multiprocessing
import os
import subprocess
import sys
import warnings
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import aeye
import aeye.gym
import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from gymnasium.vector import AutoresetMode, SyncVectorEnv

ID = "aeye/Drive-v0"
# Random episodes that are driven and verified; a thousand by hand.
EPISODES = int(os.environ.get("AEYE_EPISODES", "12"))


def never(facts: aeye.gym.Facts) -> np.ndarray:
    return np.zeros(facts["tick"].shape, np.bool_)


@pytest.mark.parametrize("seat", ["semantic", "safety"])
@pytest.mark.parametrize("observe", ["mask", "rgb", "both"])
def test_gymnasium_finds_nothing_to_complain_about(seat, observe):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(ID, seat=seat, observe=observe, size=(64, 32))
        check_env(env.unwrapped)
    assert set(env.observation_space) == {"hud"} | ({"mask", "rgb"} if observe == "both" else {observe})


def replayed(recording: aeye.Recording, seat: str, **options: Any) -> dict[str, Any]:
    """Gives an agent's seat the controls that were recorded of it, tick by tick, and compares hashes; the last info."""
    env = gymnasium.make(ID, seat=seat, ticks=1, termination=never, **options).unwrapped
    env.reset(seed=recording.seed)
    controls = recording.controls[seat]
    actions = np.stack([controls[name] for name in ("steering", "throttle", "brake")], axis=1)
    for tick, action, expected in zip(recording.ticks, actions, recording.hashes, strict=True):
        _, _, terminated, truncated, info = env.step(action)
        assert (info["tick"], info["hash"]) == (tick, expected)
        assert (terminated or truncated) == (tick == recording.ticks[-1])
    return info


@pytest.mark.parametrize("seat", ["semantic", "safety"])
def test_the_controls_of_a_headless_drive_give_that_drive(seat, drive, tmp_path):
    recording = aeye.open(drive)
    info = replayed(recording, seat, map="city", max_time=13, record=tmp_path)
    assert info["outcome"] == recording.inspect()["outcome"] == "censored"
    again = aeye.open(info["recording"])
    assert again.path.name == f"episode-000001-seed-{recording.seed}.mcap"
    assert again.finished and again.verify()["ok"]
    assert np.array_equal(again.hashes, recording.hashes)
    for name, column in recording.masks.items():
        assert np.array_equal(again.masks[name], column), name
    said, expected = again.inspect()["provenance"], recording.inspect()["provenance"]
    # Nobody knows what kind of driver an agent is.
    del expected[f"{seat}_temper"]
    assert said == expected | {seat: "agent"}


def test_images_are_those_of_a_sensor_and_masks_of_truth_are_not(tmp_path):
    made = {"quality": "plain", "sensor": "noise=6"}
    seen = []
    for options in ({"quality": "plain"}, made):
        env = gymnasium.make(ID, observe="both", map="city", record=tmp_path, **options).unwrapped
        env.reset(seed=3)
        seen.append(env.step(np.zeros(3, np.float32))[0])
        info = env.step(np.zeros(3, np.float32))[-1]
        env.close()
    assert info["tick"] == 12
    ideal, noisy = seen
    assert np.array_equal(ideal["mask"], noisy["mask"]) and not np.array_equal(ideal["rgb"], noisy["rgb"])
    recording = aeye.open(sorted(tmp_path.glob("*.mcap"))[-1])
    assert np.array_equal(recording.frame(6, **made).rgb, noisy["rgb"])
    with pytest.raises(aeye.InputError, match="sensor="):
        gymnasium.make(ID, sensor="iso=100")
    env = gymnasium.make(ID, checkpoint="early", map="city", record=tmp_path / "early", **made).unwrapped
    env.reset(seed=3)
    env.step(np.zeros(3, np.float32))
    env.close()
    (kept,) = (tmp_path / "early").glob("*.mcap")
    assert aeye.open(kept).inspect()["provenance"]["camera"] == "driver 256x128 plain noise=6"


def test_a_takeover_comes_again_in_the_same_tick(case, tmp_path):
    recording = aeye.open(case.with_name(case.name.replace(".case", "")))
    scenario = tmp_path / "scenario.toml"
    scenario.write_text(recording.scenario)
    info = replayed(recording, "semantic", scenario=scenario, checkpoint="early", record=tmp_path / "kept")
    assert (info["outcome"], info["facts"]["taken_over"]) == ("intervened", 1)
    again = aeye.open(info["recording"])
    assert again.labels is not None and recording.labels is not None
    for name in ("label", "comment"):
        assert again.labels[name] == recording.labels[name]
    assert again.labels["perception_caused"] is None, "nobody knows what the agent would have done with true masks"


def random_drive(env: gymnasium.Env, seed: int | None) -> dict[str, Any]:
    """Drives an episode to its end, more with throttle than with brake; the last info."""
    _, info = env.reset(seed=seed)
    random = np.random.default_rng(info["seed"])
    over = False
    while not over:
        pedal = random.uniform(-0.4, 1.0)
        action = np.array([random.normal(0.0, 0.05), pedal, -pedal], np.float32).clip([-1, 0, 0], 1)
        observation, reward, terminated, truncated, info = env.step(action)
        assert observation in env.observation_space and np.isfinite(reward)
        assert reward == pytest.approx(sum(info["reward_terms"].values()))
        over = terminated or truncated
    return info | {"terminated": terminated}


@pytest.mark.parametrize("seat", ["semantic", "safety"])
def test_random_episodes_end_and_their_recordings_verify(seat, tmp_path):
    env = gymnasium.make(ID, seat=seat, map="city", max_time=20, ticks=15, record=tmp_path)
    ends = [random_drive(env, seed=1 if number == 0 else None) for number in range(EPISODES // 2)]
    env.close()
    assert seat == "safety" or any(end["outcome"] == "intervened" for end in ends), "it is no good driver"
    paths = [Path(end["recording"]) for end in ends]
    assert sorted(paths) == sorted(tmp_path.glob("*.mcap")), "nothing else is there"
    for end, path in zip(ends, paths, strict=True):
        recording = aeye.open(path)
        assert recording.finished and recording.seed == end["seed"] and recording.verify()["ok"]
        assert recording.inspect()["outcome"] == end["outcome"], "a takeover is driven on to its end"
        assert end["terminated"] == (end["outcome"] != "censored")


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_many_drives_are_each_what_one_would_be(mode):
    """Against Gymnasium's own loop over single ones: observations, rewards, ends and infos, episode after episode."""
    options: dict[str, Any] = {"ticks": 30, "max_time": 5, "observe": "both", "pedestrians": 5}
    single = [lambda: gymnasium.make(ID, **options).unwrapped] * 3
    expected, envs = SyncVectorEnv(single, autoreset_mode=mode), gymnasium.make_vec(ID, 3, autoreset_mode=mode, **options)
    assert envs.observation_space == expected.observation_space and envs.action_space == expected.action_space
    assert envs.metadata["autoreset_mode"] is mode
    assert data_equivalence(envs.reset(seed=7), expected.reset(seed=7), exact=True)
    envs.action_space.seed(7)
    ends = 0
    for _ in range(25):
        actions = envs.action_space.sample()
        told, wanted = envs.step(actions), expected.step(actions)
        assert data_equivalence(list(told[:4]), list(wanted[:4]), exact=True)
        assert data_equivalence(told[4], wanted[4], exact=True), f"{told[4]}\n{wanted[4]}"
        over = told[2] | told[3]
        ends += over.sum()
        if mode is AutoresetMode.DISABLED and over.any():
            again = [envs.reset(options={"reset_mask": over.copy()}), expected.reset(options={"reset_mask": over.copy()})]
            assert data_equivalence(*again, exact=True)
    assert ends >= 6, "each drive at least twice"
    envs.close()


def test_a_drive_is_the_same_in_any_company():
    def pictures(count: int, jobs: int) -> np.ndarray:
        envs = gymnasium.make_vec(ID, count, jobs=jobs, max_time=10, observe="both")
        envs.reset(seed=11)
        action = np.tile(np.array([0.1, 0.5, 0.0], np.float32), (count, 1))
        return np.array([envs.step(action)[0]["rgb"][0] for _ in range(12)])

    alone = pictures(1, 1)
    assert len(np.unique(alone, axis=0)) > 3, "the car moves"
    assert np.array_equal(alone, pictures(2, 2)) and np.array_equal(alone, pictures(9, 2))


def test_arrays_are_new_unless_asked_otherwise():
    for copy in (True, False):
        envs = gymnasium.make_vec(ID, 2, copy=copy)
        first, _ = envs.reset(seed=1)
        second = envs.step(np.zeros((2, 3), np.float32))[0]
        assert np.shares_memory(first["mask"], second["mask"]) != copy
        assert envs.step(np.zeros((2, 3), np.float32))[0]["mask"].any()


def test_the_reward_and_the_ends_can_be_replaced():
    def fast(facts: aeye.gym.Facts) -> dict[str, np.ndarray]:
        return {"speed": facts["speed_mps"], "late": -1.0 * (facts["tick"] > 30)}

    options = {"reward": fast, "truncation": lambda facts: facts["tick"] >= 60}
    env = gymnasium.make(ID, **options)
    env.reset(seed=1)
    rewards, over = [], False
    while not over:
        observation, reward, terminated, over, info = env.step(np.array([0, 0.5, 0], np.float32))
        rewards.append(reward)
        assert info["reward_terms"].keys() == {"speed", "late"}
    assert (len(rewards), terminated, info["outcome"]) == (10, False, "")
    # The HUD shows whole km/h.
    assert rewards[-1] == pytest.approx(observation["hud"][0] - 1, abs=0.5 / 3.6 + 1e-3)
    assert gymnasium.make(ID, weights={"progress": 0.0}).unwrapped is not None
    with pytest.raises(aeye.InputError, match="termination has the shape"):
        bad = gymnasium.make(ID, termination=lambda facts: True)
        bad.reset(seed=1)
        bad.step(np.zeros(3, np.float32))


def test_progress_and_rules_are_told():
    env = gymnasium.make(ID, seat="safety", map="city", max_time=20)
    env.reset(seed=1)
    progress = sideways = 0.0
    over = False
    while not over:
        *_, terminated, truncated, info = env.step(np.zeros(3, np.float32))
        progress += info["facts"]["progress_m"]
        sideways += info["facts"]["sideways_mps"]
        over = terminated or truncated
    assert progress > 20 and sideways > 0.1, "the semantic bot drives along its way"
    assert info["facts"]["takeovers"] == 0


def test_a_reset_may_change_where_and_in_what_weather():
    env = gymnasium.make(ID, observe="both")
    here = env.reset(seed=2)[0]["mask"]
    rain = env.reset(seed=2, options={"weather": "HardRainNoon"})[0]
    assert np.array_equal(rain["mask"], here), "true classes see no rain"
    assert not np.array_equal(rain["rgb"], env.reset(seed=2)[0]["rgb"])
    assert not np.array_equal(env.reset(seed=2, options={"map": "rural"})[0]["mask"], here)
    assert np.array_equal(env.reset(seed=2)[0]["mask"], here)


def test_pictures_of_drives():
    env = gymnasium.make(ID, render_mode="rgb_array", render_size=(64, 48), truncation=lambda facts: facts["tick"] > 10)
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (48, 64, 3)
    for _ in range(2):
        *_, truncated, _ = env.step(np.array([0, 1, 0], np.float32))
    assert truncated and env.render().shape == (48, 64, 3), "of the end, too"
    envs = gymnasium.make_vec(ID, 2, render_mode="rgb_array", render_size=(64, 48), camera="driver")
    envs.reset(seed=1)
    assert [picture.shape for picture in envs.render()] == [(48, 64, 3)] * 2


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"seat": "back"}, "expected semantic or safety"),
        ({"observe": "depth"}, "expected mask, rgb or both"),
        ({"ticks": 61}, "ticks=61; expected 1 to 60"),
        ({"map": "atlantis"}, "expected one of city, rural"),
        ({"map": "city", "scenario": "run.toml"}, "expected one of them"),
        ({"max_time": 3}, "max_time=3; expected whole seconds from 4"),
        ({"brake_threshold": 2}, "expected 0.01 to 0.99"),
        ({"weights": {"speed": 1}}, "expected some of progress, "),
        ({"size": (4, 4)}, "expected sides of 8 to 8192"),
        ({"render_mode": "human"}, "expected rgb_array or None"),
        ({"camera": "back"}, "expected driver, chase or top"),
        ({"render_size": (4, 4)}, "render_size 4x4; expected sides of 8 to 8192"),
        ({"reward": 3}, "reward=3; expected something to call"),
        ({"termination": True}, "termination=True; expected something to call"),
        ({"pedestrians": -1}, "pedestrians=-1; expected 0 to 500"),
        ({"ticks": -1}, "ticks=-1; expected 1 to 60"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(options, said):
    for make in (aeye.gym.DriveEnv, aeye.gym.DriveVectorEnv):
        with pytest.raises(aeye.InputError) as caught:
            make(**options)
        assert said in str(caught.value) and "\n" not in str(caught.value)


def test_arguments_of_another_type_are_named():
    for options, said in (
        ({"checkpoint": 3}, "checkpoint: expected a name, a file or an aeye.External, got int"),
        ({"max_time": "10s"}, "max_time: expected a number, got str"),
        ({"size": 64}, "size: expected two whole numbers, got int"),
    ):
        with pytest.raises(TypeError, match=f"^{said}$"):
            aeye.gym.DriveEnv(**options)
    with pytest.raises(aeye.InputError, match="num_envs=0; expected 1 to 1024"):
        aeye.gym.DriveVectorEnv(0)


def test_controls_beyond_their_range_count_as_its_end():
    def hashes(action) -> list[int]:
        env = aeye.gym.DriveEnv(max_time=10)
        env.reset(seed=1)
        return [env.step(np.array(action, np.float32))[4]["hash"] for _ in range(10)]

    assert hashes([-3.0, 7.0, -1.0]) == hashes([-1.0, 1.0, 0.0])


def test_wrong_steps_and_resets_are_refused():
    env = aeye.gym.DriveEnv(truncation=lambda facts: facts["tick"] >= 0)
    with pytest.raises(aeye.InputError, match="expected a reset"):
        env.step(np.zeros(3, np.float32))
    with pytest.raises(aeye.InputError, match="option 'speed'; expected some of map"):
        env.reset(options={"speed": 1})
    env.reset(seed=1)
    for action, said in ((np.zeros(2), "expected \\(3,\\)"), ([0, np.nan, 0], "expected finite numbers")):
        with pytest.raises(aeye.InputError, match=said):
            env.step(action)
    assert env.step(np.zeros(3))[3]
    with pytest.raises(aeye.InputError, match="expected a reset"):
        env.step(np.zeros(3))
    envs = aeye.gym.DriveVectorEnv(2)
    for call, said in (
        (lambda: envs.reset(seed=[1]), "1 seeds"),
        (lambda: envs.reset(options={"reset_mask": np.zeros(2, np.bool_)}), "some True"),
        (lambda: envs.step(np.zeros((3, 3))), "expected \\(2, 3\\)"),
    ):
        with pytest.raises(aeye.InputError, match=said):
            call()


def step_in_child(env: aeye.gym.DriveEnv, answer: Connection) -> None:
    try:
        env.reset(seed=1)
        answer.send("drives")
    except aeye.Error as error:
        answer.send(str(error))


def test_a_process_that_was_forked_after_drawing_says_so():
    env = aeye.gym.DriveEnv()
    env.reset(seed=1)
    mine, its = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(target=step_in_child, args=(env, its))
    process.start()
    answered = mine.poll(60)
    process.kill()
    process.join()
    assert answered and "forked" in (said := mine.recv()) and "spawn" in said


def test_the_package_does_without_gymnasium():
    code = """
from importlib import util
found = util.find_spec
util.find_spec = lambda name: None if name == "gymnasium" else found(name)
import aeye
import aeye.gym
"""
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=False)
    last = done.stderr.strip().splitlines()[-1]
    assert last == "ImportError: Gymnasium is not installed; aeye.gym needs it: pip install aeye[gym]", done.stderr
