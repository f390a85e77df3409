"""Writes configurations of rl_sar's form, and what a policy then sees and commands.

Everything is computed with NumPy in double precision from the formulas of docs/policy.md. It shares nothing with the
crate. `python make.py FOLDER` writes FOLDER/policies/ROBOT/base.yaml, FOLDER/policies/ROBOT/CONFIG/config.yaml and
FOLDER/ROBOT-CONFIG.json, each with a start, some steps, a second start and some steps.
"""

import json
import sys
from pathlib import Path

import numpy as np

STEPS = 5
STARTS = 2


def rotation(xyzw):
    """Matrix that turns vectors of the body into vectors of the world."""
    x, y, z, w = xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def term(name, config, seen):
    """Values of a term in one frame."""
    wheels = config["wheel_indices"]
    joints = list(range(config["num_of_dofs"]))
    lists = config["observations"] + config.get("observations_nonstack", [])
    if "wheel_joint_vel" in lists:
        joints = [n for n in joints if n not in wheels]
    if name == "lin_vel":
        return seen["linear_velocity"] * config["lin_vel_scale"]
    if name == "ang_vel":
        return seen["body_rates"] * config["ang_vel_scale"]
    if name == "gravity_vec":
        return rotation(seen["xyzw"]).T @ [0.0, 0.0, -1.0]
    if name == "commands":
        return seen["commands"] * np.array(config["commands_scale"])
    if name == "dof_pos":
        angles = seen["angles"] - np.array(config["default_dof_pos"])
        angles[wheels] = 0.0
        return angles[joints] * config["dof_pos_scale"]
    if name == "dof_vel":
        return seen["speeds"][joints] * config["dof_vel_scale"]
    if name == "wheel_joint_vel":
        return seen["speeds"][wheels] * config["dof_vel_scale"]
    if name == "actions":
        return seen["actions"]
    raise ValueError(name)


def frame(names, config, seen):
    clip = config["clip_obs"]
    return [np.clip(term(name, config, seen), -clip, clip) for name in names]


def network_input(config, frames, now):
    """Input of a network. `frames` has the newest last, and `now` is what is not stacked."""
    ages = config.get("observations_history") or [0]
    past = [frames[-1 - age] if age < len(frames) else frames[0] for age in ages]
    if config.get("observations_history_priority") == "term":
        parts = [past[n][place] for place in range(len(past[0])) for n in range(len(past))]
    else:
        parts = [part for one in past for part in one]
    return np.concatenate(parts + now)


def act(config, output, angles, speeds):
    """Clipped actions, targets in rad or rad/s, and torques in N·m with the limit."""
    lower, upper = config.get("clip_actions_lower"), config.get("clip_actions_upper")
    actions = np.clip(output, lower, upper) if lower else output
    scaled = actions * np.array(config["action_scale"])
    is_wheel = np.isin(np.arange(config["num_of_dofs"]), config["wheel_indices"])
    targets = np.where(is_wheel, scaled, scaled + np.array(config["default_dof_pos"]))
    kp, kd = np.array(config["rl_kp"]), np.array(config["rl_kd"])
    of_joints = kp * (targets - angles) - kd * speeds
    of_wheels = kd * (targets - speeds)
    limits = np.array(config["torque_limits"])
    torques = np.clip(np.where(is_wheel, of_wheels, of_joints), -limits, limits)
    return actions, targets, torques


def steps(config, random):
    """A run of the policy, from two starts."""
    joints = config["num_of_dofs"]
    mapping = np.array(config["joint_mapping"])
    directions = np.array(config.get("joint_directions", [1] * joints))
    rounded = lambda size, spread: np.round(random.normal(0.0, spread, size), 4)
    for _ in range(STARTS):
        actions, frames = np.zeros(joints), []
        for step in range(STEPS):
            xyzw = np.round(random.normal(0.0, 1.0, 4), 4)
            xyzw /= np.linalg.norm(xyzw)
            world_rates = rounded(3, 2.0)
            motors = {"angles": rounded(joints, 1.0), "speeds": rounded(joints, 5.0)}
            seen = {
                "xyzw": xyzw,
                "body_rates": rotation(xyzw).T @ world_rates,
                "linear_velocity": rounded(3, 1.0),
                "commands": rounded(3, 1.0),
                "angles": directions * motors["angles"][mapping],
                "speeds": directions * motors["speeds"][mapping],
                "actions": actions,
            }
            output = rounded(joints, 1.5)
            frames.append(frame(config["observations"], config, seen))
            now = frame(config.get("observations_nonstack", []), config, seen)
            network = network_input(config, frames, now)
            actions, targets, torques = act(config, output, seen["angles"], seen["speeds"])
            yield {
                "starts": step == 0,
                "xyzw": xyzw.tolist(),
                "world_rates_rps": world_rates.tolist(),
                "linear_velocity_mps": seen["linear_velocity"].tolist(),
                "commands": seen["commands"].tolist(),
                "motor_angles_rad": motors["angles"].tolist(),
                "motor_speeds_rps": motors["speeds"].tolist(),
                "output": output.tolist(),
                "expected": {
                    "input": network.tolist(),
                    "actions": actions.tolist(),
                    "targets": targets.tolist(),
                    "torques_nm": torques.tolist(),
                },
            }


def base(joints, wheels, mapping, names=None):
    """Keys of a robot."""
    is_wheel = [n in wheels for n in range(joints)]
    by = lambda wheel, other: [wheel if it else other for it in is_wheel]
    return {
        "dt": 0.005,
        "decimation": 4,
        "num_of_dofs": joints,
        "joint_names": names or [f"joint_{n}" for n in range(joints)],
        "joint_mapping": mapping,
        "wheel_indices": wheels,
        "default_dof_pos": [0.0 if it else round(0.1 * n - 0.3, 1) for n, it in enumerate(is_wheel)],
        "torque_limits": by(2.5, 6.0),
        "fixed_kp": by(0.0, 40.0),
        "fixed_kd": by(0.5, 1.0),
    }


