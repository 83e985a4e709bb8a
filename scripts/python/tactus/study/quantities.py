"""Numbers with units in study files. Each operator of a profile has one unit for its levels."""
import re

from tactus.refusal import Refusal
from tactus.study import stages

TIME_MS = {"us": 1e-3, "ms": 1.0, "s": 1e3}
FORCE_N = {"N": 1.0, "mN": 1e-3}
# Operator of a study: (unit of its levels, factor of each permitted unit, least, most). The ranges are those of
# sync/degradation/parse_operator.cpp where it has one, else the range that a person could notice (design).
OPERATORS = {
    "delay": ("ms", TIME_MS, 0, 10_000), "network_delay": ("ms", TIME_MS, 0, 10_000), "jitter": ("ms", TIME_MS, 0, 10_000),  # jitter: standard deviation
    "loss": ("%", {"%": 1.0}, 0, 100), "rate": ("Hz", {"Hz": 1.0}, 0.1, 1000), "deadband": ("%", {"%": 1.0}, 0, 100),
    "wire_loss": ("%", {"%": 1.0}, 0, 100), "reorder": ("%", {"%": 1.0}, 0, 100), "duplicate": ("%", {"%": 1.0}, 0, 100), "skew": ("ppm", {"ppm": 1.0}, 0, 10_000),
    "quantise": ("N", FORCE_N, 0, 100), "gain": ("", {"": 1.0}, 0, 10), "bias": ("N", FORCE_N, 0, 100), "lowpass": ("Hz", {"Hz": 1.0}, 0.1, 1000),
    "frame_rate": ("Hz", {"Hz": 1.0}, 2, 240), "resolution": ("", {"": 1.0}, 0.01, 1), "dropout": ("ms", TIME_MS, 0, 990), "response": ("ms", TIME_MS, 0, 60_000)}
# Operators of a profile without levels: attributes of a <factor> beside its levels, with their values; the first one changes nothing.
CHOICES = {"predict": ("hold", "linear"), "passivity": ("none", "tdpa"), "conceal": ("hold", "zero")}
REMOVALS = ("off", "freeze")  # operators of a <remove>
JITTER_DELAY = 3  # constant network delay of a jitter, in standard deviations: the least one with which its mean and deviation hold (sync/random/jitter.h)
OUTPUT_OF = {"frame_rate": "visual", "resolution": "visual", "dropout": "audio", "response": "thermal"}  # modality.csv of each node folder
LOWER_IS_WORSE = ("rate", "frame_rate", "lowpass", "resolution", "gain")  # a lower level is a stronger degradation, as in analysis/operators.py
# Senses that receive no forces, on which these operators of force have no effect ("without" in modality.csv of each node folder).
NOT_OF = {"quantise": ("visual",), "gain": ("visual",), "bias": ("haptic", "visual"), "lowpass": ("haptic", "visual")}
SMALLEST = {"response": 1.0, "dropout": 1.0}  # of levels above 0
ASYNCHRONY = ("ms", TIME_MS, -5_000, 5_000)
PAUSE = ("s", {"ms": 1e-3, "s": 1.0}, 0, 3600)
SHARE = ("%", {"%": 1.0}, 0, 1000)


def read(text, of, where):
    """The number in `text`, converted to the unit of `of` (an entry like those above). Raises Refusal; `where` begins its sentence."""
    unit, factors, least, most = of
    number, written = re.fullmatch(r"([+-]?[0-9.]+)([A-Za-z%]*)", text).groups()
    value = float(number)
    if value == 0 and written == "" and unit != "":
        written = unit
    if written not in factors:
        raise Refusal(f"{where}: {text} needs the unit {' or '.join(factors) or 'none'}; write for example {least if least > 0 else 10}{unit}")
    value = round(value * factors[written], 9)
    if not least <= value <= most:
        raise Refusal(f"{where}: {text} is out of range; give {least}{unit} to {most}{unit}")
    return value


def written(value):
    """The shortest decimal form of a level."""
    return f"{value:.9g}"


def degrade(modality, operator, level, stage="", choices=()):
    """Profile element (sync/degradation/README.md) that applies the operator to a sense, at a stage of touch or ("") at its input, at this level. A jitter
    has a constant delay of JITTER_DELAY times its level: compare it with network_delay at that delay. Touch quantises the commanded force.
    choices: [(name, value)] of CHOICES."""
    unit = OPERATORS[operator][0]
    words = {"network_delay": f'delay="{written(level)}ms network"', "jitter": f'jitter="{written(level)}ms normal" delay="{written(JITTER_DELAY * level)}ms network"'}
    inside = "".join(f" {name}={value}" for name, value in choices if name == "predict")  # a word of the deadband; the others are attributes
    if operator == "deadband":
        words["deadband"] = f'deadband="{written(level)}%{stages.DEADBAND_OF.get(stage, "")}{inside}"'
    if (modality, operator, stage) == ("haptic", "quantise", ""):
        words["quantise"] = f'force_step="{written(level)}{unit}"'
    words.setdefault(operator, f'{operator}="{written(level)}{unit}"')
    beside = "".join(f' {name}="{value}"' for name, value in choices if name != "predict")
    return f'<degrade modality="{modality}" {stages.attribute(stage)}{words[operator]}{beside}/>'


def nothing(operator, level):
    """Whether the level has no effect; then no element is written."""
    return level == 0 and operator in ("delay", "network_delay", "jitter", "loss", "wire_loss", "reorder", "duplicate", "skew", "deadband", "quantise", "bias", "dropout", "response") or level == 1 and operator in ("gain", "resolution")
