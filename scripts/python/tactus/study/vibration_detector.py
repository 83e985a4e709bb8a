"""Haptic perception of a simulated participant: tick in which the vibration of a hit began, from the forces in TOOL_STATE."""
PULSE_TIMEOUT_S = 0.5  # pulses arrive without delay
NEAR_NS = 25_000_000   # around the expected tick, as for sound


class VibrationDetector:
    """Searches the pulses that a TrialRunnerClient stores."""

    def __init__(self, runner):
        self.runner = runner

    def onset_ns(self, expected_ns):
        """Time of the vibration onset nearest to the expected time, host time in ns; None: no onset there."""
        near = lambda: [at_ns for at_ns, _ in self.runner.pulses if abs(at_ns - expected_ns) <= NEAR_NS]
        self.runner.wait_for(near, PULSE_TIMEOUT_S)
        return min(near(), key=lambda at_ns: abs(at_ns - expected_ns), default=None)
