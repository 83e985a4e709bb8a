"""One line of what tactus doctor finds."""
import dataclasses

GOOD, WEAK, MISSING = "good", "weak", "missing"


@dataclasses.dataclass
class Line:
    what: str        # a few words
    verdict: str     # GOOD; WEAK: works, but worse than it should; MISSING: a run or a part of it cannot be had
    found: str       # one sentence with figures
    remedy: str = ""  # what to do about it; empty: nothing
    figures: dict = dataclasses.field(default_factory=dict)
    needed: bool = False  # without it the machine is not fit
