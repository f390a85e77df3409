"""Searches how a policy balances, in the model of `planar.py`: minutes on one processor.

    python train/planar_search.py --out target/train/planar.npz      # and its curves, planar.png

A policy is 21 factors. Robots differ as in the environment; each is pushed along its wheels, then follows a speed. The push
grows as long as the robots survive it. A wheel that is read at 31.5 rad/s ends a trial: 32.5 ends a run (docs/policy.md).
"""

import argparse
import json
import pathlib
import time

import jax
import jax.numpy as jnp
import numpy

import planar
from evolution import Evolution

# N·m/rad, N·m·s/rad of a hip, N·m·s/rad of a wheel: rl_kp and rl_kd of `policy/fivebar/flat/config.yaml`.
GAINS = (40.0, 1.0, 0.3)
STOP_RPS, TILT_RAD = 31.5, 1.0
# name: guess, spread
FACTORS = {
    # Torque of the wheels in N·m, by pitch, its rate and how it changes, error of speed, swing, its rate and its target.
    "pitch_nm": (10.0, 3.0), "rate_nm": (2.2, 0.5), "lead": (0.5, 0.2), "speed_nm": (0.18, 0.05), "swing_nm": (0.0, 3.0),
    "swing_rate_nm": (-0.2, 0.15), "held_nm": (-4.0, 3.0), "falls_nm": (4.0, 2.0), "fast_nm": (0.2, 0.1),
    # Errors of the wheels in rad/s count as this at most.
    "most_rps": (9.0, 2.0), "most_held_rps": (2.0, 0.7),
    # Swing of the axles forward in rad: it keeps what an error of speed adds to it.
    "hold": (0.0015, 0.0006), "pitch_rad": (0.4, 0.15), "rate_rad": (0.03, 0.02), "speed_rad": (0.01, 0.006), "swing_rad": (0.1, 0.15),
    "swing_rate_rad": (-0.03, 0.02), "falls_rad": (0.0, 0.05),
    # A robot falls by so much as rate + fall_pitch · pitch + fall_speed · error of speed is beyond falls_at.
    "fall_pitch": (5.5, 0.8), "fall_speed": (0.0, 0.05), "falls_at": (3.5, 0.6),
}
NAMES = list(FACTORS)
GUESS, SPREAD = (numpy.array([pair[n] for pair in FACTORS.values()]) for n in (0, 1))
# A leg goes to its length by this share a step.
STANDS_BY = 0.12
# Share of the robots that may fall while the push still grows.
FALLS = 0.12


def beyond(value, most):
    """By how much a value is outside of ±most."""
    return value - jnp.clip(value, -most, most)


def quick(f, pitch, rate, turns, lean, lean_rate, speed_rps):
    """The part of the swing that is not kept."""
    error = jnp.clip(turns - speed_rps, -f["most_rps"], f["most_rps"])
    falls = rate + f["fall_pitch"] * pitch + f["fall_speed"] * error
    now = f["pitch_rad"] * pitch + f["rate_rad"] * rate + f["speed_rad"] * error + f["swing_rad"] * lean
    return now + f["swing_rate_rad"] * lean_rate + f["falls_rad"] * beyond(falls, f["falls_at"]), error, falls


def act(f, now, before, last, speed_rps, stand_rad):
    """Targets of swing and fold in rad, and torque of a wheel in N·m. `last` are the last targets."""
    pitch, rate, turns, lean, lean_rate = now[:5]
    quick_now, error, falls = quick(f, *now[:5], speed_rps)
    quick_before = quick(f, *before[:5], speed_rps)[0]
    held = f["hold"] * jnp.clip(turns - speed_rps, -f["most_held_rps"], f["most_held_rps"])
    swing = jnp.clip(last[0] + quick_now - quick_before + held, -1.0, 1.0)
    fold = (1 - STANDS_BY) * last[1] + STANDS_BY * stand_rad
    torque = f["pitch_nm"] * pitch + f["rate_nm"] * (rate + f["lead"] * (rate - before[1])) + f["speed_nm"] * error
    torque = torque + f["swing_nm"] * lean + f["swing_rate_nm"] * lean_rate + f["held_nm"] * last[0]
    torque = torque + f["falls_nm"] * beyond(falls, f["falls_at"]) - f["fast_nm"] * beyond(turns, 26.0)
    return swing, fold, jnp.clip(torque, -planar.WHEEL_NM, planar.WHEEL_NM)


