"""Every operator of a degradation profile can be varied by a study, and a study accepts exactly what the parser of profiles accepts."""
import csv
import itertools
import os
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / "python"), str(ROOT / "docs" / "site")]
import reference_tables
from tactus.analysis import operators
from tactus.study import check, conditions, quantities, stages

TIMES = ("from", "until")  # times of a rule, not operators
# Operators of a profile that a study names otherwise: attribute of the profile -> operator of a study.
RENAMED = {"force_step": "quantise"}
STAGE_ATTRIBUTES = {"messages": "kOfMessages", "signal": "kOfSignal", "display": "kOfDisplay"}  # of parse_profile.cpp, by the kind of the stage


def rows_of_modalities():
    """[(modality, row)] of all modality.csv."""
    for path in sorted(ROOT.glob("*/modality.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        yield from ((rows[0]["name"], row) for row in rows)


def level_of(operator):
    """A level in the range of an operator that degrades."""
    _, _, least, most = quantities.OPERATORS[operator]
    return {"gain": 0.5, "resolution": 0.5}.get(operator, min(max(least, 10.0), most))


def accepted(modality, operator, stage, choices=None):
    """The Factor, or None when a study refuses it."""
    try:
        return conditions.factor(modality, operator, stage or None, (level_of(operator),), choices or {})
    except ValueError:
        return None


class ProfileOperators(unittest.TestCase):
    def test_every_operator_of_a_profile_is_an_operator_a_choice_or_a_removal_of_a_study(self):
        usable = {*quantities.OPERATORS, *quantities.CHOICES, *quantities.REMOVALS, *RENAMED}
        names = {name for name, _ in reference_tables.stream_operators(ROOT)} - set(TIMES)
        self.assertGreater(len(names), 10)
        self.assertEqual(set(), names - usable, "add it to quantities.py and study.xsd")
        for modality, row in rows_of_modalities():
            if row["what"] == "operator":
                operator = RENAMED.get(row["name"], row["name"])
                self.assertIsNotNone(accepted(modality, operator, ""), f"{modality} {operator}: add it to quantities.py and study.xsd")
                self.assertIn(f' {row["name"]}="', accepted(modality, operator, "").degrade(level_of(operator)))

    def test_a_word_that_chooses_the_predictor_of_a_deadband_is_a_choice_of_a_study(self):
        text = (ROOT / "sync" / "degradation" / "parse_operator.cpp").read_text(encoding="utf-8")
        for name, values in quantities.CHOICES.items():
            said = re.search(rf"{name}=[^;]*?choose (\w+) or (\w+)", text) or re.search(rf'"{name}".*?"choose (\w+) or (\w+)"', text) or re.search(r'conceal_of.*?"choose (\w+) or (\w+)"', text)
            self.assertEqual(values, said.groups(), name)
            self.assertIn(values[0], stages.NEUTRAL)
        # Words of an operator that take one of several names: each is a choice, or an order of a jitter, which stays as in a profile.
        words = set(re.findall(r'w\.pair\("(\w+)", "(?!\w*[/%])[a-z]+"\)', text))
        self.assertEqual(set(), words - set(quantities.CHOICES) - {"order"})

    def test_a_stage_of_a_study_has_every_operator_that_the_stage_of_a_profile_has(self):
        text = (ROOT / "sync" / "degradation" / "parse_profile.cpp").read_text(encoding="utf-8")
        for _, row in rows_of_modalities():
            if row["what"] != "stage" or row["kind"] == "input":
                continue
            attributes = set(re.findall(r'"(\w+)"', re.search(rf"{STAGE_ATTRIBUTES[row['kind']]}{{(.*?)}}", text, re.S).group(1)))
            stage = row["name"]
            mine = {o.removeprefix("network_") for o in stages.STAGES[stage]} | {n for n, (_, places) in stages.CHOICES_OF.items() if stage in places and n != "predict"}
            mine |= {how for how in quantities.REMOVALS if how in attributes and stages.of(stage, "haptic", how) == stage}
            self.assertEqual(attributes, mine, stage)

    def test_the_schema_names_the_operators_and_the_choices(self):
        xs = "{http://www.w3.org/2001/XMLSchema}"
        schema = xml.parse(ROOT / "scripts" / "python" / "tactus" / "study" / "study.xsd").getroot()
        kinds = {t.get("name"): t for t in schema}
        values = lambda node: [e.get("value") for e in node.iter(f"{xs}enumeration")]
        self.assertEqual(set(quantities.OPERATORS), set(values(kinds["operator"])))
        self.assertEqual(set(quantities.REMOVALS), set(values(kinds["removal"])))
        attributes = {a.get("name"): tuple(values(a)) for a in kinds["factor"].iter(f"{xs}attribute")}
        for name, choices in quantities.CHOICES.items():
            self.assertEqual(choices, attributes[name])

    def test_a_choice_makes_a_factor_of_its_own_in_the_profile_and_in_tables(self):
        one = accepted("haptic", "deadband", "force", {"predict": "linear", "passivity": "tdpa"})
        self.assertEqual('<degrade modality="haptic" stage="force" deadband="5% force predict=linear" passivity="tdpa"/>', one.degrade(5.0))
        self.assertEqual("haptic:force deadband predict=linear passivity=tdpa", one.words())
        row = conditions.Condition(one.words(), "factor", factors=(one,), levels=(5.0,)).row(5.0)
        self.assertEqual(("haptic:force", "deadband predict=linear passivity=tdpa", 5.0, "%"), tuple(row[k] for k in ("modality_degraded", "operator", "level", "unit")))
        self.assertEqual(accepted("haptic", "deadband", "force"), accepted("haptic", "deadband", "force", {"predict": "hold", "passivity": "none"}))
        self.assertEqual('<degrade modality="haptic" stage="action" deadband="5% velocity predict=linear"/>', accepted("haptic", "deadband", "action", {"predict": "linear"}).degrade(5.0))
        self.assertEqual('<degrade modality="audio" loss="5%" conceal="zero"/>', accepted("audio", "loss", "", {"conceal": "zero"}).degrade(5.0))
        self.assertEqual("", one.degrade(0.0))

    def test_a_choice_without_effect_is_refused_with_its_remedy(self):
        for operator, stage, choices, words in (("delay", "force", {"predict": "linear"}, "belongs to deadband"), ("deadband", None, {"predict": "linear"}, "at the stage model"),
                                                ("delay", "percept", {"passivity": "tdpa"}, 'give stage="force"'), ("rate", "force", {"conceal": "zero"}, "belongs to loss")):
            with self.assertRaisesRegex(ValueError, words):
                conditions.factor("haptic", operator, stage, (level_of(operator),), choices)

    def test_severities_of_an_operator_with_a_choice_are_those_of_the_operator(self):
        for name in quantities.OPERATORS:
            plain, chosen = (operators.factor("haptic:force", text, "", 0.5) for text in (name, f"{name} passivity=tdpa"))
            self.assertEqual((plain.lower_is_worse, plain.severity(0.5), plain.level(plain.severity(0.5))), (chosen.lower_is_worse, chosen.severity(0.5), chosen.level(chosen.severity(0.5))))
            self.assertNotEqual(plain, chosen)
        self.assertTrue(operators.factor("haptic:force", "gain passivity=tdpa", "", 0.0).removal)
        self.assertEqual(operators.GAIN_ABOVE, operators.kind(operators.factor("haptic:force", "gain passivity=tdpa", "", 2.0).operator))

    @unittest.skipUnless(os.access(check.BIN / "sync_node", os.X_OK), "needs sync_node")
    def test_a_study_accepts_exactly_the_operators_that_the_parser_of_profiles_accepts(self):
        places = [(m, "") for m in conditions.SENSES] + [("haptic", s) for s in stages.STAGES]
        found = []
        for (modality, stage), operator in itertools.product(places, quantities.OPERATORS):
            element = quantities.degrade(modality, operator, level_of(operator), stage)
            factor = accepted(modality, operator, stage)
            if factor:
                found.append(element)
            else:
                self.assertTrue(check.invalid([element]), f"a study refuses {element}, and the parser accepts it")
            for name, values in quantities.CHOICES.items():
                if chosen := accepted(modality, operator, stage, {name: values[1]}):
                    found.append(chosen.degrade(level_of(operator)))
        for begin in range(0, len(found), check.MAX_RULES):
            self.assertEqual("", check.invalid(found[begin:begin + check.MAX_RULES]))


if __name__ == "__main__":
    unittest.main()
