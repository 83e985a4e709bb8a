"""Texts and names of any language: study files, names of participants, labels, and the bytes in all files."""
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unicodedata
import unittest
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import bids_labels, fonts, formats, journal, questions, study_file, texts
from tactus.study.plan import Plan
from tactus.study.session import Session

# The same question in each of six scripts, and Hebrew.
ASKED = ("Did they come together?", "Ήρθαν μαζί;", "Они пришли вместе?", "它们是同时到来的吗？", "هل جاءا معًا؟", "क्या वे एक साथ आए?", "האם הם באו יחד?")
NAMES = ("Анна", "Ελένη", "小明", "مريم", "प्रिया")
STUDY = """<?xml version="1.0" encoding="UTF-8"?>
<study name="s" version="1" scene="single_taps.sdf" task="tap" seed="3">
  <instructions>{text}</instructions>
  {phrases}
  <conditions><asynchrony between="audio visual" levels="0ms 100ms"/></conditions>
  <procedure kind="constant" repetitions="4"/>
  <response kind="order"><question>{text}</question><choice>{a}</choice><choice>{b}</choice></response>
  <questionnaire><item id="age"><text>{text}</text><choice>{a}</choice><choice>{b}</choice></item></questionnaire>
</study>
"""


def study_of(text, a="{a}", b="{b}", phrases=""):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "s.xml"
        path.write_text(STUDY.format(text=text, a=a, b=b, phrases=phrases), encoding="utf-8")
        return study_file.read(path)


