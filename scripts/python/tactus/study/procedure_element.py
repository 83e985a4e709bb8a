"""The <procedure> element of a study file: reads it, builds the procedure once, and refuses errors with the line."""
import numpy as np

from tactus.psychophysics import functions, procedures
from tactus.study import quantities

MAX_TRIALS = 100_000
NEEDS = {"constant": ("repetitions",), "staircase": ("rule", "start", "step", "minimum_step", "lowest", "highest", "reversals"), "quest_plus": ("function", "trials")}
LEVELS = ("start", "step", "minimum_step", "lowest", "highest")


def of_condition(procedure, condition):
    """Specification of a condition's procedure, for tactus/psychophysics/procedures.py."""
    spec = dict(procedure)
    if spec["kind"] != "staircase":
        spec["levels"] = list(condition.levels)
    if condition.kind == "pair":  # the procedure chooses among indices of pairs
        spec["levels"] = list(range(len(condition.levels)))
    return spec


def read(reading, e, yes_or_no, response, found):
    """The specification without levels; each condition has its own. reading: study_file.Reading, which refuses with the line. yes_or_no: whether a
    psychometric function describes the answers. found: the conditions."""
    if e is None:
        reading.refuse(reading.root, "<procedure> is missing; give for example <procedure kind=\"constant\" repetitions=\"20\"/>")
    kind = e.get("kind")
    for name in NEEDS[kind]:
        if e.get(name) is None:
            reading.refuse(e, f"a procedure of kind {kind} needs {name}=")
    for name in e.attrib:
        if name not in (*NEEDS[kind], "kind"):
            reading.refuse(e, f"a procedure of kind {kind} has no {name}=; remove it")
    if kind != "constant" and not yes_or_no:
        reading.refuse(e, f"{kind} needs yes/no answers, but answers to {response} are not; use kind=\"constant\"")
    if kind != "constant" and any(c.kind == "pair" for c in found):
        reading.refuse(e, f"{kind} cannot choose the levels of a pair; use kind=\"constant\"")
    if kind != "constant" and response == "two_interval" and any(c.factors[0].operator in quantities.LOWER_IS_WORSE for c in found):
        reading.refuse(e, f"{kind} lowers the level after right answers, but a lower {', '.join(quantities.LOWER_IS_WORSE)} is a stronger degradation; use kind=\"constant\"")
    if kind != "quest_plus" and e.find("prior") is not None:
        reading.refuse(e.find("prior"), "only quest_plus takes a <prior>; remove it, or use kind=\"quest_plus\"")
    if response == "two_interval" and e.get("rule") == "1up1down":
        reading.refuse(e, "1up1down converges to 50 % right answers, which is chance for two intervals; use rule=\"1up2down\" or rule=\"weighted\"")
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
    if total > MAX_TRIALS:
        reading.refuse(e, f"{total} trials are too many; plan at most {MAX_TRIALS}")
    if yes_or_no:
        for condition in found:
            tried(reading, e, of_condition(spec, condition))
    return spec


def axis_of(reading, e, found):
    """Unit and range (an entry of quantities) of the levels; all staircases of a study share them."""
    axes = [quantities.ASYNCHRONY if c.kind == "asynchrony" else quantities.OPERATORS[c.factors[0].operator] for c in found]
    if any(axis != axes[0] for axis in axes):
        reading.refuse(e, "the staircases of one study need levels of one kind; make one study for each operator")
    return axes[0]


def priors(reading, e, name):
    """{parameter: values} of the <prior> elements of QUEST+."""
    function = functions.FUNCTIONS.get(name)
    known = [n for n, f in functions.FUNCTIONS.items() if f.dimensions == 1]
    if name not in known:
        reading.refuse(e, f"there is no function {name} of one level; choose from {', '.join(known)}")
    found = {}
    for p in e.findall("prior"):
        low, high = float(p.get("from")), float(p.get("to"))
        if p.get("parameter") not in function.parameters or p.get("parameter") in found or low > high:
            reading.refuse(p, f"{name} needs a prior for each of {', '.join(function.parameters)}, once, with from= at most to=")
        bounds = function.bounds[p.get("parameter")]
        if not bounds[0] <= low <= high <= bounds[1] or bounds[0] == 0 == low and p.get("parameter") in function.parameters[:2]:
            reading.refuse(p, f"the prior of {p.get('parameter')} is out of range for {name}; give values from {bounds[0]:g} to {bounds[1]:g}"
                           + (", above 0" if p.get("parameter") in function.parameters[:2] else ""))
        found[p.get("parameter")] = spread(low, high, int(p.get("count")))
    for parameter in function.parameters:
        if parameter not in found:
            reading.refuse(e, f"quest_plus needs <prior parameter=\"{parameter}\" from= to= count=/> of {name}")
    return found


def spread(low, high, count):
    """`count` numbers from low to high, both included."""
    return [low] if count == 1 else [low + (high - low) * i / (count - 1) for i in range(count)]


def tried(reading, e, spec):
    """Builds the procedure once. For QUEST+, some parameters must allow both answers at every level; otherwise an impossible answer would end a session."""
    try:
        with np.errstate(all="ignore"):
            made = procedures.make_procedure(spec, 1)
    except ValueError as error:
        reading.refuse(e, str(error))
    if spec["kind"] == "quest_plus":
        p = made.tables.yes
        if not np.isfinite(p).all():
            reading.refuse(e, "some parameters of these priors give no probability at some level; begin thresholds, slopes and spreads above 0")
        if not ((p > 0) & (p < 1)).all(axis=0).any():
            reading.refuse(e, "no parameters of these priors allow both answers at every level; extend the priors of guess and lapse above 0")
