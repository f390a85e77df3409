"""Installs jiling_gym into a folder of its own, and checks it: check.py REPOSITORY FOLDER"""

import os
import pathlib
import subprocess
import sys

repository, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
packages = folder / "packages"
pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--no-deps", "--no-build-isolation", "--upgrade"]
subprocess.run([*pip, "--target", str(packages), str(repository / "crates/gym")], check=True)
sys.path.insert(0, str(packages))

import gymnasium
import numpy
from gymnasium.utils.env_checker import check_env

import jiling_gym

check_env(gymnasium.make("FivebarFlat-v0").unwrapped)

envs = jiling_gym.FivebarVec(3, threads=2, episode_s=0.2, push_mps=0.0)
seen, _ = envs.reset(seed=4)
again, _ = envs.reset(seed=4)
assert (seen == again).all() and seen.shape == (3, 69)
for _ in range(10):
    seen, rewards, fallen, over, info = envs.step(numpy.zeros((3, 6), numpy.float32))
assert (fallen | over).all() and info["final_obs"].shape == (3, 69), info
for kind, says, option in (
    (KeyError, "colour", {"colour": "red"}),
    (ValueError, "--features python,board", {"elf": "robot-firmware"}),
):
    try:
        jiling_gym.FivebarVec(1, **option)
    except kind as error:
        assert says in str(error), error
    else:
        raise SystemExit(f"{option} was taken")

run = lambda script, *arguments: subprocess.run(
    [sys.executable, str(repository / "train" / script), *map(str, arguments)], check=True,
    env={**os.environ, "PYTHONPATH": str(packages), "JAX_PLATFORMS": "cpu"},
)
search = ("--generations", 1, "--sets", 4, "--seed", 3)
for file in ("planar.npz", "again.npz"):
    run("planar_search.py", "--out", folder / file, "--robots", 8, *search)
factors = lambda file: {name: value for name, value in numpy.load(folder / file).items() if name != "arguments"}
one, other = factors("planar.npz"), factors("again.npz")
assert all((one[name] == other[name]).all() for name in one), "the same seed gives another policy"
run("whole_search.py", folder / "planar.npz", "--out", folder / "whole.npz", "--robots", 2, "--seconds", 0.4, *search)
run("export.py", "--factors", folder / "whole.npz", "--out", folder / "searched.onnx")
run("export.py", "--factors", folder / "searched.onnx", "--out", folder / "again.onnx")
assert (folder / "again.onnx").read_bytes() == (folder / "searched.onnx").read_bytes(), "a network gives its factors back"
run("ppo.py", "--smoke", "--begin", folder / "whole.npz", "--out", folder / "run")
rows = lambda: len((folder / "run/curves.csv").read_text().splitlines())
first = rows()
run("ppo.py", "--smoke", "--resume", "--begin", folder / "whole.npz", "--out", folder / "run")
assert rows() > first, "it does not go on"
run("export.py", folder / "run", "--begin", folder / "whole.npz", "--out", folder / "policy.onnx")
run("evaluate.py", folder / "policy.onnx", "--robots", 2, "--tasks", "push", "--only", "policy")
print("all of it runs")
