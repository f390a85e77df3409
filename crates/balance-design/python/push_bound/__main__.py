"""What any controller could make of a push: optimal control of the robot in the plane of its wheels.

The motion knows the robot, the ground and the push in advance, and its torques come at once or after a given delay. So no
controller can count on more. IPOPT finds a best motion near its guess: what it finds is possible, and something better
somewhere else is not ruled out. docs/decisions/push.md has what it gave.

Needs Python 3.11 with casadi, and matplotlib for --plot.
"""

import argparse
import json
import sys
from dataclasses import replace

# Nothing is to appear beside the sources.
sys.dont_write_bytecode = True

from motion import Motion, Question
from robot import Robot, Variation

FRICTIONS = [0.8, 0.6, 0.5, 0.4, 1.0, 1.2]
VARIATIONS = {
    "as in its file": Variation(),
    "mass +40 %": Variation(mass=1.4),
    "torque -10 %": Variation(torque=0.9),
}


def arguments():
    parser = argparse.ArgumentParser(
        prog="push_bound", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("robot", help="the robot's file, such as robots/fivebar.toml")
    parser.add_argument(
        "--goal",
        choices=["still", "criterion", "largest"],
        default="still",
        help="least time until it stands again; until speed and pitch stay within 5 cm/s and 2 degrees; or the largest push",
    )
    parser.add_argument("--push", type=float, default=1.5, help="speed in m/s that it gives to the whole robot")
    parser.add_argument("--friction", type=float, default=0.8, help="between tyres and ground")
    parser.add_argument("--mass", type=float, default=1.0, help="factor of the robot's mass; the body takes it")
    parser.add_argument("--torque", type=float, default=1.0, help="factor of the wheels' torque")
    parser.add_argument("--hips", type=float, help="torque limit of the hips in N·m; that of the file unless given")
    parser.add_argument("--height", type=float, default=0.195, help="leg length in m before and after")
    parser.add_argument("--delay", type=float, default=0.0, help="seconds without reaction, at most 0.01")
    parser.add_argument("--level", action="store_true", help="the body stays level and at its height")
    parser.add_argument("--slips", action="store_true", help="wheels may slip, and then have all their friction")
    parser.add_argument("--intervals", type=int, default=32, help="of the motion; fewer are faster and less exact")
    parser.add_argument("--table", action="store_true", help="the goal over friction, mass and torque; takes minutes")
    parser.add_argument("--motion", action="store_true", help="print the motion")
    parser.add_argument("--plot", metavar="FILE", help="draw the motion, as .svg or .png")
    parser.add_argument("--json", action="store_true", help="print the answer for a program")
    parser.add_argument("--accelerations", action="store_true", help="answer poses on standard input; for tests")
    parser.add_argument("--talks", action="store_true", help="show IPOPT's iterations")
    return parser.parse_args()


def main():
    args = arguments()
    question = Question(
        goal=args.goal,
        push_mps=args.push,
        friction=args.friction,
        height_m=args.height,
        delay_s=args.delay,
        level=args.level,
        slips=args.slips,
        intervals=args.intervals,
    )
    if args.table:
        table(args, question)
        return
    robot = Robot(args.robot, Variation(mass=args.mass, torque=args.torque, hip_nm=args.hips))
    if args.accelerations:
        poses = json.load(sys.stdin)
        answers = [robot.accelerations(it["pitch_rad"], it["joints_rad"], it["torques_nm"]) for it in poses]
        json.dump(answers, sys.stdout)
        return
    answer = Motion(robot, question).solve(talks=args.talks)
    if args.json:
        print(json.dumps(as_json(answer)))
    else:
        print(in_words(question, answer))
        if args.motion:
            print_motion(answer)
    if args.plot:
        plot(answer, args.plot)
    sys.exit(0 if answer.found else 1)


def as_json(answer):
    return {
        "found": answer.found,
        "rest_s": answer.rest_s,
        "push_mps": answer.push_mps,
        "times_s": answer.times_s.tolist(),
        "motion": {name: values.tolist() for name, values in answer.seen.items()},
    }


def in_words(question, answer):
    if not answer.found:
        return f"no motion found ({answer.status})"
    if question.goal == "largest":
        return f"stands again after a push of {answer.push_mps:.2f} m/s"
    return f"a push of {answer.push_mps:.2f} m/s is over after {answer.rest_s:.2f} s"


def print_motion(answer):
    print("  ".join(["time_s", *answer.seen]))
    for index, time_s in enumerate(answer.times_s):
        values = (f"{values[index]:{len(name)}.2f}" for name, values in answer.seen.items())
        print("  ".join([f"{time_s:6.3f}", *values]))


def table(args, question):
    """Each motion begins from that with the next friction, which is faster than anew."""
    head = sorted(FRICTIONS)
    print(f"| robot | {' | '.join(f'friction {it}' for it in head)} |", flush=True)
    print(f"|---|{'---|' * len(head)}")
    first = None
    for name, variation in VARIATIONS.items():
        robot = Robot(args.robot, replace(variation, hip_nm=args.hips))
        cells, near = {}, {}
        for friction in FRICTIONS:
            guess = min(near, key=lambda it: abs(it - friction), default=None)
            motion = Motion(robot, replace(question, friction=friction))
            answer = motion.solve(near.get(guess, first))
            if not answer.found:
                answer = motion.solve()
            if answer.found:
                near[friction] = answer.variables
                first = first if first is not None else answer.variables
                push = question.goal == "largest"
                cells[friction] = f"{answer.push_mps:.2f} m/s" if push else f"{answer.rest_s:.2f} s"
        print(f"| {name} | {' | '.join(cells.get(it, 'none') for it in head)} |", flush=True)


def plot(answer, file):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    groups = [
        ("speed, m/s", ["middle_mps", "hip_mps", "axle_mps"]),
        ("angle, rad", ["lean_rad", "pitch_rad"]),
        ("leg, m", ["leg_m", "hip_m"]),
        ("torque, N·m", ["wheel_nm", "front_nm", "rear_nm"]),
        ("force, N", ["load_n", "grip_n"]),
    ]
    figure, axes = pyplot.subplots(len(groups), sharex=True, figsize=(8, 12))
    for axis, (label, names) in zip(axes, groups):
        for name in names:
            axis.plot(answer.times_s, answer.seen[name], label=name)
        axis.set_ylabel(label)
        axis.grid(True)
        axis.legend(loc="right")
    axes[-1].set_xlabel("time since the push began, s")
    figure.savefig(file, bbox_inches="tight")


if __name__ == "__main__":
    main()
