"""The study file: what is varied, what is asked, in which order. Checked whole before anything starts."""
import dataclasses
import hashlib
import itertools
import pathlib
from xml.sax.saxutils import quoteattr

import numpy as np

from tactus.paths import SCENES, SCRIPTS
from tactus.psychophysics import functions, observers
from tactus.refusal import Refusal
from tactus.study import conditions, procedure_element, quantities

SCHEMA = pathlib.Path(__file__).with_name("study.xsd")
SHIPPED = SCRIPTS / "studies"
LARGEST_BYTES = 1_000_000
LONGEST_TEXT, LONGEST_CHOICE = 600, 40  # lcmtypes/types/control/question_t.lcm
MOST_CONDITIONS = 2000
MOST_LEVELS = 100_000  # of a pair; procedure_element.MOST_TRIALS, each once
YES_OR_NO = ("synchrony", "order", "two_interval")  # answers that a psychometric function describes
QUESTIONS = {
    "synchrony": ("Did {a} and {b} come together?", ("together", "apart")),
    "order": ("Which came first?", ("{a}", "{b}")),
    "two_interval": ("In which of the two was something wrong?", ("the first", "the second")),
    "rating": ("How good was that?", ()), "matching": ("How much was it?", ()), "performance": ("", ())}
JUDGED = {"tap": "asynchrony", "press": "factor"}  # kinds of conditions of a task
SOFTER = "Which of the two felt softer?"  # of two presses, where the study asks for their stiffness
# What touch learns of its channel it forgets within seconds (LoopDelay in haptic_node/rendering/coupling.h), a delay of its output alone at once: the press after one
# that was degraded so would be soft of it, too.
SLOW_TO_FORGET = ("network_delay", "jitter", "loss", "rate", "deadband")
SPOKEN = {"haptic": "touch", "audio": "sound", "visual": "picture", "thermal": "warmth"}


@dataclasses.dataclass(frozen=True)
class Item:
    """A question of a questionnaire. choices, or a number from lowest to highest."""
    id: str
    text: str
    choices: tuple
    lowest: float
    highest: float
    step: float


@dataclasses.dataclass(frozen=True)
class Stimulus:
    """by: apparatus (its hand strikes when the trial wants it, from `rest_m`, `above_m` over the surface, `depth_m` into it; a press goes down and up
    `times` times in `period_s`) or participant. limit_s: of a game."""
    by: str = "apparatus"
    rest_m: tuple = (0.0, 0.0, 0.04)
    above_m: float = 0.032
    depth_m: float = 0.012
    period_s: float = 1.0
    times: int = 2
    limit_s: float = 30.0


@dataclasses.dataclass(frozen=True)
class Observer:
    """A simulated participant in a condition. function: psychometric, of the level; or one of observers.PERCEPTS, of what he felt. sources: {parameter:
    where its value is from}."""
    function: str
    params: dict
    sources: dict


@dataclasses.dataclass(frozen=True)
class Study:
    name: str
    path: pathlib.Path
    sha256: str         # of the file
    scene: pathlib.Path  # None where it was not looked for
    task: str           # tap, press or game
    seed: int
    instructions: tuple
    base_delay_ms: float  # of every sense, under the policy experiment: so that each can be early
    base: tuple           # elements of the profile that is always there
    conditions: tuple     # of conditions.Condition
    procedure: dict       # as scripts/python/tactus/psychophysics/procedures.py reads it, but for the levels of each condition
    response: str
    question: str
    choices: tuple
    number: tuple         # (lowest, highest, step) of a rating or matching; ()
    of: str               # the property that is matched, or judged of two presses; ""
    stimulus: Stimulus
    questionnaire: tuple
    questionnaire_at: str  # end or block
    blocks: int
    break_s: float
    counterbalance: str
    tolerance_ms: float   # a trial whose asynchrony misses what was wanted by more is repeated
    repeats: int          # so often at the most
    margin: dict          # {"time": share, "success": share}
    observers: dict       # {condition id, or "": Observer}

    def profile(self, condition, level):
        """XML of the profile of a trial."""
        name = f"{self.name}: {condition.id}" + ("" if level is None else f" at {level}")
        return f"<profile name={quoteattr(name)} seed=\"{self.seed}\">" + "".join((*self.base, *condition.elements(level))) + "</profile>"

    def observer(self, condition):
        return self.observers.get(condition.id) or self.observers.get("")


