"""Measures environment steps a second.

    python -m jiling_gym.bench --envs 64 --threads 2
    python -m jiling_gym.bench --envs 2 --elf target/thumbv7em-none-eabihf/release/robot-firmware
"""

import argparse
import json
import time

import numpy

from . import FivebarVec


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--envs", type=int, default=64, help="robots (64)")
    parser.add_argument("--threads", type=int, default=0, help="threads, 0 for one a processor (0)")
    parser.add_argument("--elf", help="firmware image to run in the emulated board in place of the app")
    parser.add_argument("--seconds", type=float, default=10.0, help="time to measure in s (10)")
    parser.add_argument("--json", action="store_true", help="print one line of JSON")
    arguments = parser.parse_args()
    options = {"start": "standing", "episodes_per_robot": 1000}
    if arguments.elf:
        # Robots that stay up: a board boots for each episode.
        options = {"built_in": True, "vary": False, "push_mps": 0.0, "episode_s": 1e6}
    envs = FivebarVec(arguments.envs, arguments.threads, elf=arguments.elf, **options)
    actions = numpy.zeros((arguments.envs, 6), numpy.float32)
    steps, processor, began = 0, time.process_time(), time.perf_counter()
    while time.perf_counter() - began < arguments.seconds:
        envs.step(actions)
        steps += arguments.envs
    took, used = time.perf_counter() - began, time.process_time() - processor
    figures = {"steps_per_s": round(steps / took), "steps_per_cpu_s": round(steps / used), "processors": round(used / took, 2)}
    if arguments.json:
        print(json.dumps(figures))
    else:
        print(
            f"{figures['steps_per_s']} environment steps a second on {figures['processors']} processors, "
            f"{figures['steps_per_cpu_s']} a second of one processor"
        )


if __name__ == "__main__":
    main()
