"""Feels: in which tick of the hand a hit began to vibrate, by the forces of TOOL_STATE."""
FELT_WITHIN_S = 0.5   # a tick tells of itself at once
NEAR_NS = 25_000_000  # about the expected tick, as the ear


class Skin:
    """Feels the pulses that a Lead keeps."""

    def __init__(self, lead):
        self.lead = lead

    def onset_ns(self, expected_ns):
        """The tick nearest to the expected one in which a vibration began, host time; None: none did."""
        near = lambda: [at_ns for at_ns, _ in self.lead.pulses if abs(at_ns - expected_ns) <= NEAR_NS]
        self.lead.wait_for(near, FELT_WITHIN_S)
        return min(near(), key=lambda at_ns: abs(at_ns - expected_ns), default=None)
