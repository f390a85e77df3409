"""CMA-ES: covariance matrix adaptation evolution strategy, with the usual settings (Hansen, arXiv 1604.00772)."""

import numpy


class Evolution:
    """Draws sets of numbers around a mean, and moves mean, size and shape of the cloud towards the cheaper half."""

    def __init__(self, mean, size, count, numbers):
        n = len(mean)
        self.mean, self.size, self.count, self.numbers = numpy.array(mean, float), size, count, numbers
        weights = numpy.log(count / 2 + 0.5) - numpy.log(numpy.arange(1, count // 2 + 1))
        self.weights = weights / weights.sum()
        mass = self.mass = 1 / (self.weights**2).sum()
        self.slow_path = (4 + mass / n) / (n + 4 + 2 * mass / n)
        self.fast_path = (mass + 2) / (n + mass + 5)
        self.one = 2 / ((n + 1.3) ** 2 + mass)
        self.many = min(1 - self.one, 2 * (mass - 2 + 1 / mass) / ((n + 2) ** 2 + mass))
        self.damping = 1 + 2 * max(0, numpy.sqrt((mass - 1) / (n + 1)) - 1) + self.fast_path
        self.shape, self.way, self.steps = numpy.eye(n), numpy.zeros(n), numpy.zeros(n)
        self.expected = numpy.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
        self.generation = 0

    def ask(self):
        """Draws the sets of a generation, one a row."""
        variances, self.axes = numpy.linalg.eigh(self.shape)
        self.lengths = numpy.sqrt(numpy.maximum(variances, 1e-12))
        self.drawn = self.numbers.standard_normal((self.count, len(self.mean))) * self.lengths @ self.axes.T
        return self.mean + self.size * self.drawn

    def tell(self, costs):
        """Takes the cost of each set."""
        self.generation += 1
        best = self.drawn[numpy.argsort(costs, kind="stable")[: len(self.weights)]]
        moved = self.weights @ best
        self.mean = self.mean + self.size * moved
        straight = self.axes @ (self.axes.T @ moved / self.lengths)
        self.steps = (1 - self.fast_path) * self.steps + numpy.sqrt(self.fast_path * (2 - self.fast_path) * self.mass) * straight
        length = numpy.linalg.norm(self.steps)
        begun = numpy.sqrt(1 - (1 - self.fast_path) ** (2 * self.generation))
        goes_on = length / begun < (1.4 + 2 / (len(self.mean) + 1)) * self.expected
        self.way = (1 - self.slow_path) * self.way
        if goes_on:
            self.way = self.way + numpy.sqrt(self.slow_path * (2 - self.slow_path) * self.mass) * moved
        spread = (best.T * self.weights) @ best
        self.shape = (1 - self.one - self.many) * self.shape + self.one * numpy.outer(self.way, self.way) + self.many * spread
        self.size *= numpy.exp(min(1.0, self.fast_path / self.damping * (length / self.expected - 1)))
