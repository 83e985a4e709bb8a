#!/usr/bin/python3 -I
"""The checker of the language must find each offence that is planted, with its line, and pass a good sentence for each."""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import tempfile
import unittest

import check_prose

# rule: (refused, accepted)
SENTENCES = {
    "anew": (["The clock starts anew."], ["The clock restarts.", "A new clock starts."]),
    "whoever": (["Any message reaches whoever listens.", "Whoever reads this repeats it."], ["A message reaches every receiver."]),
    "whatever": (["The force stays below it, whatever arrives."], ["The force stays below it for any input."]),
    "nobody": (["The value is taken when nobody asks.", "Somebody moved it."], ["The value is sampled only while a page requests it."]),
    "so-many": (["Blocks of so many frames.", "It waits for so long.", "Changed at most so often."],
                ["Blocks of 64 frames.", "It is so small that it vanishes.", "Many frames, so that none is lost."]),
    "what-subject": (["What arrives late is dropped.", "Pure. What a sense is on the bus", "What the card says in one callback."],
                     ["Late messages are dropped.", "What is the age of a frame?", "Prints what to do."]),
    "who-subject": (["Who has not by then is unwound.", "It is closed; who asks later is refused."],
                    ["Programs still running at the timeout are unwound.", "Who moved?"]),
    "what-object": (["The sum of what is received.", "Faster than what the device can."],
                    ["The sum of the received samples.", "It depends on what the device can do.", "Asks what it is."]),
    "owe": (["The report that a sense owes.", "It pays the debt.", "Two are owed."], ["The expected report.", "Owing to the delay, it ends late."]),
    "fate": (["The fate of each event."], ["The outcome of each event."]),
    "told": (["The node is told of it.", "They are told apart by source."],
             ["The node receives it.", "The participant is told which key to press.", "Users are told so."]),
    "tells": (["The page tells the driver."], ["The page publishes it.", "The experimenter tells the participant."]),
    "tell": (["The filter cannot tell noise from signal.", "It is there to tell of it."],
             ["The filter cannot separate noise and signal.", "Participants can tell the two apart."]),
    "hear": (["The node has not heard from it.", "Two sites that do not hear each other.", "No receiver was heard of."],
             ["The node has received no message.", "The participant hears the click.", "A source is heard from the left."]),
    "knows": (["The node knows the profile.", "It is a receiver that wants pages."], ["The node stores the profile.", "The user knows it."]),
    "says": (["The scene says where it is."], ["The scene specifies where it is.", "The user says yes."]),
    "he": (["The user moves his hand."], ["The user moves their hand.", "The heat is here."]),
    "go-on": (["The run goes on.", "It went on with the next."], ["The run continues.", "The texture goes on the wall.", "Go once."]),
    "lets-go-on": (["It lets the world go on.", "Lets go of the device."], ["It resumes the world."]),
    "stand-in": (["It stands in for a device."], ["It simulates a device."]),
    "give-back": (["It gives back the buffer."], ["It returns the buffer."]),
    "let-in": (["No bad message is let in.", "Every page is let through."], ["Bad messages are rejected."]),
    "look-on": (["A page looks on."], ["A page monitors the run.", "Look at the page."]),
    "one-of-lives": (["Another life of the node.", "The birth of a contact."], ["A new incarnation.", "Date of birth"]),
    "nothing-that": (["Nothing is drawn here that was not asked for."], ["Only requested items are drawn.", "Nothing is drawn."]),
    "cleft": (["It is the simulation that decides."], ["The simulation decides.", "It is possible that it ends."]),
    "lest": (["It waits, lest a page be lost."], ["It waits, so that no page is lost."]),
    "worse": (["Profiles make a sense worse."], ["Profiles degrade a sense."]),
    "turn": (["Once every turn of the loop."], ["Once per tick.", "A quarter turn about z."]),
    "bear": (["A file that bears its name."], ["A file of that name."]),
    "the-one-who": (["The one who sends it repeats it."], ["The sender repeats it."]),
    "without-a-word": (["It ends without a word."], ["It ends silently."]),
    "in-the-place": (["A program in the place of a person."], ["A program instead of a person."]),
}


