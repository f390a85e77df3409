"""The policy's network: a policy that was searched, beside two hidden layers.

    actions = circuit(x) + MLP((x - mean) / deviation)

x is the observation. The circuit is that of `balance.py`, or none, and stays as it is. The last layer of the MLP begins at zero,
so that training begins with the policy that was searched.
"""

import jax
import jax.numpy as jnp
import numpy

HIDDEN = 128


def layers(key, sizes, last):
    """Returns weights and biases of an MLP, the last weights scaled by `last`."""
    made = []
    for index, (wide, narrow) in enumerate(zip(sizes, sizes[1:])):
        key, own = jax.random.split(key)
        scale = last if index == len(sizes) - 2 else 1.0
        weights = scale * jax.random.normal(own, (wide, narrow)) * (1.5 / wide) ** 0.5
        made.append((weights, jnp.zeros(narrow)))
    return made


def mlp(parameters, x):
    """Computes an MLP with ELU between its layers."""
    for weights, biases in parameters[:-1]:
        x = jax.nn.elu(x @ weights + biases)
    weights, biases = parameters[-1]
    return x @ weights + biases


def mean_actions(parameters, fixed, x):
    """Returns the actions without noise."""
    seen = x
    for weights, bias, low, high in fixed["layers"]:
        out = jnp.clip(seen @ weights.T + bias, low, high)
        seen = jnp.concatenate([seen, out], axis=-1)
    searched = out if fixed["layers"] else 0.0
    return searched + mlp(parameters["policy"], normal(fixed, x))


def value(parameters, fixed, x):
    """Returns the value of an observation."""
    return mlp(parameters["value"], normal(fixed, x))[..., 0]


def normal(fixed, x):
    return (x - fixed["mean"]) / fixed["deviation"]


def begin(key, observed, actions, deviations):
    """Returns parameters of a policy that is only its circuit."""
    one, other = jax.random.split(key)
    return {
        "policy": layers(one, (observed, HIDDEN, HIDDEN, actions), 0.0),
        "value": layers(other, (observed, HIDDEN, HIDDEN, 1), 0.1),
        "log_deviation": jnp.log(jnp.asarray(deviations)),
    }


def folded(parameters, fixed):
    """Returns the layers of the MLP as NumPy arrays, with the normalisation in the first one."""
    made = [(numpy.asarray(w, numpy.float64), numpy.asarray(b, numpy.float64)) for w, b in parameters["policy"]]
    weights, biases = made[0]
    mean, deviation = (numpy.asarray(fixed[name], numpy.float64) for name in ("mean", "deviation"))
    made[0] = (weights / deviation[:, None], biases - (mean / deviation) @ weights)
    return made
