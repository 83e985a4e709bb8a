"""Age of information: how old the newest delivered update is, on average over time. Arrays in, numbers out."""
import numpy as np


def expected_s(delay_s=0.0, rate_hz=None, loss=0.0):
    """Mean age of updates at a constant rate with a constant delay and independent losses: delay + (1/rate) (1/2 + loss / (1 - loss)). rate_hz None: a
    continuous signal, whose losses are filled at once. Raises ValueError for a loss of 1 or a rate of 0."""
    if not 0 <= loss < 1:
        raise ValueError("no update arrives at this loss; give one below 1")
    if rate_hz is None:
        return delay_s
    if rate_hz <= 0:
        raise ValueError("a rate must be above 0")
    return delay_s + (0.5 + loss / (1 - loss)) / rate_hz


def measured_s(made_s, delivered_s, until_s=None):
    """Mean age over the time from the first delivery to until_s (default: the last delivery). made_s, delivered_s: when each delivered update was made and
    delivered, on one clock. None: fewer than two deliveries."""
    order = np.argsort(delivered_s, kind="stable")
    at, made = np.asarray(delivered_s, dtype=float)[order], np.maximum.accumulate(np.asarray(made_s, dtype=float)[order])
    if until_s is not None:
        at, made = np.append(at[at < until_s], until_s), made[:int(np.sum(at < until_s)) + 1]
        made = made if len(made) == len(at) else np.append(made, made[-1:])
    if len(at) < 2 or at[-1] <= at[0]:
        return None
    young, old = at[:-1] - made[:-1], at[1:] - made[:-1]
    return float(np.sum((young + old) / 2 * np.diff(at)) / (at[-1] - at[0]))