def trials(f, robot, trial, stand_rad):
    """Cost, falls and, at each step, the error of speed in m/s."""
    zero = jnp.zeros_like(robot["kg"])
    state = planar.start(stand_rad + 0.05, trial["speed_mps"], trial["pitch_rad"])
    first = planar.seen(state, robot)
    stand = zero + stand_rad

    def once(carry, now):
        state, before, last, fallen, cost, last_nm = carry
        speed_mps, push_n, weight = now
        view = planar.seen(state, robot)
        swing, fold, torque = act(f, view, before, last, speed_mps / planar.RADIUS_M, stand_rad)
        target = (swing, fold, jnp.clip(view[2] + torque / GAINS[2], -80.0, 80.0))
        moved = planar.step(state, robot, last, target, GAINS, push_n)
        turns = jnp.abs(planar.turning(moved))
        lean = moved["theta"] - moved["phi"]
        out = (jnp.abs(moved["theta"]) > TILT_RAD) | (jnp.abs(moved["phi"]) > 1.0) | (jnp.abs(lean) > 1.05)
        fallen = fallen | out | (turns > STOP_RPS) | ~jnp.isfinite(moved["v"]) | (moved["fold"] > 0.35) | (moved["fold"] < -1.85)
        state = {name: jnp.where(fallen, state[name], moved[name]) for name in state}
        length, *_ = planar.leg(state["fold"])
        error = state["v"] + length * state["dphi"] - speed_mps
        paid = weight * jnp.minimum(error**2, 1.0) / 0.15**2 + 0.1 * (torque - last_nm) ** 2 + 0.04 * jnp.maximum(turns - 28, 0) ** 2
        paid = paid + 20 * jnp.maximum(jnp.abs(state["theta"]) - 0.8, 0) ** 2 + 20 * (swing - last[0]) ** 2
        paid = paid + 0.2 * jnp.maximum(15.0 - state["normal_n"], 0.0) / 15.0
        cost = cost + jnp.where(fallen, 1.0, jnp.minimum(planar.STEP_S * paid, 3.0))
        return (state, view, target, fallen, cost, torque), error

    begin = (state, first, (zero, stand, zero), zero > 1, zero, zero)
    (*_, fallen, cost, _), errors = jax.lax.scan(once, begin, (trial["command_mps"], trial["push_n"], trial["weight"]))
    return cost, fallen, errors


def draw(numbers, count, push_mps, steps=300, pushed_at=70, drives_at=190):
    """Robots, and for each a push and then a speed that is reached at 1 m/s²."""
    robot = planar.robots(numbers, count)
    speed_mps = numbers.uniform(-1.5, 1.5, count) * (numbers.random(count) < 0.7)
    grown = numpy.clip((numpy.arange(steps)[:, None] - drives_at) * planar.STEP_S, 0, None)
    push_n = numpy.zeros((steps, count))
    side = numpy.where(numpy.arange(count) % 2, 1.0, -1.0)
    push_n[pushed_at] = side * push_mps * (planar.AXLE_KG + numpy.asarray(robot["kg"])) / (planar.STEP_S / 2)
    weight = numpy.zeros((steps, count))
    weight[40:pushed_at] = weight[pushed_at + 60 :] = 0.3
    weight[pushed_at + 100 :] = 1.0
    trial = {
        "speed_mps": numbers.uniform(-0.2, 0.2, count), "pitch_rad": numbers.uniform(-0.08, 0.08, count),
        "command_mps": numpy.sign(speed_mps) * numpy.minimum(grown, numpy.abs(speed_mps)), "push_n": push_n, "weight": weight,
    }
    return robot, {name: jnp.asarray(value, jnp.float32) for name, value in trial.items()}


def judge(stand_rad):
    """Returns the function that tries sets of factors, one a row, with all robots: cost, share that falls, error of speed."""

    @jax.jit
    def run(sets, robot, trial):
        count, sets_count = robot["kg"].shape[0], sets.shape[0]
        f = {name: jnp.repeat(sets[:, index], count) for index, name in enumerate(NAMES)}
        wide = lambda values: jnp.tile(values, (1,) * (values.ndim - 1) + (sets_count,))
        cost, fallen, errors = trials(f, jax.tree.map(wide, robot), jax.tree.map(wide, trial), stand_rad)
        counts = (wide(trial["weight"]) >= 1.0) & ~fallen
        of = lambda values: values.reshape(-1, sets_count, count)
        rms = jnp.sqrt(of(jnp.where(counts, errors**2, 0.0)).sum((0, 2)) / jnp.maximum(of(counts).sum((0, 2)), 1))
        return of(cost)[0].mean(1), of(fallen)[0].mean(1), rms

    return run


