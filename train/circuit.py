"""A network of linear layers with clips, built from named values.

Every layer sees the input and all layers before it, so that a value may be used wherever it is needed:

    y = clip(W [x, earlier] + b, low, high)

`export.py` writes such a network as ONNX.
"""

import numpy

FREE = 1e9


class Circuit:
    """Values of an input, and what is computed from them."""

    def __init__(self, width):
        self.width, self.values, self.inputs = width, [], {}

    def name(self, name, terms):
        """Names a weighted sum of places of the input, to be used in other sums."""
        self.inputs[name] = dict(terms)

    def add(self, name, terms, bias=0.0, low=-FREE, high=FREE):
        """Adds a value: a sum of named ones, each with its factor, and then a clip."""
        self.values.append((name, dict(terms), bias, low, high))

    def layers(self, outputs):
        """Returns weights, biases, lower and upper limits of each layer. The last one computes `outputs`, in this order."""
        depth = {}
        for name, terms, *_ in self.values:
            depth[name] = 1 + max((depth.get(term, 0) for term in terms), default=0)
        last = max(depth[name] for name in outputs)
        depth.update({name: last for name in outputs})
        place, made, seen = {}, [], self.width
        for level in range(1, last + 1):
            rows = [value for value in self.values if depth[value[0]] == level]
            if level == last:
                rows = [next(value for value in rows if value[0] == name) for name in outputs]
            weights = numpy.zeros((len(rows), seen))
            for row, (_, terms, *_) in zip(weights, rows):
                for term, factor in terms.items():
                    for at, share in self.inputs.get(term, {}).items() if term in self.inputs else ((place[term], 1.0),):
                        row[at] += factor * share
            made.append((weights, *(numpy.array([value[n] for value in rows], float) for n in (2, 3, 4))))
            for offset, (name, *_) in enumerate(rows):
                place[name] = seen + offset
            seen += len(rows)
        return made


def run(layers, x):
    """Computes the network for rows of inputs."""
    seen = x
    for weights, bias, low, high in layers:
        out = numpy.clip(seen @ weights.T + bias, low, high)
        seen = numpy.concatenate([seen, out], axis=1)
    return out
