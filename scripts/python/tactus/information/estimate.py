"""Information about a hidden variable in noisy percepts: an ideal observer, which has the percepts of every value, and mutual information.

A rendering is the presentation of one value under one variant. All values have the same variants, so the variant itself carries nothing about the value.
The observer's posterior is exact: p(value | percepts) is proportional to the sum over the variants of the product over the senses of p(percept | value,
variant). The information is the mean of H(value) - H(value | percepts) over draws of value, variant and noise.
"""
import dataclasses
import itertools
import math

import numpy as np

Z95 = 1.959963984540054  # normal quantile of 97.5 %


@dataclasses.dataclass(frozen=True)
class Percept:
    """A percept of one sense in all renderings. mean, sd: arrays [value, variant, component]; the noise is normal and independent. wrong: share of percepts
    that are those of a random rendering, without a sign of it."""
    sense: str
    mean: np.ndarray
    sd: np.ndarray
    wrong: float = 0.0


def log_density(y, percept):
    """log p(y | value, variant) [draw, value, variant] of percepts y [draw, component]."""
    z = (y[:, None, None, :] - percept.mean) / percept.sd
    log_p = -0.5 * np.sum(z * z, axis=-1) - np.sum(np.log(percept.sd), axis=-1)
    if percept.wrong > 0:
        any_p = np.logaddexp.reduce(log_p.reshape(len(y), -1), axis=1) - math.log(percept.mean.shape[0] * percept.mean.shape[1])
        log_p = np.logaddexp(math.log1p(-percept.wrong) + log_p, math.log(percept.wrong) + any_p[:, None, None])
    return log_p


def log_likelihoods(percepts, values, variants, lapse, random):
    """{sense: [draw, value, variant]} for drawn percepts of the renderings (values[i], variants[i]). A sense lapses, all its percepts together, with the
    probability `lapse`; then it carries nothing."""
    n = len(values)
    found = {}
    for percept in percepts:
        shape = percept.mean.shape
        v, e = values, variants
        if percept.wrong > 0:
            other = random.random(n) < percept.wrong
            v, e = np.where(other, random.integers(shape[0], size=n), v), np.where(other, random.integers(shape[1], size=n), e)
        y = percept.mean[v, e] + percept.sd[v, e] * random.standard_normal((n, shape[2]))
        found[percept.sense] = found.get(percept.sense, 0) + log_density(y, percept)
    for sense in found:
        found[sense] = np.where((random.random(n) < lapse)[:, None, None], 0.0, found[sense])
    return found


def posterior(log_p, prior):
    """p(value | percepts) [draw, value] from log p(percepts | value, variant) [draw, value, variant]."""
    weight = np.logaddexp.reduce(log_p, axis=2) + np.log(prior)
    weight -= weight.max(axis=1, keepdims=True)
    p = np.exp(weight)
    return p / p.sum(axis=1, keepdims=True)


def entropy_bits(p):
    """Entropy of distributions along the last axis, bits."""
    p = np.asarray(p, dtype=float)
    return -np.sum(np.where(p > 0, p * np.log2(np.where(p > 0, p, 1.0)), 0.0), axis=-1)


def mean_interval(samples):
    """(mean, low, high) of independent samples: normal interval of 95 %."""
    samples = np.asarray(samples, dtype=float)
    half = Z95 * samples.std(ddof=1) / math.sqrt(len(samples)) if len(samples) > 1 else math.inf
    return float(samples.mean()), float(samples.mean() - half), float(samples.mean() + half)


def share_interval(right):
    """(share, low, high) of right answers: Wilson's interval of 95 %."""
    n, p = len(right), float(np.mean(right))
    centre, half = p + Z95**2 / (2 * n), Z95 * math.sqrt(p * (1 - p) / n + Z95**2 / (4 * n * n))
    return p, (centre - half) / (1 + Z95**2 / n), (centre + half) / (1 + Z95**2 / n)


def transmitted_bits(confusions):
    """Information of answers about values, bits, from a table of counts [value, answer], minus the bias (rows - 1)(columns - 1)/(2 N ln 2) of an estimate
    from N answers (Miller 1955)."""
    n = np.asarray(confusions, dtype=float)
    p = n / n.sum()
    expected = p.sum(axis=1, keepdims=True) * p.sum(axis=0, keepdims=True)
    used = p > 0
    plain = float(np.sum(p[used] * np.log2(p[used] / expected[used])))
    rows, columns = np.count_nonzero(n.sum(axis=1)), np.count_nonzero(n.sum(axis=0))
    return plain - (rows - 1) * (columns - 1) / (2 * n.sum() * math.log(2))


def shapley(names, worth):
    """{name: Shapley share}. worth(frozenset of names) is the worth of a coalition."""
    m = len(names)
    share = dict.fromkeys(names, 0.0)
    for name in names:
        others = [n for n in names if n != name]
        for k in range(m):
            weight = math.factorial(k) * math.factorial(m - k - 1) / math.factorial(m)
            share[name] += weight * sum(worth(frozenset(s) | {name}) - worth(frozenset(s)) for s in itertools.combinations(others, k))
    return share


class Observer:
    """Drawn percepts of all renderings, and the answers of an ideal observer with any of the senses. prior: of the values; default: all equal. The draws
    are the same for every set of senses."""

    def __init__(self, percepts, draws, seed=1, lapse=0.0, prior=None):
        count, variants = percepts[0].mean.shape[:2]
        self.prior = np.full(count, 1 / count) if prior is None else np.asarray(prior, dtype=float)
        random = np.random.default_rng(seed)
        self.values = np.arange(draws) % count if prior is None else random.choice(count, size=draws, p=self.prior)
        self.senses = list(dict.fromkeys(p.sense for p in percepts))
        self.log_p = log_likelihoods(percepts, self.values, random.integers(variants, size=draws), lapse, random)
        self.shape = (draws, count, variants)
        self.known = {}

    def judged(self, senses):
        """(information of each draw in bits, whether each answer is right, answers) with these senses alone. Among equal posteriors the answer is a random
        choice, which counts with its probability of being right."""
        key = frozenset(senses)
        if key not in self.known:
            p = posterior(sum((self.log_p[s] for s in self.senses if s in key), np.zeros(self.shape)), self.prior)
            best = p >= p.max(axis=1, keepdims=True) - 1e-9
            right = best[np.arange(len(p)), self.values] / best.sum(axis=1)
            self.known[key] = entropy_bits(self.prior) - entropy_bits(p), right, np.argmax(p, axis=1)
        return self.known[key]

    def result(self, senses):
        """{bits, success, answered_bits} with intervals [low, high] of these senses alone."""
        bits, right, answers = self.judged(senses)
        table = np.zeros((self.shape[1], self.shape[1]))
        np.add.at(table, (self.values, answers), 1)
        b, s = mean_interval(bits), share_interval(right)
        return {"bits": b[0], "bits_interval": list(b[1:]), "success": s[0], "success_interval": list(s[1:]), "answered_bits": transmitted_bits(table)}

    def gain(self, sense):
        """{bits, success} that all senses have more than all but this one, with intervals of the paired differences."""
        rest = [s for s in self.senses if s != sense]
        every, without = self.judged(self.senses), self.judged(rest)
        b, s = mean_interval(every[0] - without[0]), mean_interval(every[1] - without[1])
        return {"bits": b[0], "bits_interval": list(b[1:]), "success": s[0], "success_interval": list(s[1:])}

    def shares(self):
        """{sense: Shapley share of the information, bits}."""
        return shapley(self.senses, lambda senses: float(self.judged(senses)[0].mean()))