def find(text):
    """A file, or the name of a shipped one."""
    path = pathlib.Path(text)
    if not path.is_file() and path.name == text:
        for name in (text, text + ".xml"):
            if (SHIPPED / name).is_file():
                return SHIPPED / name
    return path


def read(text, with_scene=True):
    """Study of the file, or of the shipped one of that name. with_scene: False for a copy beside the results, whose scene lies where the file came
    from. Raises Refusal, with the line."""
    from lxml import etree  # only who reads a file needs it
    path = find(str(text))
    try:
        data = path.read_bytes()
    except OSError as error:
        shipped = ", ".join(sorted(p.stem for p in SHIPPED.glob("*.xml")))
        raise Refusal(f"{text}: cannot be read ({error.strerror}); give a study file, or one of {shipped}") from None
    if len(data) > LARGEST_BYTES:
        raise Refusal(f"{text}: is longer than {LARGEST_BYTES} bytes; that is no study file")
    try:
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True))
    except etree.XMLSyntaxError as error:
        raise Refusal(f"{text}:{error.lineno}: {error.msg.splitlines()[0]}") from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise Refusal(f"{text}:1: has a <!DOCTYPE>, whose entities and defaults a study file does not use; leave it away, and write out what it stands for")
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    if not schema.validate(root):
        first = schema.error_log[0]
        for e in root.iter("instructions", "question", "choice", "text"):
            if e.sourceline == first.line and (letter := next((c for c in e.text or "" if not c.isascii()), None)):
                raise Refusal(f"{text}:{first.line}: a text of {e.tag} is ASCII, which {letter!r} is not")
        raise Refusal(f"{text}:{first.line}: {first.message.splitlines()[0]}")
    return Reading(text, path, root, hashlib.sha256(data).hexdigest(), with_scene).study()


