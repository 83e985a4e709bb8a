"""A published experiment as a file: trials, conditions, procedure, analysis and published results. The whole file is checked before anything starts."""
import dataclasses
import pathlib

from tactus import own_xml
from tactus.paths import SCRIPTS
from tactus.refusal import Refusal

SCHEMA = pathlib.Path(__file__).with_name("replication.xsd")
SHIPPED = SCRIPTS / "studies" / "published"
MAX_TRIALS = 100_000  # of one participant
# Kinds of measures: the needed attributes beside id, kind and of; the things named by `of`; their number, None: one or more.
KINDS = {"fit": (("function", "value"), "condition", 1), "mean": (("outcome",), "condition", None), "slope": (("outcome",), "condition", 1),
         "slope_growth": (("outcome", "against"), "condition", None), "change_percent": (("outcome",), "condition", 2),
         "mean_at": (("outcome", "at"), "condition", 1), "first_level": (("outcome",), "condition", 1),
         "difference": ((), "measure", 2), "ratio": ((), "measure", 2), "optimal_ratio": ((), "measure", 3), "magnitude": ((), "measure", 1)}
MAY_HAVE = {"mean": ("level",), "change_percent": ("level",)}
OF_CONSTANT, OF_STAIRCASE = ("repetitions", "noise"), ("rule", "start", "step", "minimum_step", "lowest", "highest", "reversals")


@dataclasses.dataclass(frozen=True)
class Condition:
    """settings: {name: word} of all trials. varies: the setting of the levels; "": none, and levels is (0,)."""
    id: str
    settings: dict
    varies: str
    levels: tuple


@dataclasses.dataclass(frozen=True)
class Measure:
    id: str
    kind: str
    of: tuple
    outcome: str = ""
    function: str = ""
    value: str = ""
    level: float = None
    against: tuple = ()
    at: str = ""


@dataclasses.dataclass(frozen=True)
class Expectation:
    """A published result. low, high: the range that counts as agreement; None: no end. value: the published number, or None."""
    quantity: str
    measure: str
    unit: str
    value: float
    low: float
    high: float
    source: str
    evidence: str
    lacks: str
    calibrated: str


@dataclasses.dataclass(frozen=True)
class Experiment:
    name: str
    path: pathlib.Path
    paper: str
    authors: str
    year: int
    doi: str
    paradigm: str
    answer: str        # outcome that counts as yes, or right; "": the outcomes are numbers only
    conditions: tuple
    procedure: dict    # for tactus/psychophysics/procedures.py, without levels
    common_noise: bool
    measures: tuple
    expectations: tuple
    participants: int
    seed: int

    def condition(self, name):
        return next(c for c in self.conditions if c.id == name)

    def with_repetitions(self, count):
        """The same with this number of trials of each level; a staircase is not changed."""
        return dataclasses.replace(self, procedure={**self.procedure, "repetitions": count}) if self.procedure["kind"] == "constant" else self

    def specification(self, condition):
        return {**self.procedure, **({"levels": list(condition.levels)} if self.procedure["kind"] == "constant" else {})}


def shipped():
    """Paths of the shipped experiments, by name."""
    return sorted(SHIPPED.glob("*.xml"))


def find(text):
    path = pathlib.Path(text)
    if not path.is_file() and path.name == str(text) and (SHIPPED / f"{path.stem}.xml").is_file():
        return SHIPPED / f"{path.stem}.xml"
    return path


def read(text):
    """Experiment of a file, or the shipped one of that name. Raises Refusal with the line."""
    from lxml import etree  # slow to import
    path = find(text)
    root, _ = own_xml.root_of(path, text, "a published experiment", (p.stem for p in shipped()))
    if root.tag == "study":
        raise Refusal(f"{text}:1: is a study file; run it with tactus study run, or give a <replication>")
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    if not schema.validate(root):
        first = schema.error_log[0]
        raise Refusal(f"{text}:{first.line}: {first.message.splitlines()[0]}")
    return Reading(text, path, root).experiment()


