"""The longest intended delay of a run, so that the last events are presented before the modalities are stopped."""
import re
import xml.etree.ElementTree

from tactus.launch import scene

QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(ns|us|ms|s)?(?=$|[\s,])")
UNIT_S = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, None: 1.0}
MAX_S = 61.0  # a delay of a profile, of the playout and of a setting is at most a minute each: sync/degradation/parse_operator.cpp
EXPERIMENT_BASE_S = 0.15  # sync/playout/options.cpp
SETTING = "presentation_delay"


def seconds(text):
    """The first quantity of a text such as "300ms" or "0.5 s gauss" in s; 0 when there is none. A number without a unit is in s."""
    found = QUANTITY.match(text)
    return float(found[1]) * UNIT_S[found[2]] if found else 0.0


def longest_s(plan):
    """Upper bound of the delays that the command line, the scene and the profile of the run set, s, at most MAX_S. The delay that
    sync_node measures is not in it."""
    own = [seconds(s.partition("=")[2]) for given in plan.settings.values() for s in given if s.partition("=")[0] == SETTING]
    own += [seconds(attributes[SETTING]) for _, attributes in scene.world_elements(plan.scene) if SETTING in attributes]
    return min(MAX_S, max([0.0, *own, playout_s(plan.playout)]) + profile_s(plan.degrade))


def playout_s(words):
    """The longest delay of the options of sync_node."""
    given = {word.partition("=")[0]: word.partition("=")[2] for word in words}
    asynchronies = [seconds(part.partition("=")[2]) for part in given.get("--soa", "").split(",")]
    experiment = "--soa" in given or given.get("--policy") == "experiment"
    return seconds(given.get("--base", str(EXPERIMENT_BASE_S if experiment else 0))) + max(0.0, *asynchronies)


def profile_s(path):
    """The longest delay of a modality in a profile, with the scale of its jitter."""
    if path is None:
        return 0.0
    try:
        return profile_text_s(path.read_bytes())
    except OSError:
        return 0.0  # the nodes report the error


def profile_text_s(text):
    """The same of the XML of a profile."""
    try:
        rules = list(xml.etree.ElementTree.fromstring(text).iter("degrade"))
    except (xml.etree.ElementTree.ParseError, LookupError, ValueError):
        return 0.0  # the nodes report the error with its line
    by_modality = {}
    for rule in rules:
        if rule.get("stage") in ("action", "percept"):
            continue  # no node presents anything later
        by_modality[rule.get("modality")] = by_modality.get(rule.get("modality"), 0.0) + sum(seconds(rule.get(name, "")) for name in ("delay", "jitter"))
    return max(by_modality.values(), default=0.0)