class CheckProse(unittest.TestCase):
    def found(self, name, text, more=None, excepted=None, limits=()):
        with tempfile.TemporaryDirectory() as root:
            for file, content in {name: text, **(more or {})}.items():
                path = os.path.join(root, file)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w", encoding="utf-8") as out:
                    out.write(content)
                if content.startswith("#!"):
                    os.chmod(path, 0o755)
            return list(check_prose.offences(root, limits, excepted))

    def test_every_rule_has_an_example(self):
        self.assertEqual({rule.name for rule in check_prose.COMPILED}, set(SENTENCES))
        self.assertLessEqual(set(check_prose.NEEDS), set(SENTENCES))

    def test_each_offence_is_found_and_each_good_sentence_passes(self):
        for rule, (refused, accepted) in SENTENCES.items():
            for sentence in refused:
                with self.subTest(rule=rule, sentence=sentence):
                    found = self.found("sync/a.h", f"#pragma once\n\n// {sentence}\nint x;\n")
                    self.assertIn((rule, 3), [(o.rule, o.line) for o in found])
            for sentence in accepted:
                with self.subTest(rule=rule, sentence=sentence):
                    self.assertEqual([], self.found("sync/a.h", f"#pragma once\n\n// {sentence}\nint x;\n"))

    def test_an_offence_is_found_in_each_kind_of_text_with_its_line(self):
        for name, text, line in [
                ("sync/a.h", "int x;  // starts anew\n", 1), ("sync/a.cpp", "/* One line.\n   Starts anew. */\n", 2),
                ("sync/a.cpp", 'fail("the clock "\n     "starts anew");\n', 2), ("sync/a.cpp", '\nauto s = R"(the clock starts\nanew)";\n', 3),
                ("tests/sync/a_test.cpp", 'TEST_CASE("A clock starts anew") {}\n', 1), ("lcmtypes/a_t.lcm", "// starts anew\n", 1),
                ("scripts/a.py", '"""One.\n\nStarts anew."""\n', 3), ("scripts/a.py", "# starts\n# anew\n", 2),
                ("scripts/a.py", "add('--x', help='starts the clock anew')\n", 1), ("scripts/a", "#!/usr/bin/env python3\n# starts anew\n", 2),
                ("scripts/b", "#!/bin/sh\n# starts anew\n", 2), ("scripts/b", "#!/bin/sh\ncat <<'TEXT'\nIt starts\nthe clock anew.\nTEXT\n", 4),
                ("scripts/b", '#!/bin/sh\necho "it starts the clock anew"\n', 2), ("cmake/a.cmake", "# starts anew\n", 1),
                ("sync/CMakeLists.txt", 'add_test(NAME "a clock starts anew")\n', 1), ("visual_node/a.glsl", "\n// starts anew\n", 2),
                ("scripts/a.ts", "const s = 'starts the clock anew';\n", 1), ("scripts/a.html", "<p>\nStarts the clock anew.</p>\n", 2),
                ("docs/a.md", "# Title\n\nIt starts\nanew.\n", 4), ("docs/a.md", "| a | starts anew |\n", 1),
                ("sync/settings.csv", "name,meaning,source\nx,Starts anew,design\n", 2)]:
            with self.subTest(name=name, text=text):
                found = self.found(name, text)
                self.assertEqual([("anew", line)], [(o.rule, o.line) for o in found])

    def test_code_in_documentation_and_short_literals_are_no_prose(self):
        for name, text in [("docs/a.md", "```sh\nrestart anew\n```\n"), ("docs/a.md", "The option `--anew` and [this](anew.md).\n"),
                           ("sync/a.cpp", 'const char* kKey = "anew";\n'), ("scripts/a.py", "x = d['anew']\n")]:
            with self.subTest(text=text):
                self.assertEqual([], self.found(name, text))

    def test_a_sentence_over_two_lines_of_comments_is_one(self):
        found = self.found("sync/a.h", "// It is not. What\n// arrives late is dropped.\n")
        self.assertEqual([("what-subject", 1)], [(o.rule, o.line) for o in found])
        self.assertEqual([], self.found("sync/a.h", "// Prints\nint so;\n// many pages.\n"))

    def test_old_names_are_found_as_whole_words_of_code_where_they_apply(self):
        for name, text, refused in [("sync/a.h", "class Sense {};", "Sense"), ("sync/a.h", "int kMostPages;", "kMostPages"),
                                    ("audio_node/a.h", "struct Place {};", "Place"), ("tests/audio_node/a.cpp", "Place p;", "Place"),
                                    ("sync/a.cpp", "x.still_here();", "still_here"), ("scripts/a.py", "MOST_TRIALS = 3", "MOST_TRIALS"),
                                    ("scripts/a.py", "x.tell(line)", "tell"), ("sync/a.h", "int told_ = 0;", "told_"),
                                    ("sync/a.cpp", "void begin_anew();", "begin_anew")]:
            with self.subTest(text=text):
                self.assertEqual([("name", refused, 1)], [(o.rule, o.text, o.line) for o in self.found(name, text + "\n")])
        for name, text in [("sim_node/a.h", "struct Place {};"), ("sync/a.h", "class Senses {}; int kMostly; bool almost_m;"),
                           ("scripts/a.py", "at = file.tell()"), ("sync/a.h", 'auto s = "Sense";  // Sense')]:
            with self.subTest(text=text):
                self.assertEqual([], self.found(name, text + "\n"))

    def test_old_folders_and_files_are_found_once(self):
        found = self.found("scripts/spread/a.py", "x = 1\n", {"scripts/spread/b.py": "", "sync/how.h": ""})
        self.assertEqual(["scripts/spread", "sync/how.h"], sorted(o.path for o in found))

    def test_exceptions_and_limits_apply(self):
        text = "// starts anew\n"
        self.assertEqual([], self.found("sync/a.h", text, excepted={"sync/a.h": {"*"}}))
        self.assertEqual([], self.found("sync/a.h", text, excepted={"sync/a.h": {"anew"}}))
        self.assertEqual(1, len(self.found("sync/a.h", text, excepted={"sync/a.h": {"fate"}})))
        self.assertEqual([], self.found("sync/a.h", text, limits=["audio_node"]))
        self.assertEqual(1, len(self.found("sync/a.h", text, {"syncs/b.h": text}, limits=["sync"])))

    def test_an_exception_needs_a_reason(self):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write("# reasons\nsync/a.h | fate anew | quotes a title\n")
            file.flush()
            self.assertEqual({"sync/a.h": {"fate", "anew"}}, check_prose.exceptions(file.name))
            file.write("sync/b.h | fate |\n")
            file.flush()
            with self.assertRaises(SystemExit):
                check_prose.exceptions(file.name)

    def test_every_exception_names_a_file(self):
        here = os.path.dirname(os.path.abspath(__file__))
        for path in check_prose.exceptions(os.path.join(here, "prose_exceptions.txt")):
            self.assertTrue(os.path.exists(os.path.join(here, "..", "..", path)), path)


if __name__ == "__main__":
    unittest.main()
