"""Trains a policy for the robot by PPO, on the processor.

    python train/ppo.py --begin target/train/whole.npz --out target/train/flat --steps 3000000
    python train/ppo.py --begin target/train/whole.npz --out target/train/flat --steps 5000000 --resume     # goes on where it was stopped
    python train/ppo.py --out /tmp/smoke --smoke                             # seconds, to see that all of it runs

It begins with the policy that `whole_search.py` found, or with none. The folder `--out` gets checkpoint.npz, curves.csv and
curves.png. `export.py` makes the network of it that the robot runs.
"""

import argparse
import csv
import json
import pathlib
import time

import jax
import jax.numpy as jnp
import numpy
import optax

import balance
import circuit
import jiling_gym
import network

DISCOUNT, TRACE, CLIP = 0.99, 0.95, 0.2
EPOCHS, MINIBATCHES = 4, 4
# Rewards are scaled so that values are some tens.
REWARD_SCALE = 0.1
ENTROPY = 0.0005
# Of a step of the policy, above and below which the learning rate is lowered or raised.
KL_WANTED = 0.015
# First standard deviations of actions, hips and wheels.
DEVIATIONS = (0.1, 0.1, 0.1, 0.1, 0.15, 0.15)
# Share of the steps from which pushes (m/s), speed (m/s) and turn rate (rad/s) go up to these values.
STAGES = ((0.0, 1.0, 1.5, 3.0), (0.2, 1.3, 1.5, 3.0))
# Left and right exchanged: of an observation, and of actions, where each value comes from and its sign.
FRAME = ([2, 3, 0, 1, 6, 7, 4, 5, 9, 8, 10, 11, 12, 13, 14, 15, 18, 19, 16, 17, 21, 20],
         [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, 1, -1, 1, -1, 1, 1, 1, 1, 1, 1, 1])
MIRRORED_SEEN = numpy.array([22 * age + place for age in range(3) for place in FRAME[0]] + [66, 67, 68])
MIRRORED_SIGN = numpy.array(FRAME[1] * 3 + [1, -1, -1], numpy.float32)
MIRRORED_ACTIONS = numpy.array([2, 3, 0, 1, 5, 4])


def log_probability(parameters, mean, actions):
    log_deviation = parameters["log_deviation"]
    z = (actions - mean) / jnp.exp(log_deviation)
    return -0.5 * (z**2).sum(-1) - log_deviation.sum() - 0.5 * actions.shape[-1] * jnp.log(2 * jnp.pi)


@jax.jit
def act(parameters, fixed, key, seen):
    mean = network.mean_actions(parameters, fixed, seen)
    actions = mean + jnp.exp(parameters["log_deviation"]) * jax.random.normal(key, mean.shape)
    return actions, log_probability(parameters, mean, actions), network.value(parameters, fixed, seen)


@jax.jit
def log_probability_of(parameters, fixed, seen, actions):
    return log_probability(parameters, network.mean_actions(parameters, fixed, seen), actions)


@jax.jit
def values_of(parameters, fixed, seen):
    return network.value(parameters, fixed, seen)


def loss(parameters, fixed, batch):
    mean = network.mean_actions(parameters, fixed, batch["seen"])
    log_ratio = log_probability(parameters, mean, batch["actions"]) - batch["log_probability"]
    ratio = jnp.exp(log_ratio)
    gain = batch["advantage"]
    policy = -jnp.minimum(ratio * gain, ratio.clip(1 - CLIP, 1 + CLIP) * gain).mean()
    worth = 0.5 * ((network.value(parameters, fixed, batch["seen"]) - batch["return"]) ** 2).mean()
    entropy = parameters["log_deviation"].sum()
    kl = (ratio - 1 - log_ratio).mean()
    return policy + 0.5 * worth - ENTROPY * entropy, (kl, worth)


OPTIMISER = optax.chain(optax.clip_by_global_norm(1.0), optax.inject_hyperparams(optax.adam)(learning_rate=3e-4))


@jax.jit
def improve(parameters, state, fixed, batch):
    (_, (kl, worth)), gradient = jax.value_and_grad(loss, has_aux=True)(parameters, fixed, batch)
    updates, state = OPTIMISER.update(gradient, state)
    parameters = optax.apply_updates(parameters, updates)
    bounded = parameters["log_deviation"].clip(jnp.log(0.03), jnp.log(0.5))
    return {**parameters, "log_deviation": bounded}, state, kl, worth


def advantages(rewards, values, ends, last):
    """Generalised advantage estimation over rows of time. Where an episode ends, nothing follows."""
    made, next_value, running = numpy.zeros_like(rewards), last, numpy.zeros_like(last)
    for row in range(len(rewards) - 1, -1, -1):
        goes_on = 1.0 - ends[row]
        error = rewards[row] + DISCOUNT * goes_on * next_value - values[row]
        running = error + DISCOUNT * TRACE * goes_on * running
        made[row], next_value = running, values[row]
    return made


