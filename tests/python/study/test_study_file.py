"""Study files: valid files are read, invalid files are refused with line and reason."""
import pathlib
import random
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import quantities, stages, study_file

GOOD = """<study name="s" version="1" scene="single_taps.sdf" task="tap" seed="3">
  <instructions>Listen and look.</instructions>
  <base delay="80ms"><degrade modality="thermal" off="true"/></base>
  <conditions>
    <asynchrony between="audio visual" levels="-100ms 0ms 0.1s"/>
  </conditions>
  <procedure kind="constant" repetitions="4"/>
  <response kind="synchrony"><question>Together?</question><choice>yes</choice><choice>no</choice></response>
  <blocks count="2" break="30s"/>
  <tolerance asynchrony="10ms" repeats="2"/>
  <observer function="synchrony_window">
    <parameter name="pss" value="10" source="x"/><parameter name="sd" value="50" source="x"/><parameter name="guess" value="0" source="x"/><parameter name="lapse" value="0" source="x"/>
  </observer>
</study>
"""


PRESSED = """<study name="s" version="1" scene="yielding_board.sdf" task="press" seed="3">
  <conditions><factor modality="haptic" operator="delay" levels="10ms 40ms"/></conditions>
  <procedure kind="constant" repetitions="4"/>
  <response kind="two_interval" of="stiffness"/>
  <observer function="felt_stiffness">
    <parameter name="weber" value="0.23" source="x"/><parameter name="lapse" value="0.02" source="x"/>
  </observer>
</study>
"""


