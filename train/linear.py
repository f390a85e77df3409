"""Searches a linear policy that balances: where `ppo.py` begins.

    python train/linear.py --out target/train/linear.npz --generations 12

A wheel's target speed is its own speed and a sum of pitch, pitch rate, error of speed and of turn rate. A hip's target
approaches the standing pose, and shifts the axles against an error of speed. The 17 factors are found by the cross-entropy
method: each generation tries as many sets as there are environments and draws the next around the best.
"""

import argparse
import pathlib

import numpy

import jiling_gym

# Places in the observation of `policy/fivebar/flat`: one frame has 22 values, and commands follow three frames.
HIPS, HIP_SPEEDS, WHEELS, RATES, GRAVITY, LAST = (numpy.arange(a, b) for a, b in ((0, 4), (4, 8), (8, 10), (10, 13), (13, 16), (16, 22)))
FORWARD, TURN = 66, 68
# What the observation is multiplied with (config.yaml).
RATE, SPEED, TURNS = 0.25, 0.05, 0.5
HIP_ACTION_RAD, WHEEL_ACTION_RPS = 0.25, 10.0
RADIUS_M, HALF_TRACK_M = 0.06, 0.21
# Front hips count up when thighs rise, rear hips when they sink.
FRONT = numpy.array([1.0, -1.0, 1.0, -1.0])
LEFT = numpy.array([1.0, 1.0, -1.0, -1.0])

# name: first guess, first spread
FACTORS = {
    "pitch_rps": (45.0, 10.0),  # target speed of the wheels in rad/s per rad of pitch
    "pitch_rate": (5.0, 1.5),  # in rad/s per rad/s
    "speed": (0.4, 0.15),  # per rad/s of the wheels' error
    "pitch_bias": (0.0, 0.2),
    "turn": (2.0, 0.4),  # per rad/s of the wheels' difference in error
    "stand_rad": (-1.0, 0.08),  # of the front hips, from the default pose
    "approach": (0.14, 0.04),  # share of the way to the pose in a step
    "fold_rad": (0.5, 0.25),  # per rad of pitch
    "swing_rad": (0.5, 0.4),  # of the axles forward per rad of pitch, at once
    "shift_rad": (0.1, 0.15),  # of the axles forward per rad of pitch
    "shift_rate": (0.0, 0.01),
    "shift_speed": (0.001, 0.0006),  # in a step, per rad/s of the wheels' error
    "shift_hold": (0.97, 0.01),  # of the last shift that stays: it finds where the centre of mass is
    "shift_bias": (0.0, 0.03),
    "roll_rad": (0.45, 0.15),  # longer left leg per rad of roll to the left
    "roll_rate": (0.02, 0.01),
    "roll_hold": (0.8, 0.08),
}


def matrix(factors):
    """Returns the weights and biases of the linear policy: actions = weights @ observation + biases."""
    f = dict(zip(FACTORS, factors))
    weights, bias = numpy.zeros((6, 69)), numpy.zeros(6)
    for wheel, side in ((0, 1.0), (1, -1.0)):
        row = weights[4 + wheel]
        other = WHEELS[1 - wheel]
        row[WHEELS[wheel]] += 1.0 / SPEED
        row[GRAVITY[0]] += f["pitch_rps"]
        row[RATES[1]] += f["pitch_rate"] / RATE
        for place in WHEELS:
            row[place] += f["speed"] / SPEED / 2
        row[FORWARD] -= f["speed"] / RADIUS_M
        # The left wheel turns faster than commanded: slow it.
        row[WHEELS[wheel]] -= f["turn"] / SPEED / 2
        row[other] += f["turn"] / SPEED / 2
        row[TURN] -= side * f["turn"] * HALF_TRACK_M / RADIUS_M / TURNS
        bias[4 + wheel] += f["pitch_bias"]
        row /= WHEEL_ACTION_RPS
        bias[4 + wheel] /= WHEEL_ACTION_RPS
    a = f["approach"]
    for hip in range(4):
        row = weights[hip]
        # Height: the same for both legs. It approaches a pose that is the more folded the more it is pitched.
        for other in range(4):
            row[LAST[other]] += FRONT[hip] * FRONT[other] / 4 * (1 - a)
        row[GRAVITY[0]] += FRONT[hip] * a * f["fold_rad"] / HIP_ACTION_RAD
        bias[hip] += FRONT[hip] * a * f["stand_rad"] / HIP_ACTION_RAD
        # Shift of the axles forward: front and rear hips alike.
        for other in range(4):
            row[LAST[other]] += 1 / 4 * f["shift_hold"]
        held = 1 - f["shift_hold"]
        row[GRAVITY[0]] += f["swing_rad"] / HIP_ACTION_RAD
        for other in range(4):
            # The last swing is no part of the shift that stays.
            row[22 + GRAVITY[0]] -= f["shift_hold"] * f["swing_rad"] / HIP_ACTION_RAD / 4
        row[GRAVITY[0]] += held * f["shift_rad"] / HIP_ACTION_RAD
        row[RATES[1]] += held * f["shift_rate"] / RATE / HIP_ACTION_RAD
        for place in WHEELS:
            row[place] += f["shift_speed"] / SPEED / 2 / HIP_ACTION_RAD
        row[FORWARD] -= f["shift_speed"] / RADIUS_M / HIP_ACTION_RAD
        bias[hip] += held * f["shift_bias"] / HIP_ACTION_RAD
        # Roll: legs apart.
        for other in range(4):
            row[LAST[other]] += FRONT[hip] * LEFT[hip] * FRONT[other] * LEFT[other] / 4 * f["roll_hold"]
        row[GRAVITY[1]] += FRONT[hip] * LEFT[hip] * (1 - f["roll_hold"]) * f["roll_rad"] / HIP_ACTION_RAD
        row[RATES[0]] -= FRONT[hip] * LEFT[hip] * (1 - f["roll_hold"]) * f["roll_rate"] / RATE / HIP_ACTION_RAD
    return weights, bias


