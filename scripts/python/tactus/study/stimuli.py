"""Stimuli of a trial on the live cluster: puts the profile in force, triggers a tap or press, and reads the measured presentation times."""
import dataclasses
import random

from tactus.launch import delays

IN_FORCE_TIMEOUT_S = 5.0     # health arrives at 10 Hz; after this time a sense is considered stuck
FOREPERIOD_S = (0.3, 0.7)    # range of the random time before the stimulus, which makes its onset unpredictable (design)
SETTLES_S = 0.2              # after a change of the profile and the delays of the previous one, until its messages have been presented (design)
REPORT_TIMEOUT_S = 1.5       # a sense reports twice, 20 ms apart, after it has presented
PART = {"haptic": "transient"}  # the part of a hit that is scheduled; the contact force of a surface is never delayed


@dataclasses.dataclass
class Observed:
    """Measured result of a stimulus. missed: reason why the apparatus missed its tolerance; "": it did not. times_ns: {modality: presentation time},
    uncertainties_ns likewise. soa_ms: asynchrony of the pair; uncertainty_ms: its uncertainty. stiffnesses_N_m: felt stiffness in each interval."""
    missed: str = ""
    event: str = ""
    times_ns: dict = dataclasses.field(default_factory=dict)
    uncertainties_ns: dict = dataclasses.field(default_factory=dict)
    soa_ms: float = None
    uncertainty_ms: float = None
    stiffnesses_N_m: tuple = ()
    reached_N: float = None
    sensed_ms: float = None  # asynchrony that a simulated participant perceived
    row: dict = dataclasses.field(default_factory=dict)

    def words(self):
        return ""


def wait(runner, seconds):
    runner.wait_for(lambda: False, seconds)


def ready(runner, profile):
    """"" if the profile is in force in every sense and nothing under the previous one is still to be presented, else the reason."""
    pending_s = delays.profile_text_s(getattr(runner, "profile", ""))
    runner.profile = profile
    if not runner.apply_profile(profile, IN_FORCE_TIMEOUT_S):
        return f"the profile was not in force in {', '.join(runner.missing()) or 'any sense'} after {IN_FORCE_TIMEOUT_S:g} s"
    wait(runner, SETTLES_S + pending_s)
    return ""


def first_hit(runner, known):
    """The first hit that is not among the known events; None: none yet."""
    return next((e for i, e in runner.events.items() if i not in known and e["kind"] == "hit"), None)


def tap(runner, study, trial, seed):
    """One tap under the trial's profile; returns an Observed."""
    senses = trial.condition.senses
    missed = ready(runner, study.profile(trial.condition, trial.level))
    if missed:
        return Observed(missed=missed)
    wait(runner, random.Random(seed).uniform(*FOREPERIOD_S))
    known = set(runner.events)
    if study.stimulus.by == "apparatus":
        runner.send(tap={"depth_m": study.stimulus.depth_m})
    longest_s = study.base_delay_ms / 1e3 + abs(trial.level or 0) / 1e3 + REPORT_TIMEOUT_S
    if not runner.wait_for(lambda: first_hit(runner, known) is not None, longest_s if study.stimulus.by == "apparatus" else 3600):
        return Observed(missed="the tap caused no hit")
    event = first_hit(runner, known)["event"]
    report = lambda sense: runner.presented.get((event, sense, PART.get(sense, "whole")))
    runner.wait_for(lambda: all(report(s) for s in senses), longest_s)
    observed = Observed(event=event)
    for sense in senses:
        r = report(sense)
        if r is None or r["at_ns"] is None:
            return dataclasses.replace(observed, missed=f"{sense} did not present the hit" + (f" ({r['outcome'].replace('_', ' ')})" if r else ""))
        observed.times_ns[sense], observed.uncertainties_ns[sense] = r["at_ns"], r["uncertainty_ns"]
    a, b = senses
    observed.soa_ms = (observed.times_ns[b] - observed.times_ns[a]) * 1e-6
    observed.uncertainty_ms = sum(observed.uncertainties_ns.values()) * 1e-6
    error = observed.soa_ms - trial.level
    if abs(error) > study.tolerance_ms:
        observed.missed = f"the asynchrony was {observed.soa_ms:.1f} ms instead of {trial.level:g} ms, more than {study.tolerance_ms:g} ms off"
    wait(runner, 0.3)  # until the hand is back and the ringing has decayed
    return observed


def felt_stiffness(samples):
    """Stiffness of one press, N/m: least-squares slope of force over depth, of samples (at_ns, z_m, force_N) with a noticeable force; None: there are
    too few."""
    import numpy as np  # loads slowly
    data = np.array([s for s in samples if s[2] > 0.02], dtype=float).reshape(-1, 3)  # N; about the noise of the device, below the threshold of a fingertip (design)
    if len(data) < 10 or np.ptp(data[:, 1]) < 1e-4:
        return None
    depth = data[:, 1].max() - data[:, 1]
    return float(np.polyfit(depth, data[:, 2], 1)[0])


def press(runner, study, trial, seed):
    """Two presses: one under the trial's profile, the other under the base alone. Returns an Observed."""
    stiffnesses, strongest = [], 0.0
    for interval in (0, 1):
        level = trial.level if interval == trial.degraded_interval else None
        missed = ready(runner, study.profile(trial.condition, level))
        if missed:
            return Observed(missed=missed)
        wait(runner, random.Random(seed + interval).uniform(*FOREPERIOD_S))
        runner.felt.clear()
        runner.moved = False
        s = study.stimulus
        runner.send(press={"depth_m": s.depth_m, "period_s": s.period_s, "times": s.times})
        if not runner.wait_for(lambda: runner.moved, s.period_s * s.times + 5):
            return Observed(missed="the hand did not return from the press")
        stiffness = felt_stiffness(runner.felt)
        if stiffness is None:
            return Observed(missed=f"nothing was felt in interval {interval + 1}")
        stiffnesses.append(stiffness)
        strongest = max(strongest, max(f for _, _, f in runner.felt))
    return Observed(stiffnesses_N_m=tuple(stiffnesses), reached_N=strongest, row={"stiffness_first_n_m": round(stiffnesses[0], 4),
                    "stiffness_second_n_m": round(stiffnesses[1], 4), "degraded_interval": trial.degraded_interval + 1})
