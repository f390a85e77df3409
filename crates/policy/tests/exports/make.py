"""Writes exports as unitree_rl_lab and whole_body_tracking make them, and what such a policy then sees and commands.

Everything is computed with NumPy in double precision from the formulas of docs/policy.md. `python make.py FOLDER` writes
FOLDER/policies/ROBOT/base.yaml, a deploy.yaml below FOLDER/policies/ROBOT/CONFIG, FOLDER/metadata.json, and
FOLDER/ROBOT-CONFIG.json with readings of the motors, targets of the motors, and the input of the network.
"""

import json
import sys
from pathlib import Path

import numpy as np

STEPS = 4
# Motors: left wheel, right wheel, left front, left rear, right front, right rear.
BASE = {
    "dt": 0.005,
    "decimation": 4,
    "num_of_dofs": 6,
    "joint_names": ["left_wheel", "right_wheel", "left_front_hip", "left_rear_hip", "right_front_hip", "right_rear_hip"],
    "joint_mapping": [2, 3, 4, 5, 0, 1],
    "wheel_indices": [4, 5],
    "torque_limits": [5.0, 5.0, 5.0, 5.0, 2.4, 2.4],
    "fixed_kp": [40.0, 40.0, 40.0, 40.0, 0.0, 0.0],
    "fixed_kd": [1.0, 1.0, 1.0, 1.0, 0.3, 0.3],
}

# Joints of the export: left front, right front, left wheel, left rear, right rear, right wheel.
DEPLOY = {
    "joint_ids_map": [2, 4, 0, 3, 5, 1],
    "step_dt": 0.02,
    "stiffness": [0.0, 0.0, 20.0, 21.0, 22.0, 23.0],
    "damping": [0.3, 0.31, 0.8, 0.81, 0.82, 0.83],
    "default_joint_pos": [-0.3, -0.31, 0.0, 0.32, 0.33, 0.0],
    "commands": {
        "base_velocity": {
            "ranges": {"lin_vel_x": [-0.5, 1.0], "lin_vel_y": [0.0, 0.0], "ang_vel_z": [-0.2, 0.2], "heading": None}
        }
    },
    "actions": {
        "JointPositionAction": {
            "clip": [[-0.5, 0.6], [-0.5, 0.6], [-0.7, 0.4], [-0.7, 0.4]],
            "joint_names": [".*_hip"],
            "scale": [0.25, 0.26, 0.27, 0.28],
            "offset": [-0.3, -0.31, 0.32, 0.33],
            "joint_ids": [0, 1, 3, 4],
        },
        "JointVelocityAction": {
            "clip": None,
            "joint_names": [".*_wheel"],
            "scale": [5.0, 6.0],
            "offset": [0.0, 0.0],
            "joint_ids": [2, 5],
        },
    },
    "observations": {
        "base_ang_vel": {"params": {}, "clip": [-1.0, 1.0], "scale": [0.2, 0.2, 0.2], "history_length": 3},
        "projected_gravity": {"params": {}, "clip": None, "scale": [1.0, 1.0, 1.0], "history_length": 1},
        "velocity_commands": {
            "params": {"command_name": "base_velocity"}, "clip": None, "scale": [2.0, 2.0, 0.25], "history_length": 1,
        },
        "joint_pos_rel": {
            "params": {"asset_cfg": {"name": "robot", "joint_ids": [0, 1, 3, 4]}},
            "clip": None, "scale": [1.0, 1.1, 1.2, 1.3], "history_length": 2,
        },
        "joint_vel_rel": {"params": {}, "clip": [-8.0, 8.0], "scale": [0.05] * 6, "history_length": 2},
        "last_action": {"params": {}, "clip": None, "scale": [1.0] * 6, "history_length": 2},
    },
}

# Joints of the export: both wheels, then the hips of both ends. Their motors are found by name.
TRACKED = ["left_wheel", "right_wheel", "left_front_hip", "right_front_hip", "left_rear_hip", "right_rear_hip"]
METADATA = {
    "run_path": "a/run",
    "joint_names": ",".join(TRACKED),
    "joint_stiffness": "0.000,0.000,20.000,21.000,22.000,23.000",
    "joint_damping": "0.300,0.310,0.800,0.810,0.820,0.830",
    "default_joint_pos": "0.000,0.000,-0.300,-0.310,0.320,0.330",
    "command_names": "base_velocity",
    "observation_names": "command,base_ang_vel,projected_gravity,joint_pos_rel_without_wheel,joint_vel,actions",
    "observation_history_lengths": "1,1,1,2,1,3",
    "action_scale": "5.000,6.000,0.250,0.260,0.270,0.280",
    "anchor_body_name": "body",
    "body_names": "body,left_front_shank",
}


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


class FromDeploy:
    """A policy as the deploy.yaml above says it."""

    motors = np.array(DEPLOY["joint_ids_map"])
    default = np.array(DEPLOY["default_joint_pos"])

    def terms(self, seen):
        """Values, limits, factors and history of each term."""
        ranges = DEPLOY["commands"]["base_velocity"]["ranges"]
        lows, highs = zip(*[ranges[key] for key in ("lin_vel_x", "lin_vel_y", "ang_vel_z")])
        angles, speeds = seen["angles"][self.motors], seen["speeds"][self.motors]
        values = {
            "base_ang_vel": seen["body_rates"],
            "projected_gravity": rotation(seen["xyzw"]).T @ [0.0, 0.0, -1.0],
            "velocity_commands": np.clip(seen["commands"], lows, highs),
            "joint_pos_rel": (angles - self.default)[[0, 1, 3, 4]],
            "joint_vel_rel": speeds,
            "last_action": seen["actions"],
        }
        for name, term in DEPLOY["observations"].items():
            yield values[name], term["clip"], term["scale"], term["history_length"]

    def targets(self, output):
        """Targets of the motors."""
        targets, at = np.zeros(6), 0
        for term in DEPLOY["actions"].values():
            for n, joint in enumerate(term["joint_ids"]):
                target = output[at] * term["scale"][n] + term["offset"][n]
                if term["clip"]:
                    target = np.clip(target, *term["clip"][n])
                targets[self.motors[joint]] = target
                at += 1
        return targets