def search(arguments):
    numbers = numpy.random.default_rng(arguments.seed)
    begun = dict(zip(NAMES, GUESS)) if arguments.begin is None else numpy.load(arguments.begin)
    middle = numpy.array([float(begun[name]) for name in NAMES])
    cloud = Evolution(numpy.zeros(len(NAMES)), arguments.size, arguments.sets, numbers)
    run, push_mps, falls, rows = judge(arguments.stand_rad), arguments.first_push_mps, 0.5, []
    began = time.perf_counter()
    for generation in range(arguments.generations):
        # The robots of a generation are the same for all of its sets.
        robot, trial = draw(numpy.random.default_rng([arguments.seed, generation]), arguments.robots, push_mps)
        sets = middle + SPREAD * cloud.ask()
        cost, fallen, rms = map(numpy.asarray, run(jnp.asarray(sets, jnp.float32), robot, trial))
        cost = numpy.where(numpy.isfinite(cost), cost, 1e6)
        cloud.tell(cost)
        half = numpy.argsort(cost, kind="stable")[: arguments.sets // 2]
        falls = 0.8 * falls + 0.2 * float(fallen[half].mean())
        rows.append([generation, push_mps, float(cost[half].mean()), falls, float(rms[half].mean())])
        if falls < FALLS:
            push_mps = min(arguments.push_mps, push_mps + 0.02)
        if generation % 20 == 19 or generation + 1 == arguments.generations:
            print(
                f"generation {generation + 1}: push {push_mps:.2f} m/s, cost {rows[-1][2]:.1f}, falls {falls:.3f}, "
                f"speed {rows[-1][4]:.3f} m/s rms, {time.perf_counter() - began:.0f} s", flush=True,
            )
    return middle + SPREAD * cloud.mean, rows


def curves(rows, path):
    """Draws the push that robots get, the share that falls, and the error of speed, by generation."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    generations, push_mps, _, falls, rms_mps = numpy.array(rows).T
    figure, axes = plot.subplots(3, 1, figsize=(8, 6), sharex=True)
    for axis, values, label in zip(axes, (push_mps, 100 * falls, rms_mps), ("push, m/s", "robots that fall, %", "error of speed, m/s")):
        axis.plot(generations, values, linewidth=1)
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("generation")
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file for the factors, .npz")
    parser.add_argument("--generations", type=int, default=180, help="generations (180)")
    parser.add_argument("--sets", type=int, default=24, help="sets of factors in a generation (24)")
    parser.add_argument("--robots", type=int, default=64, help="robots that try each set (64)")
    parser.add_argument("--begin", type=pathlib.Path, help="file of an earlier search to go on with (none)")
    parser.add_argument("--size", type=float, default=0.5, help="first size of the cloud, in spreads (0.5)")
    parser.add_argument("--first-push-mps", type=float, default=0.5, help="push at first (0.5)")
    parser.add_argument("--push-mps", type=float, default=1.1, help="greatest push (1.1)")
    parser.add_argument("--stand-rad", type=float, default=-1.2, help="front hips of a standing robot, from the default (-1.2)")
    parser.add_argument("--seed", type=int, default=1, help="seed (1)")
    arguments = parser.parse_args()
    factors, rows = search(arguments)
    for push_mps in (0.0, 0.8, 0.9, 1.0):
        robot, trial = draw(numpy.random.default_rng([arguments.seed, 10**6]), 500, push_mps)
        cost, fallen, rms = judge(arguments.stand_rad)(jnp.asarray(factors[None], jnp.float32), robot, trial)
        print(f"500 other robots, push {push_mps:.1f} m/s: {100 * (1 - float(fallen[0])):.1f} % survive, speed {float(rms[0]):.3f} m/s rms")
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    said = json.dumps({name: str(value) for name, value in vars(arguments).items() if not isinstance(value, pathlib.Path)})
    numpy.savez(arguments.out, **dict(zip(NAMES, factors)), stand_rad=arguments.stand_rad, rows=numpy.array(rows), arguments=said)
    curves(rows, arguments.out.with_suffix(".png"))
    print({name: round(float(value), 4) for name, value in zip(NAMES, factors)})


if __name__ == "__main__":
    main()
