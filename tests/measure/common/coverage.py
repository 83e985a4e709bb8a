"""Simulated experiments with a known truth, for measure_coverage."""
import math

import numpy as np
from scipy.special import expit

from tactus.analysis import break_limits, monotone_fit, people, performance, resampling, survival
from tactus.psychophysics import fits, intervals, overdispersion
from tactus.psychophysics.functions import FUNCTIONS

LEVELS = np.array([0, 25, 50, 100, 150, 200.0])
MARGIN, BASE = 0.1, 0.96
PEOPLE = (5, 8, 12, 24)
SOA = np.array([-240, -160, -110, -70, -35, 0, 35, 70, 110, 160, 240.0])
DRAWS = 400  # of each interval


def row(truth, method, held, widths=None, judged=False, least=0.93, most=0.97):
    share = float(np.mean(held))
    finite = [w for w in widths if np.isfinite(w)] if widths is not None else []
    return {"truth": truth, "method": method, "held": share, "se": max(math.sqrt(share * (1 - share) / len(held)), 0.5 / len(held)),
            "width": float(np.median(finite)) if finite else None, "judged": judged, "least": least, "most": most}


# Crossings

def hill(x50, n):
    return lambda x: BASE / (1 + (x / x50) ** n)


def weibull(a, k):
    return lambda x: BASE * np.exp(-((x / a) ** k))


def two_steps(first=20, second=120, size=0.07, steep=4):
    step = lambda x, at: expit((x - at) / steep) - expit(-at / steep)
    return lambda x: BASE - size * step(x, first) - 0.9 * (BASE - size) * step(x, second)


def true_limit(curve):
    x = np.linspace(0, 2 * LEVELS[-1], 80001)
    reached = curve(x) <= curve(0.0) - MARGIN
    return float(x[np.argmax(reached)]) if reached.any() else math.inf


def pooled(loss):
    """A loss (k,), made non-decreasing by pooling neighbours."""
    blocks = []
    for value in loss:
        blocks.append([value, 1])
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            value, n = blocks.pop()
            blocks[-1] = [(blocks[-1][0] * blocks[-1][1] + value * n) / (blocks[-1][1] + n), blocks[-1][1] + n]
    return np.repeat([b[0] for b in blocks], [b[1] for b in blocks])


def lines_crossing(shares):
    loss = np.concatenate([[0.0], np.maximum(pooled(shares[0] - shares[1:]), 0.0)])
    if loss[-1] < MARGIN:
        return math.inf
    i = int(np.argmax(loss >= MARGIN))
    return float(LEVELS[i - 1] + (MARGIN - loss[i - 1]) / (loss[i] - loss[i - 1]) * (LEVELS[i] - LEVELS[i - 1]))


def crossing(repetitions, seed):
    uniform = lambda rng: hill(rng.uniform(30, 160), math.exp(rng.uniform(math.log(1.5), math.log(12))))
    random_weibull = lambda rng: weibull(rng.uniform(30, 250), rng.uniform(1, 6))
    kinds = (("Hill 60 ms, n 4, 1000 games", lambda rng: hill(60, 4), 1000, False), ("Hill 60 ms, n 12, 1000 games", lambda rng: hill(60, 12), 1000, False),
             ("Weibull 75 ms, k 3, 1000 games", lambda rng: weibull(75, 3), 1000, False), ("two steps, 1000 games", lambda rng: two_steps(), 1000, False),
             ("Hill 60 ms, n 4, 100 games", lambda rng: hill(60, 4), 100, False), ("random Hill, 1000 games", uniform, 1000, True), ("random Hill, 100 games", uniform, 100, True),
             ("random Weibull, 1000 games", random_weibull, 1000, True), ("random Weibull, 100 games", random_weibull, 100, True))
    for number, (name, truth, games, judged) in enumerate(kinds):
        rng = np.random.default_rng([seed, number])
        held, widths = ([], [], []), ([], [], [])
        for _ in range(repetitions):
            curve = truth(rng)
            limit = true_limit(curve)
            won = rng.binomial(games, curve(LEVELS))
            drawn = np.sort([lines_crossing(s) for s in rng.binomial(games, won / games, (200, len(LEVELS))) / games])
            values, variances = monotone_fit.logits(won, np.full(len(LEVELS), games))
            smooth = np.sort(monotone_fit.of_shares(LEVELS, values, np.diag(variances), rng, draws=DRAWS).crossing(MARGIN))
            cells = [performance.Cell((), np.array([]), np.repeat([1.0, 0.0], [k, games - k]), np.array([]), {}) for k in won]
            ends = (drawn[[4, 194]], smooth[[9, 389]], break_limits.bracket(cells[1:], LEVELS[1:], cells[0], False, (MARGIN, 1.1), "success"))
            for i, (low, high) in enumerate(ends):
                held[i].append(low <= limit <= high or (limit > LEVELS[-1] and high == math.inf))
                widths[i].append(high - low)
        yield row(name, "before: straight lines", held[0], widths[0])
        yield row(name, "after: smooth monotone fit", held[1], widths[1], judged)
        yield row(name, "beside: bracket", held[2], widths[2], judged, least=0.95, most=1.0)


