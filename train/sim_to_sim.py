"""Drives the robot's MJCF in MuJoCo with the policy: another simulator, in which it was not trained.

    cargo xtask robot mjcf fivebar --out target/fivebar.xml
    python train/sim_to_sim.py target/fivebar.xml policy/fivebar/flat/policy.onnx --out target/sim_to_sim.png

The policy runs at 50 Hz, and the motors' laws at 1 kHz: torque = kp (target - angle) - kd speed of a hip, kd (target - speed)
of a wheel, within the firmware's limits and those of the file. The robot stands, drives forward and back, turns, and is
pushed. Exit code 0 if it stays up.
"""

import argparse
import pathlib

import mujoco
import numpy

HIPS = ["left_front_hip", "left_rear_hip", "right_front_hip", "right_rear_hip"]
WHEELS = ["left_wheel", "right_wheel"]
# policy/fivebar: default angles, gains, limits of the firmware in N m, scales.
DEFAULT_RAD = numpy.array([0.7, -0.7, 0.7, -0.7])
HIP_KP, HIP_KD, WHEEL_KD = 40.0, 1.0, 0.3
LIMITS_NM = numpy.array([5.0] * 4 + [4.5] * 2)
# Wheels faster than this read so on the PC link.
FASTEST_RPS = 33.0
CLIP = numpy.array([8.0] * 6)
# Of speed and turn rate (commands_scale).
COMMAND_SCALE = (0.96, 0.5)
POLICY_S, MOTOR_S = 0.02, 0.001
# From reading to motors.
LATENCY_S = 0.005
# Time in s, speed in m/s, turn rate in rad/s.
COURSE = ((0, 0, 0), (3, 0, 0), (4, 1, 0), (7, 1, 0), (8, 0, 0), (9, -1, 0), (12, -1, 0), (13, 0, 0), (14, 0, 2), (17, 0, 2), (18, 0, 0), (25, 0, 0))
# Time in s, change of speed forward and to the left in m/s.
PUSHES = ((19.0, 1.0, 0.0), (22.0, 0.0, 1.0))


class Robot:
    """The model and what the policy sees of it."""

    def __init__(self, file):
        self.model = mujoco.MjModel.from_xml_path(str(file))
        self.data = mujoco.MjData(self.model)
        mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key("stand").id)
        mujoco.mj_forward(self.model, self.data)
        joints = [self.model.joint(name) for name in HIPS + WHEELS]
        self.places = [joint.qposadr[0] for joint in joints]
        self.speeds = [joint.dofadr[0] for joint in joints]
        self.mass_kg = self.model.body_subtreemass[0]
        self.substeps = round(MOTOR_S / self.model.opt.timestep)

    def frame(self, last):
        """One frame of the observation."""
        angles, speeds = self.data.qpos[self.places], self.data.qvel[self.speeds]
        turn = self.data.body("body").xmat.reshape(3, 3)
        wheels = speeds[4:].clip(-FASTEST_RPS, FASTEST_RPS)
        gravity = turn.T @ [0, 0, -1]
        return numpy.concatenate([angles[:4] - DEFAULT_RAD, 0.05 * speeds[:4], 0.05 * wheels, 0.25 * self.data.qvel[3:6], gravity, last])

    def step(self, actions, force_n):
        """A period of the motors."""
        angles, speeds = self.data.qpos[self.places], self.data.qvel[self.speeds]
        hips = HIP_KP * (DEFAULT_RAD + 0.25 * actions[:4] - angles[:4]) - HIP_KD * speeds[:4]
        wheels = WHEEL_KD * (10.0 * actions[4:] - speeds[4:])
        self.data.ctrl[:] = numpy.concatenate([hips, wheels]).clip(-LIMITS_NM, LIMITS_NM)
        self.data.xfrc_applied[self.model.body("body").id, :3] = force_n
        for _ in range(self.substeps):
            mujoco.mj_step(self.model, self.data)

    def seen(self):
        """Speed forward, turn rate, pitch, height."""
        turn = self.data.body("body").xmat.reshape(3, 3)
        ahead = numpy.array([turn[0, 0], turn[1, 0]]) / numpy.hypot(turn[0, 0], turn[1, 0])
        pitch = numpy.arcsin((-turn[2, 0]).clip(-1, 1))
        return [self.data.qvel[:2] @ ahead, (turn @ self.data.qvel[3:6])[2], pitch, self.data.qpos[2]]

    def tilt_rad(self):
        return numpy.arccos(self.data.body("body").xmat[8].clip(-1, 1))


