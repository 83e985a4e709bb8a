"""<procedure> of a study file: which level comes when. Read, and tried: what the procedure itself would refuse is refused with the line."""
import numpy as np

from tactus.psychophysics import functions, procedures
from tactus.study import quantities

MOST_TRIALS = 100_000
NEEDS = {"constant": ("repetitions",), "staircase": ("rule", "start", "step", "minimum_step", "lowest", "highest", "reversals"), "quest_plus": ("function", "trials")}
LEVELS = ("start", "step", "minimum_step", "lowest", "highest")


def of_condition(procedure, condition):
    """The specification for scripts/python/tactus/psychophysics of a condition's procedure."""
    spec = dict(procedure)
    if spec["kind"] != "staircase":
        spec["levels"] = list(condition.levels)
    if condition.kind == "pair":  # a procedure of numbers: of which pair
        spec["levels"] = list(range(len(condition.levels)))
    return spec


def read(reading, e, yes_or_no, response, found):
    """The specification without levels, which are those of each condition. reading: refuses, with the line. yes_or_no: whether a psychometric
    function describes the answers. found: the conditions."""
    if e is None:
        reading.refuse(reading.root, "there is no <procedure>; give for example <procedure kind=\"constant\" repetitions=\"20\"/>")
    kind = e.get("kind")
    for name in NEEDS[kind]:
        if e.get(name) is None:
            reading.refuse(e, f"a procedure of kind {kind} needs {name}=")
    for name in e.attrib:
        if name not in (*NEEDS[kind], "kind"):
            reading.refuse(e, f"a procedure of kind {kind} has no {name}=")
    if kind != "constant" and not yes_or_no:
        reading.refuse(e, f"a {kind} follows answers that are yes or no, and those of {response} are not; use kind=\"constant\"")
    if kind != "constant" and any(c.kind == "pair" for c in found):
        reading.refuse(e, "a pair is measured by constant stimuli; use kind=\"constant\"")
    if kind != "constant" and response == "two_interval" and any(c.factors[0].operator in quantities.FALLING for c in found):
        reading.refuse(e, f"a {kind} lowers the level where answers are right, but less of {', '.join(quantities.FALLING)} is worse; use kind=\"constant\"")
    if kind != "quest_plus" and e.find("prior") is not None:
        reading.refuse(e.find("prior"), "only quest_plus has a <prior>")
    if response == "two_interval" and e.get("rule") == "1up1down":
        reading.refuse(e, "a 1up1down seeks half of the answers right, which chance alone gives of two intervals; use rule=\"1up2down\" or rule=\"weighted\"")
    spec = {"kind": kind}
    axis = axis_of(reading, e, found) if kind == "staircase" else None
    for name in NEEDS[kind]:
        if name in LEVELS:
            spec[name] = quantities.read(e.get(name), axis, reading.where(e))
        else:
            spec[name] = e.get(name) if name in ("rule", "function") else int(e.get(name))
    if kind == "quest_plus":
        spec["parameters"] = priors(reading, e, spec["function"])
    total = sum(len(c.levels) or 1 for c in found) * spec.get("repetitions", 1)
    if total > MOST_TRIALS:
        reading.refuse(e, f"these are {total} trials; no more than {MOST_TRIALS} are planned")
    if yes_or_no:
        for condition in found:
            tried(reading, e, of_condition(spec, condition))
    return spec


def axis_of(reading, e, found):
    """Unit and range (as in quantities) of the levels of all staircases, which have one specification."""
    axes = [quantities.ASYNCHRONY if c.kind == "asynchrony" else quantities.OPERATORS[c.factors[0].operator] for c in found]
    if any(axis != axes[0] for axis in axes):
        reading.refuse(e, "staircases of one study go over levels of one kind; make a study for each operator")
    return axes[0]


def priors(reading, e, name):
    """{parameter: values} of the <prior>s of QUEST+."""
    function = functions.FUNCTIONS.get(name)
    known = [n for n, f in functions.FUNCTIONS.items() if f.dimensions == 1]
    if name not in known:
        reading.refuse(e, f"there is no function {name} of one level; choose from {', '.join(known)}")
    found = {}
    for p in e.findall("prior"):
        low, high = float(p.get("from")), float(p.get("to"))
        if p.get("parameter") not in function.parameters or p.get("parameter") in found or low > high:
            reading.refuse(p, f"{name} has the parameters {', '.join(function.parameters)}, each once, and a prior goes up from= to=")
        bounds = function.bounds[p.get("parameter")]
        if not bounds[0] <= low <= high <= bounds[1] or bounds[0] == 0 == low and p.get("parameter") in function.parameters[:2]:
            reading.refuse(p, f"{p.get('parameter')} of {name} lies within {bounds[0]:g} to {bounds[1]:g}" + (", above 0" if p.get("parameter") in function.parameters[:2] else ""))
        found[p.get("parameter")] = spread(low, high, int(p.get("count")))
    for parameter in function.parameters:
        if parameter not in found:
            reading.refuse(e, f"quest_plus needs <prior parameter=\"{parameter}\" from= to= count=/> of {name}")
    return found


def spread(low, high, count):
    """`count` numbers from low to high, both included."""
    return [low] if count == 1 else [low + (high - low) * i / (count - 1) for i in range(count)]


def tried(reading, e, spec):
    """Makes the procedure once. Of QUEST+ some parameters allow either answer at every level: else an answer that none allows would end a session."""
    try:
        with np.errstate(all="ignore"):
            made = procedures.make_procedure(spec, 1)
    except ValueError as error:
        reading.refuse(e, str(error))
    if spec["kind"] == "quest_plus":
        p = made.tables.yes
        if not np.isfinite(p).all():
            reading.refuse(e, "these priors hold parameters for which there is no probability at some level; let thresholds, slopes and spreads begin above 0")
        if not ((p > 0) & (p < 1)).all(axis=0).any():
            reading.refuse(e, "no parameters of these priors allow both answers at every level; let guess and lapse rates go above 0")