# Few people

def percentiles(values, rng):
    names = [f"P{i:02}" for i in range(len(values))]
    return resampling.interval(resampling.Resampler(names, rng, DRAWS).of_cell(names, np.asarray(values, dtype=float)[:, None])[0][:, 0])


def of_people(repetitions, seed):
    for n in PEOPLE:
        rng = np.random.default_rng([seed, 100, n])
        held = {name: [] for name in ("normal p", "normal t", "normal b", "times p", "times t", "shares p", "shares t", "differences p", "differences t")}
        harmless = {"p": [], "t": []}
        for _ in range(repetitions):
            inside = lambda name, ends, truth: held[name].append(ends[0] <= truth <= ends[1])
            values, times = rng.normal(10, 3, n), np.exp(rng.normal(2, 0.8, n))
            inside("normal p", percentiles(values, rng), 10), inside("normal t", people.mean_interval(values)[1:], 10), inside("normal b", people.bootstrap_t(values, rng), 10)
            inside("times p", percentiles(times, rng), math.exp(2 + 0.32)), inside("times t", people.mean_interval(times, logarithmic=True)[1:], math.exp(2))
            won = rng.binomial(20, rng.beta(9, 1, n))
            inside("shares p", percentiles(won / 20, rng), 0.9), inside("shares t", people.Share(won, np.full(n, 20)).interval(), 0.9)
            own = rng.normal(0, 0.5, n)
            before, after = (rng.binomial(20, expit(odds + own)) for odds in (ODDS_95, ODDS_85))
            usual = percentiles((after - before) / 20, rng)
            ours = people.difference(people.Share(after, np.full(n, 20)), people.Share(before, np.full(n, 20)))
            inside("differences p", usual, -0.1), inside("differences t", ours, -0.1)
            names = [f"P{i:02}" for i in range(n)]
            drawn = resampling.Resampler(names, rng, DRAWS).of_cell(names, ((before - after) / 20)[:, None])[0][:, 0]
            harmless["p"].append(resampling.share_beyond(drawn, 0.1) <= 0.05), harmless["t"].append(ours[0] > -0.1)
        for kind, words in (("normal", "normal values"), ("times", "times, log-normal, sd 0.8"), ("shares", "shares, Beta(9, 1), 20 games"), ("differences", "loss of 10 points, 20 games")):
            yield row(f"{n} people: {words}", "before: percentiles of a bootstrap", held[f"{kind} p"])
            yield row(f"{n} people: {words}", "after: Student's t on its scale", held[f"{kind} t"], judged=True)
            if kind == "normal":
                yield row(f"{n} people: {words}", "after: bootstrap-t", held["normal b"], judged=True)
        yield row(f"{n} people: rejected at the margin", "before: one-sided 5 %, bootstrap", harmless["p"])
        yield row(f"{n} people: rejected at the margin", "after: one-sided 2.5 %, t", harmless["t"], judged=True, least=0.0, most=0.035)


def odds_of(mean, sd=0.5):
    """Log odds whose mean share over people, who differ by sd, is `mean`."""
    from scipy.optimize import brentq
    z, w = np.polynomial.hermite_e.hermegauss(40)
    return brentq(lambda odds: np.sum(w / w.sum() * expit(odds + sd * z)) - mean, -8, 8)


ODDS_95, ODDS_85 = odds_of(0.95), odds_of(0.85)


# Over-dispersion

