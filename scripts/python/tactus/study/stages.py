"""Stages of touch in study files: places in its loop at which a degradation acts (docs/concepts/touch_stages.md). "" is its input, the stage model."""

# Operators of quantities.OPERATORS that each stage beside the input has: sync/degradation/parse_profile.cpp and haptic_node/modality.csv.
STAGES = {"action": ("delay", "network_delay", "jitter", "loss", "rate", "deadband"),
          **dict.fromkeys(("force", "percept"), ("delay", "network_delay", "jitter", "loss", "rate", "deadband", "quantise", "gain", "lowpass"))}
MODEL, PERCEPT = "model", "percept"
NEUTRAL = ("hold", "none")  # choices that change nothing: the first ones of quantities.CHOICES
LONGEST_MS = {"action": 1000, "force": 1000, "percept": 2000}  # delay of a stage, with the spread of its jitter
DEADBAND_OF = {"action": " velocity", "force": " force", "percept": " force"}  # quantity that a deadband compares
# Choices of quantities.CHOICES: the operators and the stages ("": the input) that have them; None: every operator of the stage.
CHOICES_OF = {"predict": (("deadband",), tuple(STAGES)), "passivity": (None, ("force",)), "conceal": (("loss",), ("", "force", "percept"))}
JITTER_SPREADS = 6  # of a jitter, in standard deviations: its constant delay (quantities.JITTER_DELAY), and the spread that it needs around it


def named(modality, stage):
    """A sense, with its stage after a colon, as tables and DEGRADED name it."""
    return f"{modality}:{stage}" if stage else modality


def attribute(stage):
    """Attribute of a <degrade> that acts at a stage; "": at the input."""
    return f'stage="{stage}" ' if stage else ""


def of(text, modality, operator, levels=()):
    """The stage of an attribute stage=; None: it is absent. Raises ValueError with one sentence when the modality has no such stage, or the stage does not have
    the operator, off or freeze, or not at these levels."""
    if text is not None and modality != "haptic":
        raise ValueError(f'{modality} has no stages; remove stage=, or give modality="haptic"')
    if text not in (None, MODEL, *STAGES):
        raise ValueError(f"there is no stage {text}; choose from {', '.join((MODEL, *STAGES))}")
    if text in (None, MODEL):
        return ""
    stage = text
    if operator not in (*STAGES[stage], "off", *(() if stage == "action" else ("freeze",))):
        raise ValueError(f"the stage {stage} has no operator {operator}; choose from {', '.join(STAGES[stage])}")
    longest = max(({"delay": l, "network_delay": l, "jitter": JITTER_SPREADS * l}.get(operator, 0) for l in levels), default=0)
    if longest > LONGEST_MS[stage]:
        raise ValueError(f"{operator} delays the stage {stage} by up to {longest:g} ms; at most {LONGEST_MS[stage]} ms are possible, so give smaller levels")
    return stage


def choices(given, operator, stage):
    """((name, value), ...) of the choices of a factor that change something. given: {name: value}. Raises ValueError with one sentence when the operator or the stage
    does not have one of them."""
    for name in given:
        operators, places = CHOICES_OF[name]
        if operators is not None and operator not in operators:
            raise ValueError(f"{name}= belongs to {' or '.join(operators)} and not to {operator}; remove it")
        if stage not in places:
            raise ValueError(f"{name}= has no effect at the stage {stage or MODEL}; give stage=\"{places[-1]}\", or remove it")
    return tuple((name, value) for name, value in given.items() if value not in NEUTRAL)