def run(robot, network):
    """Returns rows of time, commands and what was seen, and whether it stayed up."""
    pose = robot.data.qpos[robot.places][:4]
    last = numpy.concatenate([(pose - DEFAULT_RAD) / 0.25, [0.0, 0.0]])
    frames = [robot.frame(last)] * 3
    times, speeds, turns = zip(*COURSE)
    rows, acting = [], last
    for step in range(round(times[-1] / POLICY_S)):
        now = step * POLICY_S
        command = [numpy.interp(now, times, values) for values in (speeds, turns)]
        if step:
            frames = [robot.frame(last), *frames[:2]]
        x = numpy.concatenate([*frames, [COMMAND_SCALE[0] * command[0], 0.0, COMMAND_SCALE[1] * command[1]]]).astype(numpy.float32)
        last = network(x).clip(-CLIP, CLIP)
        for tick in range(round(POLICY_S / MOTOR_S)):
            if tick * MOTOR_S >= LATENCY_S:
                acting = last
            force = numpy.zeros(3)
            for at, ahead, left in PUSHES:
                if at <= now + tick * MOTOR_S < at + 0.01:
                    force = robot.mass_kg / 0.01 * heading(robot, ahead, left)
            robot.step(acting, force)
        rows.append([now, *command, *robot.seen()])
        if robot.tilt_rad() > 0.9:
            return numpy.array(rows), False
    return numpy.array(rows), True


def heading(robot, ahead, left):
    turn = robot.data.body("body").xmat.reshape(3, 3)
    x, y = numpy.array([turn[0, 0], turn[1, 0]]) / numpy.hypot(turn[0, 0], turn[1, 0])
    return numpy.array([ahead * x - left * y, ahead * y + left * x, 0.0])


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    figure, axes = plot.subplots(3, 1, figsize=(9, 7), sharex=True)
    for axis, name, wished, found in ((axes[0], "speed, m/s", 1, 3), (axes[1], "turn rate, rad/s", 2, 4)):
        axis.plot(rows[:, 0], rows[:, wished], "k--", linewidth=0.8, label="command")
        axis.plot(rows[:, 0], rows[:, found], linewidth=1, label="MuJoCo")
        axis.set_ylabel(name)
    axes[2].plot(rows[:, 0], numpy.degrees(rows[:, 5]), linewidth=1)
    axes[2].set_ylabel("pitch, °")
    axes[2].set_xlabel("s")
    axes[0].legend(loc="upper right", fontsize=8)
    for axis in axes:
        axis.grid(alpha=0.3)
        for at, *_ in PUSHES:
            axis.axvline(at, color="C3", linewidth=0.8)
    axes[0].set_title("The policy in MuJoCo; red lines are pushes", fontsize=10)
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mjcf", type=pathlib.Path, help="the robot's MJCF")
    parser.add_argument("policy", type=pathlib.Path, help="file of the network, .onnx")
    parser.add_argument("--out", type=pathlib.Path, help="picture, .png")
    arguments = parser.parse_args()
    import onnxruntime

    session = onnxruntime.InferenceSession(arguments.policy, providers=["CPUExecutionProvider"])
    network = lambda x: session.run(None, {"obs": x[None]})[0][0]
    rows, upright = run(Robot(arguments.mjcf), network)
    if arguments.out:
        draw(rows, arguments.out)
    error = rows[rows[:, 0] < PUSHES[0][0]]
    speed, turn = (numpy.sqrt(((error[:, found] - error[:, wished]) ** 2).mean()) for wished, found in ((1, 3), (2, 4)))
    print(f"{'stays up' if upright else 'falls'} for {rows[-1, 0] + POLICY_S:.1f} s; up to the pushes rms of speed {speed:.3f} m/s, of turn {turn:.3f} rad/s")
    raise SystemExit(0 if upright else 1)


if __name__ == "__main__":
    main()
