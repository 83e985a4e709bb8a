"""Random study files, valid and invalid: each is read, completed and resumed from every trial of its
plan, or refused with its line."""
import collections
import pathlib
import random
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.psychophysics import functions
from tactus.refusal import Refusal
from tactus.study import check, quantities, questions, study_file, texts, trial_table
from tactus.study.plan import Plan

STUDIES = 400
MAX_TRIALS = 25  # of each study
ODD = 0.03        # probability that a part is invalid, or at an end of its range
SENSES = ("audio", "visual", "haptic", "thermal")
NUMBERS = ("NaN", "INF", "-INF", "", "x", "-1", "1e300", "0", " 7 ")
LEVELS = ("5", "10", "100", "0.5", "1", "20", "50", "2")
SPECIAL = quantities.OUTPUT_OF


class Author:
    """Writes a valid study, except for randomly drawn odd parts."""

    def __init__(self, seed):
        self.dice = random.Random(seed)

    def odd(self):
        return self.dice.random() < ODD

    def of(self, *what):
        return self.dice.choice(what)

    def maybe(self, text, chance=0.5):
        return text if self.dice.random() < chance else ""

    def number(self, *usual):
        return self.of(*NUMBERS) if self.odd() else self.of(*usual)

    def levels(self, unit, least=0.0, most=1e9):
        within = [x for x in LEVELS if least <= float(x) <= most or self.odd()]
        return " ".join(x + (self.of("ms", "Hz", "%", "") if self.odd() else unit) for x in self.dice.sample(within, min(len(within), self.dice.randint(1, 4))))

    def factor(self):
        operator = self.of(*quantities.OPERATORS)
        unit, _, least, most = quantities.OPERATORS[operator]
        modality = "smell" if self.odd() else SPECIAL.get(operator) if not self.odd() and operator in SPECIAL else self.of(*SENSES)
        least = max(least, quantities.SMALLEST.get(operator, 0))
        return f'<factor modality="{modality}" operator="{operator}" levels="{self.levels(unit, least, most)}"/>'

    def condition(self, kind):
        if kind == "asynchrony":
            pair = self.of("audio visual", "haptic audio", "thermal haptic") if not self.odd() else self.of("audio audio", "audio")
            return f'<asynchrony between="{pair}" levels="{self.levels("ms")} -40ms"/>'
        return {"factor": self.factor, "pair": lambda: f"<pair>{self.factor()}{self.factor()}</pair>", "nothing": lambda: "<nothing/>",
                "remove": lambda: f'<remove modality="{self.of(*SENSES)}" how="{self.of("off", "freeze")}"/>'}[kind]()

    def procedure(self, kind, unit):
        if kind == "constant":
            return f'<procedure kind="constant" repetitions="{self.of(1, 2, 3) if not self.odd() else self.of(0, 90_000)}"/>'
        if kind == "staircase":
            return (f'<procedure kind="staircase" rule="{self.of("1up1down", "1up2down", "weighted")}" start="{self.of(50, 20, 80)}{unit}" step="{self.of(20, 10)}{unit}" '
                    f'minimum_step="{self.of(5, 1)}{unit}" lowest="{self.of(0, 10, 1)}{unit}" highest="{self.of(100, 99)}{unit}" reversals="{self.of(4, 8) if not self.odd() else 1}"/>')
        name = self.of("synchrony_window", "cumulative_gaussian", "weibull", "order", "logistic") if not self.odd() else self.of("threshold_surface", "bell")
        rate = lambda: f'from="{self.of("0", "0.01")}" to="{self.of("0.05", "0.06")}"'
        axis = lambda: f'from="{self.number("1", "5")}" to="{self.number("50", "80")}"'
        parameters = functions.FUNCTIONS[name].parameters if name in functions.FUNCTIONS else ("x",)
        priors = "".join(f'<prior parameter="{p}" {rate() if p in ("guess", "lapse") else axis()} count="{self.of(2, 3, 5)}"/>' for p in parameters if not self.odd())
        return f'<procedure kind="quest_plus" function="{name}" trials="{self.of(5, 20)}">{priors}</procedure>'

    def study(self):
        response = self.of("synchrony", "order", "two_interval", "rating", "matching", "performance")
        judged = response in ("synchrony", "order", "two_interval")
        task = "game" if response == "performance" else self.of("tap", "press")
        kinds = {"synchrony": ["asynchrony"], "order": ["asynchrony"], "two_interval": ["factor"], "performance": ["factor", "pair", "remove", "nothing", "asynchrony"]}.get(
            response, ["asynchrony"] if task == "tap" else ["factor"])
        task = task if response not in ("synchrony", "order", "two_interval") or self.odd() else "tap" if kinds == ["asynchrony"] else "press"
        conditions = "".join(self.condition(self.of(*kinds) if not self.odd() else self.of("factor", "pair", "remove", "nothing", "asynchrony")) for _ in range(self.of(1, 1, 2, 3)))
        operator = re.search(r'operator="(\w+)"', conditions)
        unit = quantities.OPERATORS[operator[1]][0] if operator else "ms"
        numbers = response in ("rating", "matching")
        words = (f' lowest="{self.number("0", "1")}" highest="{self.number("10", "100")}" step="{self.number("1", "0.5")}"' + self.maybe(' of="stiffness"', 0.9)) if numbers else ""
        function = self.of("synchrony_window", "order", "logistic")
        observed = "".join(f'<parameter name="{p}" value="{self.number("0.01") if p in ("guess", "lapse") else self.number("30", "60")}" source="drawn"/>'
                           for p in functions.FUNCTIONS[function].parameters if not self.odd())
        return f"""<study name="s" version="1" scene="single_taps.sdf" task="{task}" seed="{self.number("1", "4294967295")}">
{self.maybe("<instructions>Look, listen &amp; feel.</instructions>")}
{self.maybe(f'<base delay="{self.of("100ms", "0", "2s")}">' + self.maybe('<degrade modality="thermal" off="true"/>') + "</base>")}
<conditions>{conditions}</conditions>
{self.procedure(self.of("constant", "constant", "staircase", "quest_plus") if judged or self.odd() else "constant", unit)}
<response kind="{response}"{words}>{self.maybe(f"<question>{self.of('So {a} or {b}?', 'So {a}', 'So {c}, {0} or {')}</question>")}{self.maybe('<choice>one</choice><choice>two {b}</choice>', 0.3)}</response>
{self.maybe(f'<stimulus by="apparatus" rest="0 0 {self.number("0.1")}" depth="{self.number("0.01")}" times="{self.of(1, 3)}" limit="{self.of("30s", "1s")}"/>')}
{self.maybe('<questionnaire at="block"><item id="a"><text>How?</text><choice>so</choice><choice>thus</choice></item></questionnaire>')}
{self.maybe(f'<blocks count="{self.of(1, 2, 7)}" break="{self.of("0", "10s")}"/>')}
{self.maybe(f'<counterbalance kind="{self.of("latin_square", "random", "none")}"/>')}
{self.maybe(f'<tolerance asynchrony="{self.of("5ms", "0.5ms")}"/>')}
{self.maybe('<margin time="10%" success="5%"/>')}
{self.maybe(f'<observer function="{function}">{observed}</observer>', 0.3)}
</study>
"""