class Texts(unittest.TestCase):
    def refused(self, *words, **parts):
        with self.assertRaises(Refusal) as caught:
            study_of(**parts)
        self.assertRegex(str(caught.exception), r"s\.xml:\d+: ")
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_a_text_of_each_script_is_read_as_it_is_written(self):
        for text in ASKED:
            s = study_of(text)
            self.assertEqual((s.instructions, s.question, s.questionnaire[0].text), ((text,), text, text))
        # Blanks of XML become one; other blanks, joiners and composed or decomposed letters stay.
        kept = "a\u00a0b\u3000c\u200dd e\u0301 \u00e9"
        self.assertEqual(study_of("\n  " + kept.replace(" ", " \t\n ") + " ").question, kept)

    def test_a_text_that_no_line_can_show_is_refused_with_its_line(self):
        self.refused("U+0085", text="a\u0085b")
        self.refused("U+2028", text="a\u2028b")
        self.refused("no visible character", text="\u200d\u00a0\u3000")
        self.refused("has 6001 characters; write 1 to 6000", text="я" * 6001)
        self.refused("the text of choice", "has 41 characters", text="?", b="я" * 41)

    def test_a_text_and_choices_of_any_script_have_the_same_limits_in_characters(self):
        for letter in ("a", "я", "न", "\U0001d4d0"):
            s = study_of(letter * 6000, a=letter * 40, b=letter * 40)
            self.assertEqual((len(s.question), len(s.choices[0]), len(s.instructions[0]), len(s.questionnaire[0].text)), (6000, 40, 6000, 6000))

    def test_a_choice_that_is_too_long_with_the_words_of_the_senses_is_refused(self):
        word = '<phrase of="audio">' + "я" * 30 + "</phrase>"
        self.refused("with the word " + "я" * 30 + " filled in has 41 characters", text="?", a="{a} пришёл был", phrases=word)
        self.assertEqual(study_of("?", a="{a} пришёл", phrases=word).choices[0], "{a} пришёл")

    def test_phrases_of_the_session_are_in_the_language_of_the_file(self):
        s = study_of("{a}?", phrases='<phrase of="audio">звук</phrase><phrase of="visual">картина</phrase><phrase of="end">Спасибо!</phrase>'
                                     '<phrase of="break">Блок {block} из {blocks}. Пауза {seconds} с.</phrase><phrase of="progress">{done} из {trials}</phrase>')
        trial = Plan(s, "P01").next()
        asked = questions.words(s, trial)
        self.assertEqual((asked["text"], asked["choices"]), ("звук?", ["звук", "картина"]))
        self.assertEqual(s.phrases["end"], "Спасибо!")
        self.assertEqual(texts.fill(s.phrases["break"], block=1, blocks=2, seconds=30), "Блок 1 из 2. Пауза 30 с.")
        self.refused("the phrase of progress lacks {trials}", text="?", phrases='<phrase of="progress">{done}</phrase>')
        self.refused("more than 64 characters", text="?", phrases='<phrase of="progress">' + "я" * 54 + ' {done} {trials}</phrase>')
        self.assertEqual(study_of("?", phrases='<phrase of="progress">' + "я" * 52 + ' {done} {trials}</phrase>').phrases["progress"], "я" * 52 + " {done} {trials}")

    def test_hints_of_keys_are_in_the_language_of_the_file(self):
        s = study_of("?", phrases='<phrase of="hint_read">Ввод: дальше</phrase><phrase of="hint_number">Стрелки, потом Ввод</phrase>')
        self.assertEqual([s.phrases[texts.HINTS[kind]] for kind in ("read", "choice", "number")], ["Ввод: дальше", "", "Стрелки, потом Ввод"])
        self.refused("has 65 characters", text="?", phrases='<phrase of="hint_choice">' + "я" * 65 + "</phrase>")

    def test_screens_hold_the_whole_text_and_divide_no_word_and_no_letter_from_its_marks(self):
        dice = random.Random(1)
        for case in range(300):
            blank = " " * (case % 2)
            words = ["".join(dice.choice("aяन") + dice.choice(("", "", "\u0301", "\u093e")) for _ in range(dice.randrange(1, 12))) + dice.choice(("", "", "", ".", "。"))
                     for _ in range(dice.randrange(1, 500))]
            text = blank.join(words)
            parts = texts.screens(text)
            self.assertEqual(blank.join(parts) if blank else "".join(parts), text)
            for part in parts:
                self.assertTrue(0 < len(part) <= texts.LONGEST_SCREEN and part == part.strip(" "))
                self.assertNotEqual(unicodedata.category(part[0])[0], "M")
            self.assertEqual(len(parts), 1) if len(text) <= texts.LONGEST_SCREEN else self.assertLessEqual(len(parts), 2 + 2 * len(text) // texts.LONGEST_SCREEN)
        self.assertEqual(texts.screens("a" * 600), ["a" * 600])
        self.assertEqual(texts.screens("b" * 400 + ". " + "c" * 300), ["b" * 400 + ".", "c" * 300])

    def test_a_long_text_is_shown_on_several_screens_and_the_last_one_asks(self):
        sent = []
        session = Session.__new__(Session)
        session.study = study_of("?", phrases='<phrase of="hint_read">Ввод: дальше</phrase><phrase of="hint_choice">Нажмите номер</phrase>')
        session.plan, session.participant, session.cluster = mock.Mock(done=0, expected_trials=4), None, mock.Mock()
        session.runner = mock.Mock(send=lambda question: sent.append(question), wait_for=lambda *_: True)
        session.ask({"kind": "choice", "text": "b" * 400 + ". " + "c" * 400 + ". " + "d" * 10, "choices": ["1", "2"]})
        self.assertEqual([(q["kind"], q["hint"], len(q["text"])) for q in sent], [("read", "Ввод: дальше", 401), ("choice", "Нажмите номер", 412)])
        self.assertTrue(all(len(q["text"]) <= texts.LONGEST_SCREEN for q in sent))


class Names(unittest.TestCase):
    def test_a_name_has_letters_marks_and_digits_of_any_script(self):
        for name in (*NAMES, "P01", "P-1_b", "دانش\u200cآموز", "क्ष", "Zoë", "٣", "한글"):
            self.assertEqual(texts.participant_name(name), unicodedata.normalize("NFC", name))
        self.assertEqual(texts.participant_name("Zoe\u0308"), "Zoë")
        for name in ("", "-_", "\u0301a", "a b", "a/b", "../a", "a\tb", "a\u202eb", "\u200d", "я" * 41, "😀", "a\u00a0b"):
            with self.assertRaises(Refusal, msg=name):
                texts.participant_name(name)
        with self.assertRaisesRegex(Refusal, "is not UTF-8"):
            texts.participant_name(os.fsdecode(b"J\xf6rg"))


def begun(out, name, folder=None):
    with journal.Journal(pathlib.Path(out) / "s" / (folder or name)) as j:
        bids_labels.begin(j, study="s", study_sha256="0" * 64, participant=name, seed=1, observer="human")
        return j.entries[0]["label"]


def answered(folder, name, question, choice):
    """A journal of one trial and one item of the questionnaire, with its exports."""
    with journal.Journal(folder) as j:
        bids_labels.begin(j, study="s", study_sha256="0" * 64, participant=name, seed=1, observer="human")
        row = {"participant_id": name, "session": 1, "block": 1, "trial": 1, "task": "rating", "observer": "human", "study": "s", "condition": "c", "missed": 0,
               "question": question, "response": choice, "response_time": 0.5}
        j.append({"kind": "trial", "trial": 1, "attempt": 1, "block": 1, "condition": "c", "question": "rating", "level": 1.0, "response": choice, "yes": None, "missed": "",
                  "row": row})
        j.append({"kind": "questionnaire", "item": "age", "answer": choice})
    formats.export(folder)


class Labels(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.out = pathlib.Path(scratch.name)

    def test_names_in_other_scripts_have_numbered_labels_that_are_listed_with_the_name(self):
        listed = {}
        for name, question in zip(NAMES, ASKED[1:]):
            answered(self.out / "s" / name, name, question, name)
            with open(self.out / "s" / name / "bids" / "participants.tsv", encoding="utf-8", newline="") as file:
                (row,) = csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)
            listed[row["name"]] = row["participant_id"]
            self.assertIn("name of the participant", json.loads((self.out / "s" / name / "bids" / "participants.json").read_text(encoding="utf-8"))["name"]["Description"])
            self.assertTrue((self.out / "s" / name / "bids" / row["participant_id"]).is_dir())
        self.assertEqual(listed, {name: f"sub-n{number:03d}" for number, name in enumerate(NAMES, start=1)})

    def test_no_two_names_share_a_label(self):
        dice = random.Random(3)
        letters = "aA1_-яé名"
        for case in range(6):
            out = self.out / str(case)
            names = list(dict.fromkeys("a" + "".join(dice.choice(letters) for _ in range(dice.randrange(4))) for _ in range(12))) + ["n001", "N002"]
            dice.shuffle(names)
            labels = {name: begun(out, name) for name in names}
            self.assertEqual(len({label.casefold() for label in labels.values()}), len(names), labels)
            for label in labels.values():
                self.assertRegex(label, "^[A-Za-z0-9]+$")
            self.assertEqual({name: begun(out, name) for name in names}, labels, "a resumed session keeps its label")
            self.assertEqual(begun(out, names[0], names[0] + "_session2"), labels[names[0]], "so does the next session of a participant")

    def test_a_name_of_ascii_letters_and_digits_is_its_own_label(self):
        self.assertEqual([begun(self.out, name) for name in ("P_01", "Müller", "P01", "p-01", "Mller")], ["P01", "n001", "n002", "n003", "Mller"])

    def test_journals_without_a_label_and_folders_of_two_computers_have_different_labels(self):
        session = {"kind": "session", "study": "s", "seed": 1, "observer": "human", "study_sha256": "0"}
        of = lambda name, at, **more: {**session, "participant": name, "time_utc": at, **more}
        old = [of("Анна", "2026-02"), of("小明", "2026-01"), of("P01", "2026-03")]
        self.assertEqual(bids_labels.assigned(old), {"小明": "n001", "Анна": "n002", "P01": "P01"})
        two = [of("Анна", "2026-02", label="n001"), of("小明", "2026-01", label="n001"), of("P01", "2026-03", label="../x")]
        self.assertEqual(bids_labels.assigned(two), {"小明": "n001", "Анна": "n002", "P01": "P01"})

    def test_every_file_keeps_the_bytes_of_every_script(self):
        for name, question in zip(("P01", *NAMES), ASKED):
            folder = self.out / "s" / name
            answered(folder, name, question, question[:8])
            for path, parts in (("journal.jsonl", (name, question)), ("trials.csv", (name, question)), ("psychopy.csv", (name, question)), ("questionnaire.csv", (name, question[:8])),
                                ("bids/participants.tsv", (name,)), ("bids/phenotype/questionnaire.tsv", (question[:8],))):
                data = (folder / path).read_bytes()
                for part in parts:
                    self.assertIn(part.encode(), data, f"{path} {name}")
            (table,) = folder.glob("bids/sub-*/ses-1/beh/*_beh.tsv")
            self.assertIn(question.encode(), table.read_bytes())


class Fonts(unittest.TestCase):
    """A substitute for draw_text covers every character except those of one script."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.bin = pathlib.Path(scratch.name)
        program = self.bin / "draw_text"
        program.write_text("#!/usr/bin/python3 -I\nimport sys\nfor c in dict.fromkeys(sys.stdin.buffer.read().decode()):\n    if 0x900 <= ord(c) < 0x980: print(f'U+{ord(c):04X}')\n", encoding="utf-8")
        program.chmod(0o755)
        for what, value in (("BIN", self.bin), ("prepare.install", mock.Mock())):
            patched = mock.patch(f"tactus.study.fonts.{what}", value)
            self.addCleanup(patched.stop)
            patched.start()

    def test_a_character_without_a_font_refuses_the_window_before_it_opens(self):
        fonts.provide(study_of("Да?"), window=True)
        self.assertFalse(fonts.prepare.install.called, "installed fonts suffice")
        with self.assertRaises(Refusal) as caught:
            fonts.provide(study_of("न त?"), window=True)
        fonts.prepare.install.assert_called_once_with("fonts")
        self.assertIn("no installed font covers न (U+0928 DEVANAGARI LETTER NA), त (U+0924 DEVANAGARI LETTER TA); install", str(caught.exception))
        with mock.patch("tactus.study.fonts.report") as said:
            fonts.provide(study_of("न?"), window=False)
        self.assertIn("on the machine of the page", said.call_args.args[0])

    def test_the_check_names_the_characters_or_reports_that_all_are_covered(self):
        self.assertEqual(fonts.words(study_of("OK?")), [])
        self.assertEqual(fonts.words(study_of("Да?")), ["the installed fonts cover all texts"])
        self.assertIn("no installed font covers न (U+0928 DEVANAGARI LETTER NA)", fonts.words(study_of("न?"))[0])
        (self.bin / "draw_text").unlink()
        self.assertIn("not checked", fonts.words(study_of("न?"))[0])

    def test_a_check_without_an_end_is_one_sentence(self):
        with mock.patch("tactus.study.fonts.subprocess.run", side_effect=subprocess.TimeoutExpired("draw_text", fonts.TIMEOUT_S)):
            with self.assertRaises(Refusal) as caught:
                fonts.words(study_of("न?"))
        self.assertIn("not checked within", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