def trial(envs, sets, steps):
    """Returns the reward of each set in one environment, until its first fall."""
    seen, _ = envs.reset()
    made = [matrix(one) for one in sets]
    weights, biases = numpy.stack([w for w, _ in made]), numpy.stack([b for _, b in made])
    rewards, alive = numpy.zeros(len(sets)), numpy.ones(len(sets), bool)
    lasted = numpy.zeros(len(sets))
    for _ in range(steps):
        actions = numpy.einsum("nij,nj->ni", weights, seen) + biases
        seen, reward, fallen, _, _ = envs.step(actions)
        rewards += numpy.where(alive, reward, 0.0)
        alive &= ~fallen
        lasted += alive
        if not alive.any():
            break
    return rewards, lasted


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file for the policy, .npz")
    parser.add_argument("--generations", type=int, default=12, help="generations (12)")
    parser.add_argument("--envs", type=int, default=64, help="sets in a generation (64)")
    parser.add_argument("--repeats", type=int, default=1, help="trials of each set (1)")
    parser.add_argument("--threads", type=int, default=0, help="threads, 0 for one a processor (0)")
    parser.add_argument("--seed", type=int, default=1, help="seed (1)")
    arguments = parser.parse_args()
    numbers = numpy.random.default_rng(arguments.seed)
    envs = jiling_gym.FivebarVec(
        arguments.envs, arguments.threads, arguments.seed, episode_s=1e6, push_mps=1.2, speed_mps=1.5, turn_rps=2.0,
        episodes_per_robot=10,
    )
    guess, spread = (numpy.array([pair[n] for pair in FACTORS.values()]) for n in (0, 1))
    for generation in range(arguments.generations):
        steps = min(150 + 50 * generation, 400)
        sets = guess + spread * numbers.standard_normal((arguments.envs, len(guess)))
        sets[0] = guess
        results = [trial(envs, sets, steps) for _ in range(arguments.repeats)]
        score, lasted = (numpy.mean(part, axis=0) for part in zip(*results))
        best = sets[numpy.argsort(-score)[: max(2, arguments.envs // 5)]]
        share = 0.7
        guess = (1 - share) * guess + share * best.mean(0)
        spread = (1 - share) * spread + share * (best.std(0) + 0.02 * numpy.abs(guess))
        print(
            f"generation {generation + 1}: reward {score.mean():.1f}, best {score.max():.1f}, "
            f"lasts {lasted.mean() * 0.02:.2f} s of {steps * 0.02:.1f}, best {lasted.max() * 0.02:.2f}",
            flush=True,
        )
        weights, biases = matrix(guess)
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        numpy.savez(arguments.out, weights=weights, biases=biases, **dict(zip(FACTORS, guess)))
    print({name: round(float(value), 4) for name, value in zip(FACTORS, guess)})


if __name__ == "__main__":
    main()