class StudyFile(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "s.xml"
            path.write_text(text, encoding="utf-8")
            return study_file.read(path)

    def refused(self, text, *words):
        with self.assertRaises(Refusal) as caught:
            self.read(text)
        said = str(caught.exception)
        self.assertRegex(said, r"s\.xml:\d+: ")
        for word in words:
            self.assertIn(word, said)
        self.assertNotIn("\n", said)

    def changed(self, old, new):
        self.assertIn(old, GOOD)
        return GOOD.replace(old, new)

    def test_a_valid_file_is_read_completely(self):
        s = self.read(GOOD)
        self.assertEqual((s.name, s.response, s.blocks, s.break_s, s.tolerance_ms, s.base_delay_ms), ("s", "synchrony", 2, 30.0, 10.0, 80.0))
        self.assertEqual(s.conditions[0].levels, (-100.0, 0.0, 100.0))
        self.assertEqual(s.observer(s.conditions[0]).params["sd"], 50)

    def test_an_asynchrony_delays_the_later_sense(self):
        s = self.read(GOOD)
        elements = lambda level: [dict(e.attrib) for e in xml.fromstring(s.profile(s.conditions[0], level))]
        base = {"modality": "thermal", "off": "true"}
        self.assertEqual(elements(100.0), [base, {"modality": "visual", "delay": "100ms"}])
        self.assertEqual(elements(-100.0), [base, {"modality": "audio", "delay": "100ms"}])
        self.assertEqual(elements(0.0), [base])

    def test_an_error_is_refused_with_its_line(self):
        for old, new, word in (
                ('between="audio visual"', 'between="audio smell"', "there is no sense smell"),
                ('between="audio visual"', 'between="audio audio"', "between two senses"),
                ('levels="-100ms 0ms 0.1s"', 'levels="-100ms 0ms 0s"', "repeats a level"),
                ('levels="-100ms 0ms 0.1s"', 'levels="3Hz"', "needs the unit"),
                ('levels="-100ms 0ms 0.1s"', 'levels="9s"', "is out of range"),
                ('scene="single_taps.sdf"', 'scene="nowhere.sdf"', "neither a file beside the study nor"),
                ('task="tap"', 'task="game"', "performance"),
                ('repetitions="4"', '', "needs repetitions="),
                ('repetitions="4"', 'repetitions="4" trials="3"', "has no trials="),
                ('repetitions="4"', 'repetitions="100000"', "300000 trials are too many"),
                ('<choice>no</choice>', '', "takes 2 choices"),
                ('Together?', 'T' * 6001, "has 6001 characters; write 1 to 6000"),
                ('name="sd" value="50"', 'name="width" value="50"', "needs the parameters pss, sd"),
                ('function="synchrony_window"', 'function="bell"', "there is no function bell"),
                ('<blocks', '<chunks', "chunks")):
            with self.subTest(new):
                self.refused(self.changed(old, new), word)

    def test_an_observer_of_felt_stiffness_needs_a_study_that_compares_stiffness(self):
        s = self.read(PRESSED)
        self.assertEqual((s.of, s.question, s.observer(s.conditions[0]).params), ("stiffness", study_file.SOFTER, {"weber": 0.23, "lapse": 0.02}))
        for old, new, word in (
                (' of="stiffness"', '', "ask for that with"),
                ('of="stiffness"', 'of="temperature"', "compared by stiffness, not by temperature"),
                ('value="0.23"', 'value="0"', "a weber fraction is above 0"),
                ('value="0.02"', 'value="1.5"', "a lapse rate from 0 to 1"),
                ('name="weber"', 'name="threshold"', "needs the parameters weber, lapse"),
                ('operator="delay"', 'operator="network_delay"', "recovers from network_delay within seconds only"),
                ('felt_stiffness"', 'felt_softness"', "choose from synchrony_window"),
                ('"two_interval" of="stiffness"', '"rating" of="stiffness" lowest="1" highest="9" step="1"', "which of two presses felt softer")):
            with self.subTest(new):
                self.assertIn(old, PRESSED)
                self.refused(PRESSED.replace(old, new), word)

    def test_a_study_of_two_intervals_needs_no_observer(self):
        s = self.read(PRESSED.replace(' of="stiffness"', "").replace(PRESSED[PRESSED.index("<observer"):], "</study>"))
        self.assertEqual((s.of, s.question, s.observers), ("", study_file.QUESTIONS["two_interval"][0], {}))

    def test_a_file_that_is_not_utf8_is_refused_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "s.xml"
            for data, sentence in ((GOOD.replace("Listen", "H\u00f6re").encode("latin-1"), "s.xml:2: is not UTF-8"), (GOOD.encode("utf-16"), "s.xml:1: is UTF-16"),
                                   (('<?xml version="1.0" encoding="ISO-8859-1"?>' + GOOD).encode(), "s.xml:1: declares the encoding ISO-8859-1")):
                path.write_bytes(data)
                with self.assertRaises(Refusal) as caught:
                    study_file.read(path)
                self.assertIn(sentence, str(caught.exception))
                self.assertIn("save", str(caught.exception))
            path.write_bytes(('\ufeff<?xml version="1.0" encoding="utf-8"?>' + GOOD).encode())
            self.assertEqual(study_file.read(path).name, "s")

    def test_a_file_that_is_not_xml_is_refused(self):
        for text in ("", "<study", GOOD.replace("</study>", ""), GOOD + "<more/>"):
            with self.subTest(text[-20:]):
                self.refused(text)

    def test_a_doctype_is_refused_and_processing_instructions_are_ignored(self):
        self.refused('<!DOCTYPE study [<!ENTITY e "sound">]>' + self.changed("Together?", "Did &e; come?"), "<!DOCTYPE>")
        self.refused('<!DOCTYPE study [<!ATTLIST study seed CDATA "77">]>' + GOOD, "<!DOCTYPE>")
        self.assertEqual(self.read(self.changed("Together?", "Do both<?x y?> come?")).question, "Do both come?")
        self.assertEqual(len(self.read(self.changed("<conditions>", "<conditions><?x y?>")).conditions), 1)

    def test_a_pair_with_too_many_levels_is_refused_at_once(self):
        many = " ".join(f"{i / 100:.2f}ms" for i in range(20_000))
        pair = "".join(f'<factor modality="{sense}" operator="delay" levels="{many}"/>' for sense in ("audio", "visual"))
        self.refused(f'''<study name="s" version="1" scene="dark_room_game.sdf" task="game"><conditions><pair>{pair}</pair></conditions>
            <procedure kind="constant" repetitions="1"/><response kind="performance"/></study>''', "20000 and 20000 levels")

    def test_operators_whose_lower_level_is_worse_take_constant_stimuli_and_no_observer_in_two_intervals(self):
        rate = PRESSED.replace(' of="stiffness"', "").replace('operator="delay" levels="10ms 40ms"', 'operator="rate" levels="5Hz 50Hz"')
        alone = rate[:rate.index("  <observer")] + "</study>"
        self.assertEqual(self.read(alone).conditions[0].levels, (5.0, 50.0))
        self.refused(alone.replace('kind="constant" repetitions="4"', 'kind="staircase" rule="1up2down" start="50Hz" step="8Hz" minimum_step="1Hz" lowest="1Hz" '
                                   'highest="100Hz" reversals="8"'), "a lower rate")
        self.refused(alone.replace("</study>", '<observer function="weibull"><parameter name="threshold" value="20" source="x"/><parameter name="slope" value="3" source="x"/>'
                                   '<parameter name="guess" value="0.5" source="x"/><parameter name="lapse" value="0" source="x"/></observer></study>'), "rises with the level")

    def test_a_copy_is_read_without_its_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "study.xml"
            path.write_text(GOOD.replace("single_taps.sdf", "mine.sdf"), encoding="utf-8")
            self.assertEqual(study_file.read(path, with_scene=False).name, "s")
            with self.assertRaisesRegex(Refusal, r"study\.xml:1: the scene mine\.sdf"):
                study_file.read(path)

    def test_a_damaged_file_is_read_or_refused_with_its_line(self):
        dice = random.Random(1)
        refused = 0
        for _ in range(300):
            text = list(GOOD)
            for _ in range(dice.randint(1, 4)):
                text[dice.randrange(len(text))] = dice.choice("<>/\"=ab 0-m\n")
            try:
                self.read("".join(text))
            except Refusal as refusal:
                refused += 1
                self.assertRegex(str(refusal), r"s\.xml:\d+: ")
        self.assertGreater(refused, 100)

    def test_every_operator_writes_its_level_to_its_element(self):
        for operator, (unit, _, least, most) in quantities.OPERATORS.items():
            level = min(max(least, 5.0), most)
            element = xml.fromstring(quantities.degrade("haptic", operator, level))
            self.assertEqual(element.get("modality"), "haptic")
            value = next(v for k, v in element.attrib.items() if k != "modality")
            self.assertTrue(value.startswith(f"{level:g}{unit}"), value)

    def test_a_jitter_has_the_constant_delay_that_it_needs(self):
        element = xml.fromstring(quantities.degrade("visual", "jitter", 25.0))
        self.assertEqual((element.get("jitter"), element.get("delay")), ("25ms normal", "75ms network"))

    def test_touch_quantises_the_commanded_force_and_has_no_low_pass_of_force(self):
        self.assertEqual(xml.fromstring(quantities.degrade("haptic", "quantise", 0.1)).get("force_step"), "0.1N")
        self.assertEqual(xml.fromstring(quantities.degrade("audio", "quantise", 0.1)).get("quantise"), "0.1N")
        for operator, levels in (("lowpass", "20Hz"), ("quantise", "0.1N")):
            text = f'''<study name="s" version="1" scene="dark_room_game.sdf" task="game" seed="1"><instructions>Play.</instructions>
              <conditions><factor modality="haptic" operator="{operator}" levels="{levels}"/></conditions><procedure kind="constant" repetitions="1"/>
              <response kind="performance"/><stimulus by="participant" limit="30s"/></study>'''
            if operator == "lowpass":
                with self.assertRaisesRegex(Refusal, "lowpass changes forces and has no effect on haptic"):
                    self.read(text)
            else:
                self.read(text)

    def test_every_shipped_study_is_valid(self):
        names = sorted(p.stem for p in study_file.SHIPPED.glob("*.xml"))
        self.assertGreaterEqual(len(names), 6)
        for name in names:
            with self.subTest(name):
                self.assertEqual(study_file.read(name).name, name)

    def staged(self, element):
        """A study of games with this condition."""
        return ('<study name="s" version="1" scene="dark_room_game.sdf" task="game" seed="3"><conditions><nothing/>\n' + element +
                '</conditions><procedure kind="constant" repetitions="1"/><response kind="performance"/><stimulus by="participant" limit="30s"/></study>')

    def test_a_stage_of_touch_is_in_the_profile_and_in_the_table(self):
        cases = {'<factor modality="haptic" stage="percept" operator="delay" levels="40ms"/>': ("haptic:percept", "delay", '<degrade modality="haptic" stage="percept" delay="40ms"/>'),
                 '<factor modality="haptic" stage="force" operator="quantise" levels="2N"/>': ("haptic:force", "quantise", '<degrade modality="haptic" stage="force" quantise="2N"/>'),
                 '<factor modality="haptic" stage="force" operator="deadband" levels="20%"/>': ("haptic:force", "deadband", '<degrade modality="haptic" stage="force" deadband="20% force"/>'),
                 '<factor modality="haptic" stage="force" operator="lowpass" levels="20Hz"/>': ("haptic:force", "lowpass", '<degrade modality="haptic" stage="force" lowpass="20Hz"/>'),
                 '<factor modality="haptic" stage="model" operator="delay" levels="40ms"/>': ("haptic", "delay", '<degrade modality="haptic" delay="40ms"/>'),
                 '<remove modality="haptic" stage="action"/>': ("haptic:action", "off", '<degrade modality="haptic" stage="action" off="true"/>'),
                 '<remove modality="haptic" stage="force" how="freeze"/>': ("haptic:force", "freeze", '<degrade modality="haptic" stage="force" freeze="hold"/>')}
        for element, (sense, operator, profile) in cases.items():
            condition = self.read(self.staged(element)).conditions[-1]
            level = condition.fixed
            self.assertEqual([profile], condition.elements(level))
            row = condition.row(level)
            self.assertEqual((sense, operator), (row["modality_degraded"], row["operator"]))
            self.assertIn(sense, condition.id)
            self.assertEqual(sense == "haptic:percept", condition.acts_in_participant)

    def test_a_stage_that_does_not_exist_or_an_operator_that_it_lacks_is_refused(self):
        for element, word in (('<factor modality="audio" stage="force" operator="delay" levels="40ms"/>', "has no stages"),
                              ('<factor modality="haptic" stage="feel" operator="delay" levels="40ms"/>', "there is no stage feel"),
                              ('<factor modality="haptic" stage="action" operator="gain" levels="0.5"/>', "has no operator gain"),
                              ('<factor modality="haptic" stage="force" operator="delay" levels="1001ms"/>', "at most 1000 ms"),
                              ('<factor modality="haptic" stage="force" operator="jitter" levels="200ms"/>', "at most 1000 ms"),
                              ('<remove modality="haptic" stage="action" how="freeze"/>', "has no operator freeze"),
                              ('<remove modality="visual" stage="percept"/>', "has no stages")):
            self.refused(self.staged(element), word)

    def test_the_stages_of_studies_are_those_of_the_haptic_node(self):
        with open(SCRIPTS.parent / "haptic_node" / "modality.csv", encoding="utf-8") as file:
            rows = [line.split(",") for line in file if line.startswith("stage,")]
        self.assertEqual({stages.MODEL, *stages.STAGES}, {row[1] for row in rows})
        self.assertEqual(stages.LONGEST_MS, {row[1]: 1000 * float(row[5]) for row in rows if row[1] != stages.MODEL})


if __name__ == "__main__":
    unittest.main()
