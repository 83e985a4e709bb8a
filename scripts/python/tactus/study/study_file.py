"""The study file: conditions, questions, procedure and blocks. The whole file is checked before anything starts."""
import dataclasses
import hashlib
import itertools
import pathlib

from tactus import own_xml, players
from tactus.paths import SCENES, SCRIPTS
from tactus.refusal import Refusal
from tactus.study import conditions, quantities, stages, texts
from tactus.study.study_parts import Falsifier, Item, Observer, Stimulus

SCHEMA = pathlib.Path(__file__).with_name("study.xsd")
SHIPPED = SCRIPTS / "studies"
MAX_CONDITIONS = 2000
MAX_LEVELS = 100_000  # of a pair; equals procedure_element.MAX_TRIALS with one trial a level
YES_OR_NO = ("synchrony", "order", "two_interval")  # answers that a psychometric function describes
QUESTIONS = {
    "synchrony": ("Did {a} and {b} come together?", ("together", "apart")),
    "order": ("Which came first?", ("{a}", "{b}")),
    "two_interval": ("In which of the two was something wrong?", ("the first", "the second")),
    "rating": ("How good was that?", ()), "matching": ("How much was it?", ()), "performance": ("", ())}
JUDGED = {"tap": "asynchrony", "press": "factor"}  # kind of condition that each task allows
SOFTER = "Which of the two felt softer?"  # default question for two presses of a study of stiffness
# The haptic node adapts its coupling to these operators of its input and recovers within seconds (LoopDelay in haptic_node/rendering/coupling.h). A degraded
# press would therefore also soften the next press. A delay of the output ends immediately.
SLOW_RECOVERY = ("network_delay", "jitter", "loss", "wire_loss", "reorder", "rate", "deadband")


@dataclasses.dataclass(frozen=True)
class Study:
    name: str
    path: pathlib.Path
    sha256: str         # of the file
    scene: pathlib.Path  # None: not searched for
    task: str           # tap, press or game
    seed: int
    instructions: tuple
    phrases: dict       # texts.PHRASES, with those of the file
    base_delay_ms: float  # common delay of all senses under the policy experiment; it permits negative asynchronies
    base: tuple           # elements of the profile that apply in every trial
    conditions: tuple     # of conditions.Condition
    procedure: dict       # specification for tactus/psychophysics/procedures.py, without the levels of each condition
    response: str
    question: str
    choices: tuple
    number: tuple         # (lowest, highest, step) of a rating or matching; ()
    of: str               # the property that is matched, or compared between two presses; "": none
    stimulus: Stimulus
    questionnaire: tuple
    questionnaire_at: str  # end or block
    blocks: int
    break_s: float
    counterbalance: str
    tolerance_ms: float   # a trial whose asynchrony differs by more from the requested one is repeated
    repeats: int          # largest number of repetitions of a trial
    margin: dict          # {"time": share, "success": share}
    observers: dict       # {condition id, or "": Observer}
    players: tuple        # of players.Player: the simulated players of a game
    checks: str           # players.CHECKS: the rule for players that fail a check
    falsifiers: tuple     # of Falsifier

    def profile(self, condition, level):
        """XML of the degradation profile of a trial; level None: the base alone."""
        name = f"{self.name}: {condition.id}" + ("" if level is None else f" at {level}")
        return f"<profile name={own_xml.quoted(name)} seed=\"{self.seed}\">" + "".join((*self.base, *condition.elements(level))) + "</profile>"

    def observer(self, condition):
        return self.observers.get(condition.id) or self.observers.get("")


def find(text):
    """Path of a study file; `text` is a path, or the name of a shipped study."""
    path = pathlib.Path(text)
    if not path.is_file() and path.name == text:
        for name in (text, text + ".xml"):
            if (SHIPPED / name).is_file():
                return SHIPPED / name
    return path