def policy(joints, wheels, observations, **more):
    """Keys of a policy."""
    is_wheel = [n in wheels for n in range(joints)]
    by = lambda wheel, other: [wheel if it else other for it in is_wheel]
    return {
        "model_name": "policy.onnx",
        "observations": observations,
        "observations_history": [],
        "observations_history_priority": "time",
        "clip_obs": 100.0,
        "clip_actions_lower": [-100.0] * joints,
        "clip_actions_upper": [100.0] * joints,
        "rl_kp": by(0.0, 20.0),
        "rl_kd": by(0.3, 0.8),
        "action_scale": by(5.0, 0.25),
        "lin_vel_scale": 2.0,
        "ang_vel_scale": 0.25,
        "dof_pos_scale": 1.0,
        "dof_vel_scale": 0.05,
        "commands_scale": [2.0, 2.0, 0.25],
    } | more


PLAIN = ["ang_vel", "gravity_vec", "commands", "dof_pos", "dof_vel", "actions"]
COMMANDS_FIRST = ["commands", "ang_vel", "gravity_vec", "dof_pos", "dof_vel", "actions"]
FIVEBAR = ["dof_pos", "dof_vel", "wheel_joint_vel", "ang_vel", "gravity_vec", "actions"]
FIVEBAR_NAMES = ["left_wheel", "right_wheel", "left_front_hip", "left_rear_hip", "right_front_hip", "right_rear_hip"]
SWAPPED_LEGS = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8]
INTERLEAVED = [0, 6, 12, 1, 7, 13, 2, 8, 14, 3, 9, 15, 22, 4, 10, 16, 23, 5, 11, 17, 24, 18, 25, 19, 26, 20, 27, 21, 28]

ROBOTS = {
    "fivebar": base(6, [4, 5], [2, 3, 4, 5, 0, 1], FIVEBAR_NAMES),
    "two-wheels": base(8, [6, 7], list(range(8))),
    "legs": base(12, [], SWAPPED_LEGS),
    "legs-and-wheels": base(16, [3, 7, 11, 15], list(range(16))),
    "person": base(29, [], INTERLEAVED),
    "mirrored": base(4, [3], [1, 3, 0, 2]) | {"joint_directions": [1, -1, -1, -1]},
}

POLICIES = {
    "fivebar/flat": policy(
        6, [4, 5], FIVEBAR, num_observations=69, observations_history=[0, 1, 2], observations_nonstack=["commands"]
    ),
    "fivebar/flat-by-term": policy(
        6, [4, 5], FIVEBAR, observations_history=[2, 1, 0], observations_history_priority="term",
        observations_nonstack=["commands", "gravity_vec"], wheel_indices=[5, 4],
    ),
    "two-wheels/plain": policy(8, [6, 7], PLAIN, num_observations=33),
    "two-wheels/clipped": policy(
        8, [6, 7], PLAIN, clip_obs=0.5, clip_actions_lower=[-0.5] * 8, clip_actions_upper=[1.0] * 7 + [0.25]
    ),
    "two-wheels/unclipped": policy(8, [6, 7], PLAIN, clip_actions_lower=[], clip_actions_upper=[]),
    "legs/newest-first": policy(
        12, [], COMMANDS_FIRST, num_observations=45, observations_history=[0, 1, 2, 3, 4, 5]
    ),
    "legs/by-term": policy(
        12, [], PLAIN, observations_history=[0, 1, 2], observations_history_priority="term"
    ),
    "legs/with-gaps": policy(12, [], PLAIN, observations_history=[0, 2, 5]),
    "legs/velocity": policy(
        12, [], ["lin_vel", "ang_vel", "gravity_vec", "commands", "dof_pos", "dof_vel", "actions"],
        num_observations=48, lin_vel_scale=1.5, dof_pos_scale=0.5, commands_scale=[0.5, 1.5, 3.0],
    ),
    "legs-and-wheels/oldest-first": policy(
        16, [3, 7, 11, 15], PLAIN, num_observations=57, observations_history=[9, 8, 7, 6, 5, 4, 3, 2, 1, 0]
    ),
    "person/overriding": policy(
        29, [], ["ang_vel", "gravity_vec", "dof_pos", "dof_vel", "actions"],
        default_dof_pos=[0.05 * (n % 5) for n in range(29)], torque_limits=[10.0] * 29, dt=0.002, decimation=10,
    ),
    "mirrored/flat": policy(4, [3], ["dof_pos", "dof_vel", "actions"]),
}


def as_yaml(top, keys):
    lines = [f"  {key}: {json.dumps(value)}" for key, value in keys.items()]
    return "\n".join([f"{top}:", *lines, ""])


def main(folder):
    for robot, keys in ROBOTS.items():
        place = folder / "policies" / robot
        place.mkdir(parents=True, exist_ok=True)
        (place / "base.yaml").write_text(as_yaml(robot, keys))
    for seed, (name, keys) in enumerate(POLICIES.items()):
        robot = name.split("/")[0]
        place = folder / "policies" / name
        place.mkdir(parents=True, exist_ok=True)
        (place / "config.yaml").write_text(as_yaml(name, keys))
        run = list(steps(ROBOTS[robot] | keys, np.random.default_rng(seed)))
        lines = ",\n".join(json.dumps(step) for step in run)
        (folder / f"{name.replace('/', '-')}.json").write_text(f"[\n{lines}\n]\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
