"""Refines a policy on the whole robot: the factors of the plane, and those of sitting, roll and turns.

    python train/planar_search.py --out target/train/planar.npz
    python train/whole_search.py target/train/planar.npz --out target/train/whole.npz

Each set is tried by the same robots: they sit or stand, are pushed, and follow a speed and a turn. Robots change from time to time.
"""

import argparse
import json
import pathlib
import time

import numpy

import balance
import circuit
import jiling_gym
import planar_search
from evolution import Evolution

STEP_S = 0.02
# s: pushed after sitting or standing, drives, ends
PUSHED_S, DRIVES_S, ENDS_S = {"sitting": 3.0, "standing": 0.6}, 5.0, 8.0
SPREADS = {**{name: 0.25 * spread for name, (_, spread) in planar_search.FACTORS.items()}, **{name: spread for name, (_, spread) in balance.FACTORS.items()}}


class Trial:
    """Robots that try one set of factors after another."""

    def __init__(self, start, robots, threads, seed, push_mps, ends_s):
        options = {"start": start, "push_mps": 0.0, "episode_s": 1e6, "episodes_per_robot": 1_000_000}
        self.envs = jiling_gym.FivebarVec(robots, threads, seed, **options)
        numbers = numpy.random.default_rng(seed)
        self.speeds_mps = numbers.uniform(-1.2, 1.2, robots)
        self.turns_rps = numbers.uniform(-1.5, 1.5, robots)
        # Half along the wheels, half in any direction.
        along = numpy.where(numpy.arange(robots) % 4 < 2, 0.0, numpy.pi)
        self.angles = numpy.where(numpy.arange(robots) % 2, along, numbers.uniform(-numpy.pi, numpy.pi, robots))
        self.push_mps, self.ends, self.pushed_s = push_mps, round(ends_s / STEP_S), PUSHED_S[start]

    def command(self, step):
        """Speeds and turn rates are reached after a second."""
        share = numpy.clip(step * STEP_S - DRIVES_S, 0.0, 1.0)
        for robot, (speed_mps, turn_rps) in enumerate(zip(self.speeds_mps, self.turns_rps)):
            self.envs.fleet.command(robot, share * speed_mps, share * turn_rps)
        return share * self.speeds_mps

    def cost(self, factors):
        """Mean cost of the robots: the time lost by falling, and errors of speed while up."""
        layers = balance.network(factors)
        seen, _ = self.envs.reset()
        count = len(seen)
        up, cost = numpy.ones(count, bool), numpy.zeros(count)
        for step in range(self.ends):
            wanted_mps = self.command(step)
            if step == round(self.pushed_s / STEP_S):
                for robot, angle in enumerate(self.angles):
                    self.envs.fleet.push(robot, self.push_mps * numpy.cos(angle), self.push_mps * numpy.sin(angle))
            seen, _, fallen, _, _ = self.envs.step(circuit.run(layers, seen).astype(numpy.float32))
            up &= ~fallen
            if not up.any():
                return float((cost + 4.0 * (self.ends - step) / self.ends).mean())
            turns = seen[:, balance.WHEELS : balance.WHEELS + 2].mean(1) / balance.SPEED
            error = numpy.minimum(numpy.abs(turns * balance.RADIUS_M - wanted_mps), 0.5) / 0.5
            late = step * STEP_S > DRIVES_S or self.pushed_s - 1.0 < step * STEP_S < self.pushed_s
            cost += numpy.where(up, 0.6 * error**2 * late, 4.0) / self.ends
        # A robot that falls early loses all that follows, one that falls late little: falls count by themselves.
        return float((cost + 1.0 * ~up).mean())


def search(arguments, factors):
    names = [name for name in SPREADS if not arguments.only or name in arguments.only.split(",")]
    middle = numpy.array([factors[name] for name in names])
    spread = numpy.array([SPREADS[name] for name in names])
    cloud = Evolution(numpy.zeros(len(names)), 0.5, arguments.sets, numpy.random.default_rng(arguments.seed))
    rows, began, trial = [], time.perf_counter(), None
    for generation in range(arguments.generations):
        if generation % arguments.same == 0:
            trial = Trial(arguments.start, arguments.robots, arguments.threads, arguments.seed * 1000 + generation, arguments.push_mps, arguments.seconds)
        sets = middle + spread * cloud.ask()
        costs = numpy.array([trial.cost({**factors, **dict(zip(names, one))}) for one in sets])
        cloud.tell(costs)
        rows.append([generation, float(costs.mean()), float(costs.min())])
        print(f"generation {generation + 1}: cost {costs.mean():.3f}, best {costs.min():.3f}, size {cloud.size:.2f}, {time.perf_counter() - began:.0f} s", flush=True)
        # What was found so far is kept, so that the search may be stopped.
        save(arguments, {**factors, **dict(zip(names, middle + spread * cloud.mean))}, rows)


def save(arguments, factors, rows):
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    said = json.dumps({name: str(value) for name, value in vars(arguments).items() if not isinstance(value, pathlib.Path)})
    numpy.savez(arguments.out, **factors, rows=numpy.array(rows), arguments=said)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("planar", type=pathlib.Path, help="file of planar_search.py, or of this program")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file for the factors, .npz")
    parser.add_argument("--generations", type=int, default=4, help="generations (4)")
    parser.add_argument("--sets", type=int, default=10, help="sets of factors in a generation (10)")
    parser.add_argument("--robots", type=int, default=24, help="robots that try each set (24)")
    parser.add_argument("--same", type=int, default=20, help="generations with the same robots (20)")
    parser.add_argument("--seconds", type=float, default=ENDS_S, help="length of a trial (8)")
    parser.add_argument("--start", choices=list(PUSHED_S), default="sitting", help="how a trial begins (sitting)")
    parser.add_argument("--push-mps", type=float, default=1.0, help="push (1.0)")
    parser.add_argument("--only", default="", help="names of the factors to be searched, with commas between (all)")
    parser.add_argument("--threads", type=int, default=0, help="threads, 0 for one a processor (0)")
    parser.add_argument("--seed", type=int, default=1, help="seed (1)")
    arguments = parser.parse_args()
    search(arguments, balance.factors_of(arguments.planar))


if __name__ == "__main__":
    main()
