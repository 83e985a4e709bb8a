"""The perceptual deadband of the kinaesthetic codec, as sync/degradation/deadband.cpp computes it: for signals that are already recorded."""
import numpy as np

PREDICTORS = ("hold", "linear")
REACH, MAX_REACH_S = 50, 1.0  # of a line, as in sync/degradation/deadband.h


def transmit(signal, times_s, k, predictor="hold", floor=0.0):
    """The signal as the receiver has it, and which samples were sent: a sample is sent when it differs by more than max(k |received|, floor) from the received
    one, in Euclidean norm; the first always. Raises ValueError for an unknown predictor."""
    if predictor not in PREDICTORS:
        raise ValueError(f"there is no predictor {predictor}; choose from {', '.join(PREDICTORS)}")
    flat = np.ndim(signal) == 1
    x = np.asarray(signal, dtype=float).reshape(len(signal), -1)
    shown, sent = np.empty_like(x), np.zeros(len(x), dtype=bool)
    value, slope, reach, at = np.zeros(x.shape[1]), np.zeros(x.shape[1]), 0.0, None
    for i, t in enumerate(times_s):
        received = value if at is None else value + slope * min(max(t - at, 0.0), reach)
        if at is None or np.linalg.norm(x[i] - received) > max(k * np.linalg.norm(received), floor):
            step = 0.0 if at is None else t - at
            line = predictor == "linear" and step > 0
            slope, reach = ((x[i] - value) / step, min(REACH * step, MAX_REACH_S)) if line else (np.zeros(x.shape[1]), 0.0)
            value, at, sent[i], received = x[i], t, True, x[i]
        shown[i] = received
    return (shown[:, 0] if flat else shown), sent