def dispersion(repetitions, seed):
    n = max(20, repetitions // 3)  # a fit takes a tenth of a second
    for number, (name, truth) in enumerate((("order", {"pss": 10, "sd": 60, "lapse": 0.02}), ("synchrony_window", {"pss": 12, "sd": 60, "guess": 0.02, "lapse": 0.05}))):
        p = FUNCTIONS[name].p(SOA, **truth)
        for rho in (0.0, 0.05, 0.15):
            rng = np.random.default_rng([seed, 200, number, int(1000 * rho)])
            shares = np.tile(p, (n, 1)) if rho == 0 else rng.beta(p * (1 - rho) / rho, (1 - p) * (1 - rho) / rho, (n, len(p)))
            yes, total = rng.binomial(20, shares).astype(float), np.full((n, len(p)), 20.0)
            many = [fits.fit(SOA, y, t, name).many for y, t in zip(yes, total)]
            # The factor only bounds the range of the posterior, 20 draws suffice.
            wide = [overdispersion.over_dispersed(one, overdispersion.dispersion(fits.fit(SOA, y, t, name), rng, 20).factor) for one, y, t in zip(many, yes, total)]
            for method, sets in (("before: binomial", many), ("after: beta-binomial", wide)):
                for parameter in ("pss", "sd"):
                    low, high = np.array([[float(end[0]) for end in intervals.of_many(one, parameter)] for one in sets]).T
                    # Without over-dispersion the integral over it can only make intervals longer.
                    yield row(f"{name}, rho {rho:g}: {parameter}", method, (low <= truth[parameter]) & (truth[parameter] <= high), high - low, sets is wide, 0.93, 0.98)
    rng, held = np.random.default_rng([seed, 201]), ([], [])
    for _ in range(repetitions):
        won = rng.binomial(40, rng.beta(0.8 * 9, 0.2 * 9, 12))
        share = won.sum() / 480
        half = 1.959964 * math.sqrt(share * (1 - share) / 480)
        low, high = people.Share(won, np.full(12, 40)).interval()
        held[0].append(abs(share - 0.8) <= half), held[1].append(low <= 0.8 <= high)
    yield row("12 people, 40 games, rho 0.1", "before: binomial", held[0])
    yield row("12 people, 40 games, rho 0.1", "after: over people", held[1], judged=True)


# Windows and times

def window(repetitions, seed):
    for peak in (0.98, 0.9, 0.8, 0.65):
        rng = np.random.default_rng([seed, 300, int(100 * peak)])
        truth = {"pss": 12, "sd": 60, "guess": 0.02, "lapse": 1 - peak}
        yes = rng.binomial(20, FUNCTIONS["synchrony_window"].p(SOA, **truth), (repetitions, len(SOA))).astype(float)
        for method, forced in (("before: peak held near 1", True), ("after: free peak", False)):
            many = fits.fit_many(SOA, yes, np.full(yes.shape, 20.0), "synchrony_window", forced_peak=forced)
            for parameter in ("pss", "sd"):
                low, high = intervals.of_many(many, parameter)
                yield row(f"peak {peak:g}: {parameter}", method, (low <= truth[parameter]) & (truth[parameter] <= high), high - low, not forced)
    for share, ratio in ((0.96, 1.1), (0.86, 1.0), (0.86, 1.1), (0.6, 1.0)):
        rng, held, widths = np.random.default_rng([seed, 301, int(100 * share), int(100 * ratio)]), ([], []), ([], [])
        for _ in range(repetitions):
            both, restricted = [], []
            for p, slower in ((0.96, 1.0), (share, ratio)):
                drawn = np.exp(rng.normal(math.log(12 * slower), 0.35, 150))
                won = (rng.random(150) < p) & (drawn < 30)
                both.append(survival.fit(np.where(won, drawn, 30.0), won)), restricted.append(np.where(won, drawn, 30.0))
            means, errors = [r.mean() for r in restricted], [r.std(ddof=1) / math.sqrt(150) for r in restricted]
            for i, (value, se) in enumerate(((math.log(means[1] / means[0]), math.hypot(errors[0] / means[0], errors[1] / means[1])),
                                             (both[1].mu - both[0].mu, math.sqrt(both[0].variance + both[1].variance)))):
                held[i].append(abs(value - math.log(ratio)) <= 1.96 * se), widths[i].append(2 * 1.96 * se)
        yield row(f"{100 * share:.0f} % won, times x {ratio:g}", "before: mean with the limit", held[0], widths[0])
        yield row(f"{100 * share:.0f} % won, times x {ratio:g}", "after: censored times", held[1], widths[1], True)


TABLES = {"crossing": crossing, "people": of_people, "dispersion": dispersion, "window": window}
