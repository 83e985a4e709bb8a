"""A simulated participant on the live cluster: he hears the samples of audio.wav, feels the ticks and sees the frames, and answers as a
psychometric function says of what he perceived. Everything that he answers is marked observer=simulated."""

from tactus.psychophysics import observers
from tactus.study.ear import Ear
from tactus.study.eye import Eye
from tactus.study.skin import Skin

UNPERCEIVED = {"audio": "the sound of the hit is not in the samples", "visual": "the frame that shows the hit first was not seen",
               "haptic": "the vibration of the hit is not in the ticks"}


class Participant:
    def __init__(self, study, name, seed, out, lead):
        self.study, self.name, self.seed, self.lead = study, name, seed, lead
        ear, eye, skin = Ear(out, lead), Eye(lead), Skin(lead)
        self.organs = {"audio": lambda o: ear.onset_ns(o.times_ns["audio"]), "visual": lambda o: eye.onset_ns(int(o.event), o.times_ns["visual"]),
                       "haptic": lambda o: skin.onset_ns(o.times_ns["haptic"])}

    def perceived_ms(self, observed):
        """(asynchrony of what was really heard, felt and seen, ""), or (None, what of it was not perceived). Of warmth, which has no onset, it is the
        tick that its sense reports."""
        times = {}
        for sense, reported_ns in observed.times_ns.items():
            times[sense] = self.organs[sense](observed) if sense in self.organs else reported_ns
            if times[sense] is None:
                return None, UNPERCEIVED[sense]
        a, b = times.values()
        return (b - a) * 1e-6, ""

    def says_yes(self, trial, attempt, level, observed):
        """Of a synchrony: together; of an order: the first sense came first; of two intervals: he has found the degraded one. Of stiffness he judges the
        two that he felt, and the level is nothing to him."""
        observer = self.study.observer(trial.condition)
        seed = [self.seed, len(self.name), *self.name.encode(), trial.number, attempt]
        if observer.function in observers.PERCEPTS:
            return observers.PERCEPTS[observer.function](**observer.params, seed=seed).softer(*observed.stiffnesses_N_m) == trial.degraded_interval
        return observers.SimulatedObserver(observer.function, observer.params, seed).answer(level)
