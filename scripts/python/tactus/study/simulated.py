"""A simulated participant on the live cluster: perceives audio samples, haptic ticks and video frames, and answers by a psychometric function of
the perceived stimulus. All answers are marked observer=simulated."""

from tactus.psychophysics import observers
from tactus.study.flash_detector import FlashDetector
from tactus.study.sound_detector import SoundDetector
from tactus.study.vibration_detector import VibrationDetector

UNPERCEIVED = {"audio": "the sound of the hit is not in the samples", "visual": "the first frame that shows the hit was not received",
               "haptic": "the vibration of the hit is not in the ticks"}


class Participant:
    def __init__(self, study, name, seed, out, runner):
        self.study, self.name, self.seed, self.runner = study, name, seed, runner
        sound, flash, vibration = SoundDetector(out, runner), FlashDetector(runner), VibrationDetector(runner)
        self.onsets_ns = {"audio": lambda o: sound.onset_ns(o.times_ns["audio"]), "visual": lambda o: flash.onset_ns(int(o.event), o.times_ns["visual"]),
                       "haptic": lambda o: vibration.onset_ns(o.times_ns["haptic"])}

    def perceived_ms(self, observed):
        """(perceived asynchrony in ms, ""), or (None, reason why it was not perceived). Warmth has no onset; its reported time is used."""
        times = {}
        for sense, reported_ns in observed.times_ns.items():
            times[sense] = self.onsets_ns[sense](observed) if sense in self.onsets_ns else reported_ns
            if times[sense] is None:
                return None, UNPERCEIVED[sense]
        a, b = times.values()
        return (b - a) * 1e-6, ""

    def is_yes(self, trial, attempt, level, observed):
        """Whether the answer is yes: together (synchrony), the first sense first (order), or the degraded interval found (two_interval). An observer of
        stiffness judges the two felt stiffnesses and ignores the level."""
        observer = self.study.observer(trial.condition)
        seed = [self.seed, len(self.name), *self.name.encode(), trial.number, attempt]
        if observer.function in observers.PERCEPTS:
            return observers.PERCEPTS[observer.function](**observer.params, seed=seed).softer(*observed.stiffnesses_N_m) == trial.degraded_interval
        return observers.SimulatedObserver(observer.function, observer.params, seed).answer(level)