class FromMetadata:
    """A policy as the metadata above say it."""

    motors = np.array([BASE["joint_names"].index(name) for name in TRACKED])
    default = np.array([float(it) for it in METADATA["default_joint_pos"].split(",")])
    scale = np.array([float(it) for it in METADATA["action_scale"].split(",")])
    history = [int(it) for it in METADATA["observation_history_lengths"].split(",")]

    def terms(self, seen):
        angles = seen["angles"][self.motors] - self.default
        angles[[0, 1]] = 0.0
        values = [
            seen["commands"],
            seen["body_rates"],
            rotation(seen["xyzw"]).T @ [0.0, 0.0, -1.0],
            angles,
            seen["speeds"][self.motors],
            seen["actions"],
        ]
        return [(value, None, np.ones(len(value)), history) for value, history in zip(values, self.history)]

    def targets(self, output):
        targets = np.zeros(6)
        targets[self.motors] = output * self.scale + self.default
        return targets


def steps(policy, random):
    """A run of the policy. Each term has a history of its own, its oldest values first."""
    rounded = lambda size, spread: np.round(random.normal(0.0, spread, size), 4)
    actions, past = np.zeros(6), []
    for _ in range(STEPS):
        xyzw = np.round(random.normal(0.0, 1.0, 4), 4)
        xyzw /= np.linalg.norm(xyzw)
        seen = {
            "xyzw": xyzw,
            "body_rates": rounded(3, 2.0),
            "commands": rounded(3, 1.0),
            "angles": rounded(6, 1.0),
            "speeds": rounded(6, 5.0),
            "actions": actions,
        }
        past.append(list(policy.terms(seen)))
        parts = []
        for n, (_, clip, scale, history) in enumerate(past[-1]):
            for age in reversed(range(max(history, 1))):
                value = past[max(len(past) - 1 - age, 0)][n][0]
                parts.append((np.clip(value, *clip) if clip else value) * np.array(scale))
        actions = rounded(6, 1.5)
        yield {
            "xyzw": xyzw.tolist(),
            "body_rates_rps": seen["body_rates"].tolist(),
            "commands": seen["commands"].tolist(),
            "motor_angles_rad": seen["angles"].tolist(),
            "motor_speeds_rps": seen["speeds"].tolist(),
            "output": actions.tolist(),
            "expected": {
                "input": np.concatenate(parts).tolist(),
                "motor_targets": policy.targets(actions).tolist(),
            },
        }


def deploy_yaml():
    """The file, terms in the order of the observation."""
    text = "".join(f"{key}: {json.dumps(value)}\n" for key, value in DEPLOY.items() if key not in ("actions", "observations"))
    for key in ("actions", "observations"):
        terms = DEPLOY[key].items()
        text += f"{key}:\n" + "".join(f"  {name}: {json.dumps(term)}\n" for name, term in terms)
    return text


def whole_robot():
    """An export of a robot without wheels, with all joints in one action."""
    count = 3
    return f"""joint_ids_map: [2, 0, 1]
step_dt: 0.01
stiffness: [20.0, 21.0, 22.0]
damping: [1.0, 1.1, 1.2]
default_joint_pos: [0.1, 0.2, 0.3]
commands: {{}}
actions:
  JointPositionAction:
    clip: null
    joint_names: [.*]
    scale: [0.25, 0.25, 0.25]
    offset: [0.1, 0.2, 0.3]
    joint_ids: !!python/object/apply:builtins.slice [null, null, null]
observations:
  joint_pos_rel:
    params: {{}}
    clip: null
    scale: {[1.0] * count}
    history_length: 5
"""


def write(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def main(folder):
    policies = folder / "policies"
    lines = [f"  {key}: {json.dumps(value)}\n" for key, value in BASE.items()]
    write(policies / "fivebar/base.yaml", "fivebar:\n" + "".join(lines))
    write(policies / "fivebar/lab/deploy.yaml", deploy_yaml())
    three = {key: value[:3] if isinstance(value, list) else value for key, value in BASE.items()}
    three |= {"num_of_dofs": 3, "joint_names": ["a", "b", "c"], "joint_mapping": [0, 1, 2], "wheel_indices": []}
    lines = [f"  {key}: {json.dumps(value)}\n" for key, value in three.items()]
    write(policies / "three/base.yaml", "three:\n" + "".join(lines))
    write(policies / "three/lab/params/deploy.yaml", whole_robot())
    write(folder / "metadata.json", json.dumps(METADATA, indent=1) + "\n")
    for seed, (name, policy) in enumerate([("fivebar-lab", FromDeploy()), ("fivebar-tracked", FromMetadata())]):
        run = ",\n".join(json.dumps(step) for step in steps(policy, np.random.default_rng(seed)))
        write(folder / f"{name}.json", f"[\n{run}\n]\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
