#!/usr/bin/env python3
"""Tables of trials are read completely, or refused with file, line and reason."""
import pathlib
import tempfile
import unittest

import analysis_tables
import numpy as np

from tactus.analysis import incomplete, trials
from tactus.refusal import Refusal

HEADER = "participant_id,task,observer,study,session,trial,level,success,completion_time_s,missed,seed\n"
GOOD = "P01,game,simulated,s,1,1,20,1,7.5,0,9\n"


class Tables(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.root = pathlib.Path(kept.name)

    def file(self, text, name="trials.csv"):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def refusal(self, text):
        path = self.file(text)
        with self.assertRaises(Refusal) as caught:
            trials.read([path])
        self.assertIn(str(path), str(caught.exception))
        return str(caught.exception)

    def test_empty_numbers_are_nan_and_absent_columns_are_empty(self):
        read = trials.read([self.file(HEADER + "P01,game,human,s,1,1,,1,7.5,,9\n")])
        self.assertEqual(len(read), 1)
        self.assertTrue(np.isnan(read["level"][0]) and np.isnan(read["loss_achieved"][0]))
        self.assertEqual((read["pair"][0], read["seed"][0], read["success"][0]), ("", "9", 1.0))

    def test_folders_are_searched_and_each_table_is_read_once(self):
        self.file(HEADER + GOOD, "study/P01/trials.csv")
        self.file(HEADER + GOOD.replace("P01", "P02"), "study/P02/session/trials.csv")
        self.file(HEADER + GOOD.replace("P01", "virtual"), "sweep/games.csv")
        read = trials.read(trials.files_of([self.root, self.root / "study" / "P01", self.root / "sweep" / "games.csv"]))
        self.assertEqual(read.participants(), ["P01", "P02", "virtual"])

    def test_a_missed_trial_is_left_out_and_counted(self):
        read = trials.read([self.file(HEADER + GOOD + GOOD.replace(",1,1,20", ",1,2,20").replace(",7.5,0", ",7.5,1"))])
        kept, left_out = trials.usable(read)
        self.assertEqual((len(kept), left_out), (1, 1))

    def test_a_degradation_without_its_sense_or_operator_is_refused(self):
        header = HEADER.replace("level", "modality_degraded,operator,level,unit")
        for given, clause in (("haptic,delay,20,ms", ""), (",,,", ""), (",delay,0,ms", ""), ("haptic,off,,", ""), (",delay,20,ms", "modality_degraded is empty"),
                              ("haptic,,20,ms", "operator is empty"), (",off,,", "modality_degraded is empty"), ("haptic,,,", "operator is empty")):
            text = header + GOOD.replace(",20,1,7.5", f",{given},1,7.5")
            if clause:
                self.assertIn(f":2: {clause}", self.refusal(text))
            else:
                self.assertEqual(1, len(trials.read([self.file(text)])))

    def test_levels_are_converted_to_the_unit_of_their_operator_or_refused(self):
        header = HEADER.replace("level", "modality_degraded,operator,level,unit")
        for given, level, unit in (("haptic,delay,0.2,s", 200, "ms"), ("haptic,delay,20,ms", 20, "ms"), ("haptic,loss,10,%", 10, "%"), ("haptic,loss,10,", 10, "")):
            read = trials.read([self.file(header + GOOD.replace(",20,1,7.5", f",{given},1,7.5"))])
            self.assertEqual((level, unit), (read["level"][0], read["unit"][0]))
        for given in ("haptic,loss,10,percent", "haptic,delay,10,parsec", "haptic,gain,0.5,dB"):
            self.assertIn(":2: unit is ", self.refusal(header + GOOD.replace(",20,1,7.5", f",{given},1,7.5")))

    def test_a_judgement_under_an_operator_needs_its_level(self):
        self.assertIn(":2: a trial under delay has no level", self.refusal("participant_id,task,observer,study,session,trial,modality_degraded,operator,level,unit,correct\n"
                                                                          "P01,2ifc,human,s,1,1,haptic,delay,,ms,1\n"))

    def test_trials_without_an_answer_or_a_measured_level_are_counted(self):
        header = "participant_id,task,observer,study,session,trial,modality_degraded,operator,level,unit,loss_achieved,correct,pair,soa_achieved_ms,response,success\n"
        rows = ("2ifc,human,s,1,1,haptic,loss,10,%,0.1,1,,,,", "2ifc,human,s,1,2,haptic,loss,10,%,,1,,,,", "2ifc,human,s,1,3,haptic,loss,10,%,0.1,,,,,",
                "2ifc,human,s,1,4,haptic,jitter,10,ms,,1,,,,", "sj,human,s,1,5,,,,,,,\"audio,visual\",40,yes,", "sj,human,s,1,6,,,,,,,\"audio,visual\",,yes,",
                "sj,human,s,1,7,,,,,,,\"audio,visual\",40,,", "game,human,s,1,8,,,,,,,,,,1", "game,human,s,1,9,,,,,,,,,,")
        read = trials.read([self.file(header + "".join(f"P01,{row}\n" for row in rows))])
        self.assertEqual([3, 7, 9], [int(n) for n in read["trial"][incomplete.unanswered(read)]])
        self.assertEqual([2, 6], [int(n) for n in read["trial"][incomplete.unmeasured(read)]])
        self.assertEqual(["3 are not used because they have no answer", "2 are not used because they have no measured level"], incomplete.words(read))

    def test_an_invalid_table_is_refused_with_its_line(self):
        cases = {
            HEADER + GOOD + GOOD.replace("20,1,7.5", "20,2,7.5"): ":3: success is 2",
            HEADER + GOOD.replace("20,1", "twenty,1"): ":2: level is 'twenty'",
            HEADER + GOOD.replace("7.5", "-1"): ":2: completion_time_s is -1",
            HEADER + GOOD.replace("7.5", "inf"): ":2: completion_time_s is 'inf'",
            HEADER + GOOD.replace(",9\n", "\n"): ":2: has 10 fields, but the header has 11",
            HEADER + GOOD.replace("simulated", "ghost"): ":2: observer is 'ghost'",
            HEADER + GOOD + GOOD: ":3: the same trial of P01",
            HEADER.replace("observer,", "") + GOOD: ":1: there is no column observer",
            HEADER.encode() + GOOD.encode().replace(b"P01", b"P\xff"): "not UTF-8",
        }
        for text, reason in cases.items():
            with self.subTest(reason):
                self.assertIn(reason, self.refusal(text))

    def test_the_same_table_from_another_program_gives_the_same_rows(self):
        plain = HEADER + GOOD + GOOD.replace(",1,1,20", ",1,2,20")
        first, *rest = plain.splitlines()
        empty = "," * HEADER.count(",")
        def rows(data):
            return trials.read([self.file(data)]).columns
        expected = rows(plain)
        for end in ("\n", "\r\n", "\r"):
            for mark in ("", "\ufeff"):
                for lines in ([first, *rest], [first, *rest, ""], [first, "", *rest, "", ""], ["", first, *rest, empty], [first, "  ", *rest, empty, empty]):
                    found = rows((mark + end.join(lines) + end).encode())
                    for name, values in expected.items():
                        np.testing.assert_array_equal(found[name], values)

    def test_another_separator_or_encoding_is_refused_with_its_line(self):
        plain = HEADER + GOOD
        for data, reason in ((plain.replace(",", ";"), ":1: its fields are separated by semicolons"), (plain.replace(",", "\t"), ":1: its fields are separated by tabs"),
                             ("\n\n" + plain.replace(",", ";"), ":3: its fields are separated by semicolons"), (plain.encode("utf-16"), ":1: is UTF-16"),
                             ("\ufeff" + plain.replace(",", ";"), ":1: its fields"), (plain + "\n\n" + GOOD.replace(",7.5", ""), ":5: has 10 fields")):
            with self.subTest(reason):
                self.assertIn(reason, self.refusal(data))

    def test_a_level_without_a_severity_is_refused(self):
        head = HEADER.replace(",level,", ",level,modality_degraded,operator,")
        for operator, level, reason in (("rate", "0", "a level of rate must be above 0"), ("delay", "-3", "0 or more"), ("lowpass", "", "has no level"), ("delay", "1_0", "level is '1_0'")):
            self.assertIn(reason, self.refusal(head + GOOD.replace(",20,", f",{level},visual,{operator},")))
        for operator, level in (("gain", "0"), ("off", ""), ("delay", "0")):
            self.assertEqual(len(trials.read([self.file(head + GOOD.replace(",20,", f",{level},visual,{operator},"))])), 1)

    def test_a_table_without_rows_and_a_place_without_tables_are_refused(self):
        with self.assertRaisesRegex(Refusal, "holds no trials"):
            trials.read([self.file(HEADER)])
        (self.root / "empty").mkdir()
        for place, reason in (("nowhere", "does not exist"), ("empty", "holds no trials.csv or games.csv")):
            with self.assertRaisesRegex(Refusal, reason):
                trials.files_of([self.root / place])

    def test_random_damage_is_refused_in_one_sentence_or_read(self):
        rng = np.random.default_rng(7)
        whole = (HEADER + "".join(GOOD.replace(",1,1,20", f",1,{i},20") for i in range(20))).encode()
        outcomes = set()
        for _ in range(400):
            damaged = bytearray(whole)
            for at in rng.integers(0, len(damaged), rng.integers(1, 4)):
                damaged[at] = rng.integers(0, 128)
            try:
                trials.read([self.file(bytes(damaged))])
                outcomes.add("read")
            except Refusal as refused:
                outcomes.add("refused")
                self.assertNotIn("\n", str(refused)[:60])
        self.assertEqual(outcomes, {"read", "refused"})


if __name__ == "__main__":
    unittest.main()