class Reading:
    def __init__(self, text, path, root, sha256, with_scene=True):
        self.text, self.path, self.root, self.sha256, self.with_scene = text, path, root, sha256, with_scene

    def refuse(self, element, reason):
        raise Refusal(f"{self.text}:{element.sourceline}: {reason}")

    def where(self, element):
        return f"{self.text}:{element.sourceline}"

    def quantity(self, element, name, of, default=None):
        text = element.get(name) if element is not None else None
        return default if text is None else quantities.read(text, of, self.where(element))

    def words(self, element, longest=LONGEST_TEXT):
        text = " ".join((element.text or "").split())
        if not text or len(text) > longest:
            self.refuse(element, f"a text of {element.tag} has 1 to {longest} characters, this one {len(text)}")
        return text

    def sense(self, element, name):
        if name not in conditions.SENSES:
            self.refuse(element, f"there is no sense {name}; choose from {', '.join(conditions.SENSES)}")
        return name

    def study(self):
        root, find = self.root, self.root.find
        response = find("response")
        kind = response.get("kind", "synchrony") if response is not None else "synchrony"
        task = root.get("task")
        if (task == "game") != (kind == "performance"):
            self.refuse(root, "a game is answered by performance, and nothing else is; set task=\"game\" and <response kind=\"performance\"/>, or neither")
        found = self.conditions(find("conditions"), kind)
        wanted = JUDGED.get(task)
        if wanted and any(c.kind != wanted for c in found):
            self.refuse(find("conditions"), f"what is judged of a {task} is of <{wanted}> alone; that of a tap is <asynchrony>, that of a press <factor>")
        question, choices, number = self.asked(response, kind, found)
        if kind == "two_interval" and self.of(response, kind):
            self.forgotten_at_once(find("conditions"), found)
        blocks, tolerance, margin, base = find("blocks"), find("tolerance"), find("margin"), find("base")
        return Study(
            name=root.get("name"), path=self.path, sha256=self.sha256, scene=self.scene() if self.with_scene else None, task=task, seed=int(root.get("seed", "1")),
            instructions=tuple(self.words(e) for e in root.findall("instructions")),
            base_delay_ms=self.quantity(base, "delay", quantities.OPERATORS["delay"], 100.0),
            base=tuple(self.element(e) for e in (base if base is not None else ())),
            conditions=tuple(found), procedure=procedure_element.read(self, find("procedure"), kind in YES_OR_NO, kind, found), response=kind, question=question, choices=choices,
            number=number, of=self.of(response, kind), stimulus=self.stimulus(find("stimulus")), questionnaire=self.questionnaire(find("questionnaire")),
            questionnaire_at=find("questionnaire").get("at", "end") if find("questionnaire") is not None else "end",
            blocks=int(blocks.get("count")) if blocks is not None else 1,
            break_s=self.quantity(blocks, "break", quantities.PAUSE, 0.0),
            counterbalance=find("counterbalance").get("kind") if find("counterbalance") is not None else "random",
            tolerance_ms=self.quantity(tolerance, "asynchrony", quantities.OPERATORS["delay"], 20.0),
            repeats=int(tolerance.get("repeats", "3")) if tolerance is not None else 3,
            margin={"time": self.quantity(margin, "time", quantities.SHARE, 10.0) / 100, "success": self.quantity(margin, "success", quantities.SHARE, 10.0) / 100},
            observers=self.observers(found, kind))

    def scene(self):
        text = self.root.get("scene")
        for path in (self.path.parent / text, SCENES / text):
            if path.is_file():
                return path.resolve()
        self.refuse(self.root, f"the scene {text} is not a file beside the study, nor in sim_node/scenes")

    def element(self, e):
        self.sense(e, e.get("modality", ""))
        return "<degrade " + " ".join(f"{k}={quoteattr(v)}" for k, v in e.attrib.items()) + "/>"

    def factor(self, e):
        operator = e.get("operator")
        levels = tuple(quantities.read(t, quantities.OPERATORS[operator], self.where(e)) for t in e.get("levels").split())
        self.distinct(e, levels)
        modality, only = self.sense(e, e.get("modality")), quantities.OUTPUT_OF.get(operator)
        if only not in (None, modality):
            self.refuse(e, f"{modality} has no {operator}, which only {only} has")
        low = [l for l in levels if 0 < l < quantities.SMALLEST.get(operator, 0)]
        if low:
            self.refuse(e, f"a level of {operator} is 0 or at least {quantities.SMALLEST[operator]:g} {quantities.OPERATORS[operator][0]}, not {low[0]:g}")
        return conditions.Factor(modality, operator), levels

    def distinct(self, e, levels):
        if not levels or len(set(levels)) < len(levels):
            self.refuse(e, "levels are one or more, and each stands there once")

    def conditions(self, all_of, kind):
        found = []
        for e in all_of:
            if e.tag == "asynchrony":
                senses = tuple(self.sense(e, s) for s in e.get("between").split())
                if len(set(senses)) != 2:
                    self.refuse(e, "an asynchrony is between two senses, for example between=\"audio visual\"")
                levels = tuple(quantities.read(t, quantities.ASYNCHRONY, self.where(e)) for t in e.get("levels").split())
                self.distinct(e, levels)
                one = conditions.Condition("-".join(senses), "asynchrony", senses=senses, levels=levels)
            elif e.tag == "factor":
                factor, levels = self.factor(e)
                one = conditions.Condition(factor.words(), "factor", factors=(factor,), levels=levels)
            elif e.tag == "pair":
                factors, levels = zip(*(self.factor(f) for f in e))
                if factors[0] == factors[1]:
                    self.refuse(e, "a pair is of two different factors")
                if len(levels[0]) * len(levels[1]) > MOST_LEVELS:
                    self.refuse(e, f"a pair of {len(levels[0])} and {len(levels[1])} levels has more than {MOST_LEVELS}")
                one = conditions.Condition(" x ".join(f.words() for f in factors), "pair", factors=factors, levels=tuple(itertools.product(*levels)))
            elif e.tag == "remove":
                modality = self.sense(e, e.get("modality"))
                one = conditions.Condition(f"{modality} removed", "remove", removed=modality, how=e.get("how", "off"))
            else:
                one = conditions.Condition("nothing degraded", "nothing")
            if kind in ("synchrony", "order") and one.kind != "asynchrony":
                self.refuse(e, f"{kind} is judged of two senses; give <asynchrony between=\"audio visual\" levels=\"-100ms 0ms 100ms\"/>")
            if kind == "two_interval" and one.kind != "factor":
                self.refuse(e, "of two intervals one is degraded by a factor; give <factor .../>")
            if kind != "performance" and one.kind in ("remove", "nothing"):
                self.refuse(e, f"<{e.tag}> is a condition of <response kind=\"performance\"/> only")
            found += conditions.fixed_ones(one) if kind == "performance" else [one]
            if found[-1].id in (c.id for c in found[:-1]):
                self.refuse(e, f"the condition {found[-1].id} stands there twice")
            if len(found) > MOST_CONDITIONS:
                self.refuse(e, f"these are more than {MOST_CONDITIONS} conditions")
        return found

    def asked(self, e, kind, found):
        """(question, choices, number) with what is usual where the file is silent."""
        text, choices = QUESTIONS[kind]
        given = [self.words(c, LONGEST_CHOICE) for c in e.findall("choice")] if e is not None else []
        if kind == "two_interval" and self.of(e, kind):
            text = SOFTER
        if e is not None and e.find("question") is not None:
            text = self.words(e.find("question"))
        if given and kind in (*YES_OR_NO, "performance") and len(given) != len(choices):
            self.refuse(e, f"an answer to {kind} has {len(choices)} choices")
        number = ()
        if kind in ("rating", "matching"):
            if e.get("lowest") is None or e.get("highest") is None or e.get("step") is None:
                if len(given) < 2 or kind == "matching":
                    self.refuse(e, f"a {kind} needs lowest=, highest= and step=" + ("" if kind == "matching" else ", or two to nine <choice>"))
            else:
                number = tuple(float(e.get(n)) for n in ("lowest", "highest", "step"))
                if not (number[0] < number[1] and 0 < number[2] <= number[1] - number[0]):
                    self.refuse(e, "lowest= is below highest=, and step= is above 0 and no larger than their difference")
        if kind == "matching" and e.get("of") is None:
            self.refuse(e, "a matching says of what: of=\"stiffness\" or of=\"temperature\"")
        return text, tuple(given or choices), number

    def of(self, e, kind):
        """What the answers are about, where the file says it."""
        of = e.get("of", "") if e is not None else ""
        if kind == "two_interval" and of not in ("", "stiffness"):
            self.refuse(e, f"of two presses it is the stiffness that is judged, not {of}; write of=\"stiffness\", or leave it away")
        return of

    def forgotten_at_once(self, e, found):
        """Refuses what would still be felt in the press that is compared with it."""
        slow = next((f for c in found for f in c.factors if f.modality == "haptic" and f.operator in SLOW_TO_FORGET), None)
        if slow is not None:
            self.refuse(e, f"touch gets over {slow.operator} within seconds only, so that the other press would feel of it, too; the stiffness of two presses is judged under a delay")

    def stimulus(self, e):
        if e is None:
            return Stimulus()
        usual = Stimulus()
        rest = tuple(float(x) for x in e.get("rest", "0 0 0.04").split())
        number = lambda name, default, most: self.within(e, name, float(e.get(name, default)), most)
        if len(rest) != 3:
            self.refuse(e, "rest= is three numbers: x y z, m")
        return Stimulus(e.get("by", usual.by), rest, number("above", usual.above_m, 1), number("depth", usual.depth_m, 0.1),
                        self.quantity(e, "period", quantities.OPERATORS["delay"], usual.period_s * 1e3) / 1e3, int(e.get("times", usual.times)),
                        self.quantity(e, "limit", ("s", {"s": 1.0}, 1, 3600), usual.limit_s))

    def within(self, e, name, value, most):
        if not 0 <= value <= most:
            self.refuse(e, f"{name}={value:g} is not from 0 to {most} m")
        return value

    def questionnaire(self, e):
        items = []
        for i in e if e is not None else ():
            choices = tuple(self.words(c, LONGEST_CHOICE) for c in i.findall("choice"))
            number = [i.get(n) for n in ("lowest", "highest", "step")]
            if not (len(choices) >= 2 and number == [None] * 3 or None not in number and len(choices) in (0, 2)):
                self.refuse(i, "an item has two to nine <choice>, or lowest=, highest= and step= (and then two <choice> name its ends, or none)")
            values = [float(n) for n in number] if None not in number else [0.0] * 3
            if None not in number and not (values[0] < values[1] and 0 < values[2] <= values[1] - values[0]):
                self.refuse(i, "lowest= is below highest=, and step= is above 0 and no larger than their difference")
            if i.get("id") in (known.id for known in items):
                self.refuse(i, f"the item {i.get('id')} stands there twice")
            items.append(Item(i.get("id"), self.words(i.find("text")), choices, *values))
        return tuple(items)

    def observers(self, found, kind):
        all_of = {}
        for e in self.root.findall("observer"):
            of, name = e.get("of", ""), e.get("function")
            function = functions.FUNCTIONS.get(name) or observers.PERCEPTS.get(name)
            if of and of not in (c.id for c in found):
                self.refuse(e, f"there is no condition {of}; choose from {', '.join(c.id for c in found[:20])}")
            if function is None:
                self.refuse(e, f"there is no function {name}; choose from {', '.join((*functions.FUNCTIONS, *observers.PERCEPTS))}")
            params = {p.get("name"): float(p.get("value")) for p in e}
            if set(params) != set(function.parameters) or len(params) < len(e):
                self.refuse(e, f"{name} has the parameters {', '.join(function.parameters)}, each once")
            if name in observers.PERCEPTS:
                self.percept(e, name, params, kind)
            elif kind == "two_interval" and any(f.operator in quantities.FALLING for c in found if of in ("", c.id) for f in c.factors):
                self.refuse(e, f"{name} rises with the level, but less of {', '.join(quantities.FALLING)} is worse; leave its <observer> away")
            elif function.dimensions == 1 and kind in YES_OR_NO:
                with np.errstate(all="ignore"):
                    p = [function.p(c.levels, **params) for c in found if c.levels and of in ("", c.id)]
                if not all(np.all((x >= 0) & (x <= 1)) for x in p):
                    self.refuse(e, "with these parameters there is a level without a probability from 0 to 1; spreads are above 0, and guess and lapse together at most 1")
            elif kind in YES_OR_NO:
                self.refuse(e, f"{name} is of two levels, and a {kind} has one")
            all_of[of] = Observer(name, params, {p.get("name"): p.get("source") for p in e})
        return all_of

    def percept(self, e, name, params, kind):
        """Refuses an observer who is told what he felt and is asked for something else."""
        if kind != "two_interval" or not self.of(self.root.find("response"), kind):
            self.refuse(e, f"{name} tells which of two presses felt softer; ask for that by <response kind=\"two_interval\" of=\"stiffness\">")
        try:
            observers.PERCEPTS[name](**params, seed=1)
        except ValueError as error:
            self.refuse(e, str(error))