class Training:
    """Robots, network and optimiser."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.envs = jiling_gym.FivebarVec(arguments.envs, arguments.threads, arguments.seed, **options(0.0))
        self.seen, _ = self.envs.reset()
        self.key = jax.random.key(arguments.seed)
        observed, actions = self.seen.shape[1], self.envs.single_action_space.shape[0]
        self.fixed = self.first_policy(observed, actions)
        self.parameters = network.begin(self.draw(), observed, actions, DEVIATIONS)
        self.optimiser = OPTIMISER.init(self.parameters)
        self.steps, self.rows, self.stage = 0, [], 0
        self.lengths, self.age = [], numpy.zeros(arguments.envs)
        self.numbers = numpy.random.default_rng(arguments.seed)

    def draw(self):
        self.key, own = jax.random.split(self.key)
        return own

    def first_policy(self, observed, actions):
        """The policy to begin with, and mean and deviation of what it sees."""
        layers = balance.network(balance.factors_of(self.arguments.begin)) if self.arguments.begin else []
        looked, numbers = [], numpy.random.default_rng(self.arguments.seed)
        for _ in range(self.arguments.horizon * 2):
            looked.append(self.seen)
            begun = circuit.run(layers, self.seen) if layers else 0.0
            self.seen = self.envs.step(begun + 0.1 * numbers.standard_normal((len(self.seen), actions)))[0]
        looked = numpy.concatenate(looked)
        fixed = {"layers": [tuple(jnp.asarray(part, jnp.float32) for part in layer) for layer in layers]}
        return {**fixed, "mean": jnp.asarray(looked.mean(0)), "deviation": jnp.asarray(looked.std(0) + 0.02)}

    def collect(self):
        """Steps all robots with the present policy."""
        rows = []
        for _ in range(self.arguments.horizon):
            actions, log_probabilities, values = map(numpy.asarray, act(self.parameters, self.fixed, self.draw(), self.seen))
            seen, rewards, fallen, over, info = self.envs.step(actions)
            rewards = REWARD_SCALE * rewards
            if over.any():
                # An episode cut by its time would have gone on.
                after = numpy.asarray(values_of(self.parameters, self.fixed, info["final_obs"]))
                rewards = rewards + DISCOUNT * after * over
            ends = fallen | over
            rows.append((self.seen, actions, log_probabilities, values, rewards, ends.astype(float), fallen))
            self.age += 1
            self.lengths += list(self.age[ends])
            self.age[ends] = 0
            self.seen = seen
        self.steps += self.arguments.horizon * self.arguments.envs
        return [numpy.stack(column) for column in zip(*rows)]

    def iterate(self):
        """Collects a batch and learns from it. Returns a row of the curves."""
        began = time.perf_counter()
        seen, actions, log_probabilities, values, rewards, ends, fallen = self.collect()
        stepped = time.perf_counter()
        last = numpy.asarray(values_of(self.parameters, self.fixed, self.seen))
        gains = advantages(rewards, values, ends, last)
        flat = lambda array: array.reshape(-1, *array.shape[2:]).astype(numpy.float32)
        batch = {
            "seen": flat(seen), "actions": flat(actions), "log_probability": flat(log_probabilities),
            "return": flat(gains + values), "advantage": flat((gains - gains.mean()) / (gains.std() + 1e-8)),
        }
        kl, worth = self.learn(self.with_mirror(batch))
        self.lengths = self.lengths[-200:]
        return {
            "steps": self.steps,
            "reward": float(rewards.mean() / REWARD_SCALE),
            "episode_s": float(numpy.mean(self.lengths) * 0.02) if self.lengths else 0.0,
            "falls_per_minute": float(fallen.mean() * 50 * 60),
            "kl": kl, "value_loss": worth,
            "deviation": float(jnp.exp(self.parameters["log_deviation"]).mean()),
            "rate": float(self.optimiser[1].hyperparams["learning_rate"]),
            "steps_per_s": self.arguments.horizon * self.arguments.envs / (time.perf_counter() - began),
            "learning_s": time.perf_counter() - stepped,
        }

    def with_mirror(self, batch):
        """The batch, and once more with left and right exchanged: the robot is its own mirror image."""
        seen = batch["seen"][:, MIRRORED_SEEN] * MIRRORED_SIGN
        actions = batch["actions"][:, MIRRORED_ACTIONS]
        log_probability = numpy.asarray(log_probability_of(self.parameters, self.fixed, seen, actions))
        other = {**batch, "seen": seen, "actions": actions, "log_probability": log_probability}
        return {name: numpy.concatenate([column, other[name]]) for name, column in batch.items()}

    def learn(self, batch):
        count = len(batch["seen"])
        for _ in range(EPOCHS):
            kls = []
            for part in numpy.array_split(self.numbers.permutation(count), MINIBATCHES):
                some = {name: column[part] for name, column in batch.items()}
                self.parameters, self.optimiser, kl, worth = improve(self.parameters, self.optimiser, self.fixed, some)
                kls.append(float(kl))
            mean_kl = float(numpy.mean(kls))
            rate = self.optimiser[1].hyperparams["learning_rate"]
            if mean_kl > 2 * KL_WANTED:
                rate = jnp.maximum(rate / 1.5, 1e-5)
            elif mean_kl < KL_WANTED / 2:
                rate = jnp.minimum(rate * 1.1, 1e-3)
            self.optimiser[1].hyperparams["learning_rate"] = rate
            if mean_kl > 3 * KL_WANTED:
                break
        return mean_kl, float(worth)

    def harden(self):
        """Pushes and commands grow with the steps done."""
        stage = sum(self.steps >= share * self.arguments.steps for share, *_ in STAGES) - 1
        if stage != self.stage:
            self.stage = stage
            self.seen, _ = self.envs.reset(options=options(self.steps / self.arguments.steps))
            self.age[:] = 0

    def save(self):
        folder = self.arguments.out
        leaves = jax.tree.leaves((self.parameters, self.fixed, self.optimiser))
        said = {name: str(value) for name, value in vars(self.arguments).items()}
        with open(folder / "checkpoint.new", "wb") as file:
            numpy.savez(file, *leaves, steps=self.steps, rows=json.dumps(self.rows), arguments=json.dumps(said))
        (folder / "checkpoint.new").replace(folder / "checkpoint.npz")
        with open(folder / "curves.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, self.rows[0])
            writer.writeheader()
            writer.writerows(self.rows)
        curves(self.rows, folder / "curves.png")

    def resume(self):
        file = numpy.load(self.arguments.out / "checkpoint.npz")
        leaves, shape = jax.tree.flatten((self.parameters, self.fixed, self.optimiser))
        loaded = [jnp.asarray(file[f"arr_{index}"]) for index in range(len(leaves))]
        self.parameters, self.fixed, self.optimiser = jax.tree.unflatten(shape, loaded)
        self.steps, self.rows = int(file["steps"]), json.loads(str(file["rows"]))
        # Robots and noise of the second part are not those of the first.
        self.key = jax.random.fold_in(self.key, self.steps)
        self.numbers = numpy.random.default_rng([self.arguments.seed, self.steps])


def options(share):
    """Options of the robots when so much of the training is done."""
    _, push_mps, speed_mps, turn_rps = [stage for stage in STAGES if share >= stage[0]][-1]
    return {"push_mps": push_mps, "speed_mps": speed_mps, "turn_rps": turn_rps}


def curves(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    figure, axes = plot.subplots(2, 2, figsize=(9, 6), sharex=True)
    steps = [row["steps"] / 1e6 for row in rows]
    for axis, (name, label) in zip(
        axes.flat,
        (("reward", "reward of a step"), ("episode_s", "length of an episode, s"),
         ("falls_per_minute", "falls in a minute of a robot"), ("deviation", "deviation of the actions")),
    ):
        axis.plot(steps, [row[name] for row in rows], linewidth=0.8)
        axis.set_title(label, fontsize=10)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("steps, millions")
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    plot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of checkpoint and curves")
    parser.add_argument("--begin", type=pathlib.Path, help="file of whole_search.py to begin with (none)")
    parser.add_argument("--steps", type=int, default=3_000_000, help="environment steps in all (3000000)")
    parser.add_argument("--envs", type=int, default=64, help="robots (64)")
    parser.add_argument("--horizon", type=int, default=64, help="steps of each robot in a batch (64)")
    parser.add_argument("--threads", type=int, default=0, help="threads of the robots, 0 for one a processor (0)")
    parser.add_argument("--seed", type=int, default=1, help="seed (1)")
    parser.add_argument("--resume", action="store_true", help="go on with the checkpoint in --out")
    parser.add_argument("--smoke", action="store_true", help="two batches of four robots, and two more with --resume")
    arguments = parser.parse_args()
    if arguments.smoke:
        arguments.envs, arguments.horizon = 4, 16
        arguments.steps = 256 if arguments.resume else 128
    arguments.out.mkdir(parents=True, exist_ok=True)
    training = Training(arguments)
    if arguments.resume:
        training.resume()
    began = time.perf_counter()
    while training.steps < arguments.steps:
        training.harden()
        row = training.iterate()
        training.rows.append(row)
        if len(training.rows) % 5 == 0 or training.steps >= arguments.steps:
            training.save()
            left_s = (arguments.steps - training.steps) / row["steps_per_s"]
            print(
                f"{training.steps:>9} steps  reward {row['reward']:6.3f}  episode {row['episode_s']:5.2f} s  "
                f"falls/min {row['falls_per_minute']:6.2f}  kl {row['kl']:.4f}  deviation {row['deviation']:.3f}  "
                f"rate {row['rate']:.1e}  {row['steps_per_s']:6.0f} steps/s  learns {row['learning_s']:.1f} s  "
                f"{(time.perf_counter() - began) / 60:5.1f} min, {left_s / 60:.0f} left",
                flush=True,
            )


if __name__ == "__main__":
    main()