class Reading:
    def __init__(self, text, path, root):
        self.text, self.path, self.root = text, path, root

    def refuse(self, element, reason):
        raise Refusal(f"{self.text}:{element.sourceline}: {reason}")

    def experiment(self):
        root, paper, trial = self.root, self.root.find("paper"), self.root.find("trial")
        found = self.conditions(trial, root.findall("condition"))
        procedure, common = self.procedure(root.find("procedure"), found, trial.get("answer", ""))
        measures = self.measures(root.findall("measure"), {c.id for c in found}, trial.get("answer", ""))
        return Experiment(root.get("name"), self.path, " ".join(paper.text.split()), paper.get("authors"), int(paper.get("year")), paper.get("doi", ""),
                          trial.get("paradigm"), trial.get("answer", ""), found, procedure, common, measures,
                          tuple(self.expectation(e, {m.id for m in measures}) for e in root.findall("expect")), int(root.get("participants")), int(root.get("seed", "1")))

    def settings(self, element):
        names = [s.get("name") for s in element.findall("setting")]
        if len(set(names)) < len(names):
            self.refuse(element, f"<{element.tag}> sets {next(n for n in names if names.count(n) > 1)} twice; remove one")
        return {s.get("name"): s.get("value") for s in element.findall("setting")}

    def conditions(self, trial, elements):
        common, found = self.settings(trial), []
        for e in elements:
            levels, varies = tuple(float(x) for x in e.get("levels", "").split()), e.get("varies", "")
            if bool(levels) != bool(varies) or len(set(levels)) < len(levels):
                self.refuse(e, "varies= and levels= belong together; give a setting and its levels, each once, or neither")
            settings = {**common, **self.settings(e)}
            if varies in settings:
                self.refuse(e, f"{varies} varies in the condition {e.get('id')}, and is also set; remove one")
            if e.get("id") in (c.id for c in found):
                self.refuse(e, f"the condition {e.get('id')} occurs twice; rename one")
            found.append(Condition(e.get("id"), settings, varies, levels or (0.0,)))
        return tuple(found)

    def procedure(self, e, found, answer):
        kind = e.get("kind")
        wanted, allowed = (("repetitions",), OF_CONSTANT) if kind == "constant" else (OF_STAIRCASE, OF_STAIRCASE)
        for name in e.attrib:
            if name not in (*allowed, "kind"):
                self.refuse(e, f"a procedure of kind {kind} has no {name}=; remove it")
        for name in wanted:
            if e.get(name) is None:
                self.refuse(e, f"a procedure of kind {kind} needs {name}=")
        spec = {"kind": kind, **{n: e.get(n) if n == "rule" else int(e.get(n)) if n in ("repetitions", "reversals") else float(e.get(n)) for n in wanted}}
        if kind == "staircase" and not (answer and all(c.varies for c in found)):
            self.refuse(e, "a staircase needs answer= of <trial>, and a setting that varies in each condition")
        if kind == "constant" and sum(len(c.levels) for c in found) * spec["repetitions"] > MAX_TRIALS:
            self.refuse(e, f"a participant has more than {MAX_TRIALS} trials; reduce the repetitions")
        try:
            from tactus.psychophysics import procedures  # loads slowly
            for c in found:
                procedures.make_procedure({**spec, **({"levels": list(c.levels)} if kind == "constant" else {})}, 1)
        except ValueError as error:
            self.refuse(e, str(error))
        return spec, e.get("noise") == "common"

    def measures(self, elements, conditions, answer):
        found = []
        for e in elements:
            kind, of = e.get("kind"), tuple(e.get("of").split())
            needs, named, count = KINDS[kind]
            for name in needs:
                if e.get(name) is None:
                    self.refuse(e, f"a measure of kind {kind} needs {name}=")
            for name in e.attrib:
                if name not in (*needs, *MAY_HAVE.get(kind, ()), "id", "kind", "of"):
                    self.refuse(e, f"a measure of kind {kind} has no {name}=; remove it")
            known = conditions if named == "condition" else {m.id for m in found if m.kind != "first_level"}
            for name in of:
                if name not in known:
                    self.refuse(e, f"there is no {named} {name} before this measure; choose from {', '.join(sorted(known)) or 'none'}")
            if count is not None and len(of) != count:
                self.refuse(e, f"a measure of kind {kind} is of {count}, but {len(of)} are named")
            if e.get("id") in (m.id for m in found):
                self.refuse(e, f"the measure {e.get('id')} occurs twice; rename one")
            against = tuple(float(x) for x in e.get("against", "").split())
            if kind == "slope_growth" and (len(against) != len(of) or len(set(against)) < 2):
                self.refuse(e, "slope_growth needs one number in against= for each condition, and two different ones")
            if e.get("at") is not None and e.get("at") not in (m.id for m in found):
                self.refuse(e, f"there is no measure {e.get('at')} before this one; correct at=")
            if kind == "fit":
                self.fitted(e, answer)
            found.append(Measure(e.get("id"), kind, of, e.get("outcome", ""), e.get("function", ""), e.get("value", ""),
                                 None if e.get("level") is None else float(e.get("level")), against, e.get("at", "")))
        return tuple(found)

    def fitted(self, e, answer):
        from tactus.psychophysics import functions  # loads slowly
        shape = functions.FUNCTIONS.get(e.get("function"))
        if shape is None or shape.dimensions != 1:
            self.refuse(e, f"there is no function {e.get('function')} of one level; choose from {', '.join(n for n, f in functions.FUNCTIONS.items() if f.dimensions == 1)}")
        values = {*shape.parameters, *shape.derived(0.0, 1.0, 0.0)}
        if e.get("value") not in values:
            self.refuse(e, f"{e.get('function')} has no value {e.get('value')}; choose from {', '.join(sorted(values))}")
        if not answer:
            self.refuse(e, "a fit needs answers; give answer= of <trial>")

    def expectation(self, e, measures):
        value, within = (None if e.get(n) is None else e.get(n) for n in ("value", "within"))
        low, high = (None if e.get(n) is None else float(e.get(n)) for n in ("low", "high"))
        if e.get("lacks") is None:
            if e.get("measure") not in measures:
                self.refuse(e, f"there is no measure {e.get('measure')}; choose from {', '.join(sorted(measures))}, or state lacks=")
            if (value is None) != (within is None) or (value is None) == (low is None and high is None):
                self.refuse(e, "an expectation has value= with within=, or low= or high=")
            if value is not None:
                width = abs(float(value)) * float(within[:-1]) / 100 if within.endswith("%") else float(within)
                if width <= 0:
                    self.refuse(e, f"within={within} is a tolerance of 0; give a positive one")
                low, high = float(value) - width, float(value) + width
            elif low is not None and high is not None and not low < high:
                self.refuse(e, "low= must be below high=")
        elif e.get("measure") is not None:
            self.refuse(e, "lacks= states that the player cannot do this; remove measure=")
        return Expectation(" ".join(e.get("quantity").split()), e.get("measure", ""), e.get("unit", ""), None if value is None else float(value), low, high,
                           " ".join(e.get("source").split()), e.get("evidence"), e.get("lacks", ""), e.get("calibrated", ""))
