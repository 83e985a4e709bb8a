"""One result of tactus doctor."""
import dataclasses

GOOD, WEAK, MISSING = "good", "weak", "missing"


@dataclasses.dataclass
class Line:
    what: str        # name of the check, a few words
    verdict: str     # GOOD; WEAK: works with restrictions; MISSING: a run, or a part of it, is impossible
    found: str       # one sentence with figures
    remedy: str = ""  # action of the user; empty: none
    figures: dict = dataclasses.field(default_factory=dict)
    needed: bool = False  # True: when MISSING, the machine is not fit
