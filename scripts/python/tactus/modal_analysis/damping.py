"""Fits laws of damping to a set of modes."""
import math

import numpy as np


def rayleigh(frequency_Hz, alpha_1_s, beta_s):
    """d = (alpha + beta w^2) / 2, 1/s."""
    return (alpha_1_s + beta_s * (2 * math.pi * np.asarray(frequency_Hz)) ** 2) / 2


def constant_loss(frequency_Hz, eta):
    """d = pi f eta, 1/s: internal friction (van den Doel and Pai, "The sounds of physical shapes", Presence 7, 1998)."""
    return math.pi * np.asarray(frequency_Hz) * eta


def fit(frequency_Hz, damping_1_s, amplitude):
    """Least squares of relative errors, weighted by amplitude, because hearing judges decay times relatively. alpha and beta are not
    negative. Returns a dictionary; `better` names the law with the smaller weighted error."""
    f, d = np.asarray(frequency_Hz, float), np.asarray(damping_1_s, float)
    weight = np.abs(np.asarray(amplitude, float))
    weight = weight / weight.sum()
    root = np.sqrt(weight)
    columns = np.stack([np.full(len(f), 0.5), (2 * np.pi * f) ** 2 / 2], axis=1) / d[:, None]
    scale = np.linalg.norm(columns * root[:, None], axis=0)
    solution = np.linalg.lstsq(columns * root[:, None] / scale, root, rcond=None)[0] / scale
    if (solution < 0).any() or len(f) < 2:
        alone = [(weight * columns[:, i]).sum() / (weight * columns[:, i] ** 2).sum() for i in range(2)]
        rests = [(weight * (columns[:, i] * alone[i] - 1) ** 2).sum() for i in range(2)]
        best = int(rests[1] < rests[0])
        solution = np.array([alone[0], 0.0]) if best == 0 else np.array([0.0, alone[1]])
    alpha, beta = (float(x) for x in solution)
    ratio = np.pi * f / d
    eta = float((weight * ratio).sum() / (weight * ratio ** 2).sum())
    error = lambda law: float(np.sqrt((weight * (law / d - 1) ** 2).sum()))
    rayleigh_error, eta_error = error(rayleigh(f, alpha, beta)), error(constant_loss(f, eta))
    return {"rayleigh_alpha_1_s": alpha, "rayleigh_beta_s": beta, "rayleigh_error": rayleigh_error, "loss_factor": eta,
            "loss_factor_error": eta_error, "better": "rayleigh" if rayleigh_error <= eta_error else "loss factor"}