def read(text, with_scene=True):
    """Study of a file, or of the shipped study of that name. with_scene: False for a copy beside the results, which has no scene beside it. Raises
    Refusal with the line."""
    from lxml import etree  # slow to import
    path = find(str(text))
    root, data = own_xml.root_of(path, text, "a study file", sorted(p.stem for p in SHIPPED.glob("*.xml")))
    if root.tag == "replication":
        raise Refusal(f"{text}:1: is a published experiment; run it with tactus study replicate, or give a <study>")
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    if not schema.validate(root):
        first = schema.error_log[0]
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

    def words(self, element, longest=texts.LONGEST_TEXT):
        text = texts.one_line(element.text or "")
        if reason := texts.wrong(text, longest):
            self.refuse(element, f"the text of {element.tag} {reason}")
        return text

    def fits(self, element, text, choices=()):
        """Refuses a choice that is too long with the longest word that may be filled in for a sense."""
        longest = max((self.phrases[sense] for sense in texts.SPOKEN), key=len)
        for choice in choices:
            if reason := texts.wrong(texts.fill(choice, a=longest, b=longest), texts.LONGEST_CHOICE):
                self.refuse(element, f"the choice {choice} with the word {longest} filled in {reason}")
        return text

    def read_phrases(self, elements):
        """texts.PHRASES, with those of the file."""
        found = dict(texts.PHRASES)
        for e in elements:
            of = e.get("of")
            text = self.words(e, texts.LONGEST_CHOICE if of in texts.SPOKEN else texts.LONGEST_LINE if of in texts.HINTS.values() else texts.LONGEST_TEXT)
            lacks = [name for name in texts.FILLED_IN.get(of, ()) if "{" + name + "}" not in text]
            if lacks:
                self.refuse(e, f"the phrase of {of} lacks {{{lacks[0]}}}, which is filled in; write it where the number belongs")
            if of == "progress" and len(texts.fill(text, done="99999", trials="99999")) > texts.LONGEST_LINE:
                self.refuse(e, f"the phrase of progress has more than {texts.LONGEST_LINE} characters with its numbers; shorten it")
            found[of] = text
        return found

    def sense(self, element, name):
        if name not in conditions.SENSES:
            self.refuse(element, f"there is no sense {name}; choose from {', '.join(conditions.SENSES)}")
        return name

    def study(self):
        from tactus.study import procedure_element  # loads slowly
        root, find = self.root, self.root.find
        self.phrases = self.read_phrases(root.findall("phrase"))
        response = find("response")
        kind = response.get("kind", "synchrony") if response is not None else "synchrony"
        task = root.get("task")
        if (task == "game") != (kind == "performance"):
            self.refuse(root, "task=\"game\" and <response kind=\"performance\"/> belong together; set both, or neither")
        found = self.conditions(find("conditions"), kind)
        wanted = JUDGED.get(task)
        if wanted and any(c.kind != wanted for c in found):
            self.refuse(find("conditions"), f"a condition is not <{wanted}>; a tap takes <asynchrony> only, a press <factor> only")
        question, choices, number = self.asked(response, kind, found)
        if kind == "two_interval" and self.of(response, kind):
            self.check_recovery(find("conditions"), found)
        blocks, tolerance, margin, base = find("blocks"), find("tolerance"), find("margin"), find("base")
        return Study(
            name=root.get("name"), path=self.path, sha256=self.sha256, scene=self.scene() if self.with_scene else None, task=task, seed=int(root.get("seed", "1")),
            instructions=tuple(self.words(e) for e in root.findall("instructions")), phrases=self.phrases,
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
            observers=self.observers(found, kind), **self.players(task),
            falsifiers=tuple(Falsifier(e.get("name"), self.words(e), e.get("decided_by")) for e in root.findall("falsifier")))

    def players(self, task):
        elements = self.root.findall("player")
        if elements and task != "game":
            self.refuse(elements[0], "a <player> plays games; remove it, or set task=\"game\"")
        found = [player for e in elements for player in self.checked(e, players.several, e.get("name"), e.get("numbers"), int(e.get("population", "1")),
                                                                     int(e.get("practice", "0")))]
        if len({(p.name, p.population) for p in found}) < len(found) or len(found) > players.MOST:
            self.refuse(elements[0], f"a player occurs twice, or there are more than {players.MOST}; give each once")
        rules = {e.get("checks") for e in elements} - {None}
        if len(rules) > 1:
            self.refuse(elements[0], f"the players have different rules for failed checks; give one of {', '.join(players.CHECKS)}")
        return {"players": tuple(found) or (players.Player(),), "checks": (rules or {players.CHECKS[0]}).pop()}

    def scene(self):
        text = self.root.get("scene")
        for path in (self.path.parent / text, SCENES / text):
            if path.is_file():
                return path.resolve()
        self.refuse(self.root, f"the scene {text} is neither a file beside the study nor in sim_node/scenes; give another scene=")

    def element(self, e):
        self.sense(e, e.get("modality", ""))
        return "<degrade " + " ".join(f"{k}={own_xml.quoted(v)}" for k, v in e.attrib.items()) + "/>"

    def factor(self, e):
        levels = tuple(quantities.read(t, quantities.OPERATORS[e.get("operator")], self.where(e)) for t in e.get("levels").split())
        self.distinct(e, levels)
        modality = self.sense(e, e.get("modality"))
        choices = {name: e.get(name) for name in quantities.CHOICES if e.get(name) is not None}
        return self.checked(e, conditions.factor, modality, e.get("operator"), e.get("stage"), levels, choices), levels

    def checked(self, e, make, *of):
        """make(*of), whose ValueError is a refusal of the element."""
        try:
            return make(*of)
        except ValueError as error:
            self.refuse(e, str(error))

    def distinct(self, e, levels):
        if not levels or len(set(levels)) < len(levels):
            self.refuse(e, "levels= is empty or repeats a level; give one or more levels, each once")

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
                    self.refuse(e, "both factors of a pair are the same; give two different factors")
                if len(levels[0]) * len(levels[1]) > MAX_LEVELS:
                    self.refuse(e, f"a pair of {len(levels[0])} and {len(levels[1])} levels has more than {MAX_LEVELS} combinations; give fewer levels")
                one = conditions.Condition(" x ".join(f.words() for f in factors), "pair", factors=factors, levels=tuple(itertools.product(*levels)))
            elif e.tag == "remove":
                modality = self.sense(e, e.get("modality"))
                how = e.get("how", "off")
                stage = self.checked(e, stages.of, e.get("stage"), modality, how)
                one = conditions.Condition(f"{stages.named(modality, stage)} removed", "remove", removed=modality, how=how, stage=stage)
            else:
                one = conditions.Condition("nothing degraded", "nothing")
            if kind in ("synchrony", "order") and one.kind != "asynchrony":
                self.refuse(e, f"a judgement of {kind} compares two senses; give <asynchrony between=\"audio visual\" levels=\"-100ms 0ms 100ms\"/>")
            if kind == "two_interval" and one.kind != "factor":
                self.refuse(e, "two_interval compares an interval degraded by a factor with one that is not; give <factor .../>")
            if kind != "performance" and one.kind in ("remove", "nothing"):
                self.refuse(e, f"<{e.tag}> is a condition of <response kind=\"performance\"/> only; remove it, or change the response")
            found += conditions.fixed_ones(one) if kind == "performance" else [one]
            if found[-1].id in (c.id for c in found[:-1]):
                self.refuse(e, f"the condition {found[-1].id} occurs twice; remove one")
            if len(found) > MAX_CONDITIONS:
                self.refuse(e, f"there are more than {MAX_CONDITIONS} conditions; give fewer, or fewer levels")
        return found

    def asked(self, e, kind, found):
        """(question, choices, number), with defaults for absent elements."""
        text, choices = QUESTIONS[kind]
        given = [self.words(c, texts.LONGEST_CHOICE) for c in e.findall("choice")] if e is not None else []
        if kind == "two_interval" and self.of(e, kind):
            text = SOFTER
        if e is not None and e.find("question") is not None:
            text = self.words(e.find("question"))
        if given and kind in (*YES_OR_NO, "performance") and len(given) != len(choices):
            self.refuse(e, f"{kind} takes {len(choices)} choices, but the file gives {len(given)}; give {len(choices)} <choice>, or none")
        number = ()
        if kind in ("rating", "matching"):
            if e.get("lowest") is None or e.get("highest") is None or e.get("step") is None:
                if len(given) < 2 or kind == "matching":
                    self.refuse(e, f"{kind} needs lowest=, highest= and step=" + ("" if kind == "matching" else ", or two to nine <choice>"))
            else:
                number = tuple(float(e.get(n)) for n in ("lowest", "highest", "step"))
                if not (number[0] < number[1] and 0 < number[2] <= number[1] - number[0]):
                    self.refuse(e, "lowest= must be below highest=, and step= above 0 and at most their difference")
        if kind == "matching" and e.get("of") is None:
            self.refuse(e, "matching needs a property; give of=\"stiffness\" or of=\"temperature\"")
        if e is not None:
            self.fits(e, text, given or choices)
        return text, tuple(given or choices), number

    def of(self, e, kind):
        """The property that the answers describe; "": the file names none."""
        of = e.get("of", "") if e is not None else ""
        if kind == "two_interval" and of not in ("", "stiffness"):
            self.refuse(e, f"two presses are compared by stiffness, not by {of}; write of=\"stiffness\", or remove of=")
        return of

    def check_recovery(self, e, found):
        """Refuses operators that would still affect the other press of a comparison."""
        slow = next((f for c in found for f in c.factors if f.modality == "haptic" and not f.stage and f.operator in SLOW_RECOVERY), None)
        if slow is not None:
            self.refuse(e, f"touch recovers from {slow.operator} within seconds only, so that the other press would be softer too; compare the stiffness of two presses under a delay")

    def stimulus(self, e):
        if e is None:
            return Stimulus()
        usual = Stimulus()
        rest = tuple(float(x) for x in e.get("rest", "0 0 0.04").split())
        number = lambda name, default, most: self.within(e, name, float(e.get(name, default)), most)
        if len(rest) != 3:
            self.refuse(e, "rest= needs three numbers: x y z, m")
        return Stimulus(e.get("by", usual.by), rest, number("above", usual.above_m, 1), number("depth", usual.depth_m, 0.1),
                        self.quantity(e, "period", quantities.OPERATORS["delay"], usual.period_s * 1e3) / 1e3, int(e.get("times", usual.times)),
                        self.quantity(e, "limit", ("s", {"s": 1.0}, 1, 3600), usual.limit_s), e.get("starts", "own") == "common")

    def within(self, e, name, value, most):
        if not 0 <= value <= most:
            self.refuse(e, f"{name}={value:g} is not from 0 to {most}; give a length in m")
        return value

    def questionnaire(self, e):
        items = []
        for i in e if e is not None else ():
            choices = tuple(self.words(c, texts.LONGEST_CHOICE) for c in i.findall("choice"))
            number = [i.get(n) for n in ("lowest", "highest", "step")]
            if not (len(choices) >= 2 and number == [None] * 3 or None not in number and len(choices) in (0, 2)):
                self.refuse(i, "an item needs two to nine <choice>, or lowest=, highest= and step= (then two <choice> may name its ends)")
            values = [float(n) for n in number] if None not in number else [0.0] * 3
            if None not in number and not (values[0] < values[1] and 0 < values[2] <= values[1] - values[0]):
                self.refuse(i, "lowest= must be below highest=, and step= above 0 and at most their difference")
            if i.get("id") in (known.id for known in items):
                self.refuse(i, f"the item {i.get('id')} occurs twice; rename one")
            items.append(Item(i.get("id"), self.fits(i, self.words(i.find("text")), choices), choices, *values))
        return tuple(items)

    def observers(self, found, kind):
        import numpy as np

        from tactus.psychophysics import functions, observers  # loads slowly
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
                self.refuse(e, f"{name} needs the parameters {', '.join(function.parameters)}, each once")
            if name in observers.PERCEPTS:
                self.percept(e, name, params, kind)
            elif kind == "two_interval" and any(f.operator in quantities.LOWER_IS_WORSE for c in found if of in ("", c.id) for f in c.factors):
                self.refuse(e, f"{name} rises with the level, but a lower {', '.join(quantities.LOWER_IS_WORSE)} is a stronger degradation; remove its <observer>")
            elif function.dimensions == 1 and kind in YES_OR_NO:
                with np.errstate(all="ignore"):
                    p = [function.p(c.levels, **params) for c in found if c.levels and of in ("", c.id)]
                if not all(np.all((x >= 0) & (x <= 1)) for x in p):
                    self.refuse(e, "these parameters give a probability outside 0 to 1 at some level; set spreads above 0, and guess and lapse to at most 1 together")
            elif kind in YES_OR_NO:
                self.refuse(e, f"{name} takes two levels, but {kind} has one; choose another function")
            all_of[of] = Observer(name, params, {p.get("name"): p.get("source") for p in e})
        return all_of

    def percept(self, e, name, params, kind):
        """Refuses an observer of felt stiffness in a study that does not compare stiffness."""
        from tactus.psychophysics import observers  # loads slowly
        if kind != "two_interval" or not self.of(self.root.find("response"), kind):
            self.refuse(e, f"{name} judges which of two presses felt softer; ask for that with <response kind=\"two_interval\" of=\"stiffness\">")
        self.checked(e, lambda: observers.PERCEPTS[name](**params, seed=1))