class RandomStudies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.right, cls.refusals = [], collections.Counter()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "s.xml"
            for seed in range(STUDIES):
                path.write_text(Author(seed).study(), encoding="utf-8")
                try:
                    cls.right.append((seed, study_file.read(path)))
                except Refusal as refusal:
                    cls.refusals[str(refusal).replace(str(path), "s.xml")] += 1

    def test_many_studies_are_valid_and_many_are_not(self):
        self.assertGreater(len(self.right), STUDIES // 4)
        self.assertGreater(sum(self.refusals.values()), STUDIES // 10)

    def test_a_refusal_has_its_line_and_one_sentence(self):
        for said in self.refusals:
            self.assertRegex(said, r"^s\.xml:\d+: \S[^\n]{10,}$")

    def test_every_valid_study_resumes_with_the_same_trial(self):
        for seed, study in self.right:
            dice = random.Random(seed)
            plan, again = Plan(study, "P07"), Plan(study, "P07")
            for _ in range(MAX_TRIALS):
                trial = plan.next()
                if trial is None:
                    break
                with self.subTest(seed=seed, trial=trial.number):
                    # A second plan with the same answers; next() may be called twice.
                    self.assertEqual(again.next(), trial)
                    self.assertEqual(again.next(), trial)
                    self.assertTrue(1 <= trial.block <= study.blocks)
                    row = {"participant_id": "P07", "task": "free", "observer": "simulated", **trial.condition.row(trial.level)}
                    self.assertIsNone(trial_table.wrong(row), row)
                    xml.fromstring(study.profile(trial.condition, trial.level))
                    if not plan.performs:
                        words = questions.words(study, trial)
                        self.assertLessEqual(len(words["text"]), texts.LONGEST_TEXT + 20)
                        self.assertNotIn("{a}", words["text"] if trial.condition.senses else "")
                        questions.meaning(study, trial, {"number": 1.0, "choice": 0})
                    yes = dice.random() < 0.5
                    plan.answered(trial, yes)
                    again.answered(trial, yes)
            plan.estimates()
            plan.describe()

    @unittest.skipUnless((check.BIN / "sync_node").is_file(), "needs the programs")
    def test_every_profile_of_a_valid_study_is_valid(self):
        for seed, study in self.right[:150]:
            with self.subTest(seed=seed):
                self.assertRegex(check.profiles(study), "are valid|no degradations")


if __name__ == "__main__":
    unittest.main()
