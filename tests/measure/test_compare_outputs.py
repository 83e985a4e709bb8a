"""compare_outputs finds a difference that is planted in each kind of artefact, and leaves out what it is to leave out."""
import contextlib
import io
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
from outputs import artefacts, cases, changes, comparison, environment, log_file, runner, stored  # noqa: E402


def event(time_us, channel, payload, number=0):
    name = channel.encode()
    return log_file.EVENT.pack(log_file.SYNC_WORD, number, time_us, len(name), len(payload)) + name + payload


def message(body=b"body", fingerprint=b"12345678", seq=0):
    return fingerprint + struct.pack(">qqiqiqq", 1, 2, 3, 4, 5, 6, seq) + body


def text(value):
    return struct.pack(">i", len(value) + 1) + value.encode() + b"\0"


def log_of(messages):
    return b"".join(event(time_us, channel, payload) for time_us, channel, payload in messages)


LOG = [(0, "LOG_INFO", message(text("0.1.0") + text("abc") + text("scene.sdf"))), (10, "TOOL_STATE", message(b"one", seq=0)),
       (20, "WORLD_STATE", message(b"world")), (30, "TOOL_STATE", message(b"two", seq=1))]
WAV = b"RIFF" + bytes(range(256)) * 80
FILES = {
    "run/run.lcmlog": log_of(LOG),
    "run/summary.json": b'{"nodes": {"audio_node": {"ticks": 100}}, "seconds": 4}',
    "tables/schema.json": b'{"TOOL_STATE": {"fields": [{"field": "force_N", "meaning": "Force", "unit": "N"}]}}',
    "tables/LOG_INFO.csv": b"log_s,field,value\n0,version,0.1.0\n0,scene,a.sdf\n",
    "tables/TOOL_STATE.csv": b"log_s,force_N\n" + b"".join(b"%d,0.5\n" % i for i in range(100)),
    "clean/audio.wav": WAV,
    "clean/haptic.csv": b"host_s,force_x_N\n1.0,0.25\n2.0,0.50\n",
    "clean/thermal.csv": b"host_s,skin_degC\n1.0,33.0\n",
    "clean/frames.csv": b"frame,host_ns,pixels\n0,10,aa\n1,20,bb\n",
    "clean/video.mp4": b"mp4" * 5000,
    "clean/presented_audio.csv": b"modality,event_id\naudio,7\n",
    "games/games.jsonl": b'{"game":"1","won":true}\n',
}


class Folders(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.none = changes.Changes()

    def make(self, name, replaced=None):
        """A folder of artefacts like that of a case, some with other bytes; None leaves one out."""
        for path, content in {**FILES, **(replaced or {})}.items():
            whole = os.path.join(self.folder, name, path)
            os.makedirs(os.path.dirname(whole), exist_ok=True)
            if content is not None:
                with open(whole, "wb") as file:
                    file.write(content)
        return os.path.join(self.folder, name)

    def bad_rows(self, replaced, announced=None, exactly=True):
        """The rows that are not identical when the files of one of two equal folders are replaced."""
        announced = announced or self.none
        one, two = self.make("new", replaced), self.make("stored")
        ours, theirs = (artefacts.records(folder, announced) for folder in (one, two))
        locate = comparison.locate_in(one, two, announced) if exactly else comparison.locate_by_trail
        return [row for row in comparison.compare("case", ours, theirs, announced, locate) if row.result != comparison.IDENTICAL]

    def one_row(self, *words, **more):
        rows = self.bad_rows(*words, **more)
        self.assertEqual(len(rows), 1, rows)
        return rows[0]


class Differences(Folders):
    def test_equal_folders_have_no_difference(self):
        self.assertEqual(self.bad_rows({}), [])

    def test_a_planted_byte_is_found_in_every_artefact(self):
        for path, content in FILES.items():
            if path.endswith(".lcmlog"):
                continue
            with self.subTest(path):
                at = len(content) - 5
                other = content[:at] + (b"6" if content[at:at + 1] != b"6" else b"7") + content[at + 1:]
                if path.endswith(".json"):
                    other = content.replace(b"4", b"5") if b"4" in content else content.replace(b'"N"', b'"mN"')
                row = self.one_row({path: other})
                self.assertEqual((row.artefact, row.result), ("case/" + path, comparison.DIFFERS))
                self.assertNotEqual(row.detail, "no difference")

    def test_a_table_names_the_first_line_that_differs(self):
        row = self.one_row({"clean/haptic.csv": FILES["clean/haptic.csv"].replace(b"0.50", b"0.51")})
        self.assertEqual(row.detail, "line 3: 2.0,0.51 | before: 2.0,0.50")
        self.assertEqual(row.record["lines"], 3)

    def test_a_binary_file_names_the_first_byte_that_differs(self):
        other = bytearray(WAV)
        other[9000] ^= 1
        self.assertEqual(self.one_row({"clean/audio.wav": bytes(other)}).detail, "byte 9000")

    def test_the_row_of_an_artefact_that_ends_early_gives_its_length(self):
        row = self.one_row({"clean/frames.csv": b"frame,host_ns,pixels\n0,10,aa\n"})
        self.assertIn("ends after 2 lines", row.detail)

    def test_missing_and_new_artefacts_are_failures(self):
        self.assertEqual(self.one_row({"clean/thermal.csv": None}).result, comparison.MISSING)
        self.assertEqual(self.one_row({"clean/thermal.csv": FILES["clean/thermal.csv"], "clean/extra.csv": b"a\n"}).result, comparison.NEW)
        self.assertTrue({comparison.MISSING, comparison.NEW, comparison.FAILED, comparison.DIFFERS} == set(comparison.FAILURES))

    def test_a_case_without_stored_results_gives_one_row(self):
        rows = comparison.compare("case", artefacts.records(self.make("new"), self.none), {}, self.none, comparison.locate_by_trail)
        self.assertEqual([(row.artefact, row.result) for row in rows], [("case", comparison.NEW)])

    def test_without_the_bytes_a_difference_is_located_between_two_marks(self):
        lines = FILES["tables/TOOL_STATE.csv"].split(b"\n")
        lines[49] = b"48,0.6"
        row = self.one_row({"tables/TOOL_STATE.csv": b"\n".join(lines)}, exactly=False)
        self.assertEqual(row.detail, "the first difference lies in lines 33 to 64")
        lines[0] = b"log_s,force_mN"
        row = self.one_row({"tables/TOOL_STATE.csv": b"\n".join(lines)}, exactly=False)
        self.assertEqual(row.detail, "the first difference lies in lines 1 to 1")


class Logs(Folders):
    def replaced(self, number, *event_words):
        messages = list(LOG)
        messages[number] = event_words
        return {"run/run.lcmlog": log_of(messages)}

    def test_a_planted_difference_names_channel_message_and_place(self):
        row = self.one_row(self.replaced(3, 30, "TOOL_STATE", message(b"twO", seq=1)))
        self.assertEqual((row.artefact, row.detail), ("case/run/run.lcmlog:TOOL_STATE", "message 1 at 30 us, byte 2 behind its header"))
        row = self.one_row(self.replaced(3, 30, "TOOL_STATE", message(b"two", seq=2)))
        self.assertIn("header.seq", row.detail)

    def test_another_time_stamp_is_a_difference_of_the_channel_and_of_the_order(self):
        names = [row.artefact for row in self.bad_rows(self.replaced(3, 31, "TOOL_STATE", message(b"two", seq=1)))]
        self.assertEqual(names, ["case/run/run.lcmlog:(order)", "case/run/run.lcmlog:TOOL_STATE"])

    def test_renamed_fields_change_the_fingerprints_and_nothing_else(self):
        row = self.one_row(self.replaced(2, 20, "WORLD_STATE", message(b"world", fingerprint=b"87654321")))
        self.assertEqual(row.artefact, "case/run/run.lcmlog:(fingerprints)")

    def test_a_channel_of_plain_text_is_compared_from_its_first_byte(self):
        rows = self.bad_rows({"run/run.lcmlog": log_of([*LOG, (40, "LOG_TYPES", b"types")])})
        self.assertEqual([(row.artefact[-11:], row.result) for row in rows], [(".log:(order)"[-11:], comparison.DIFFERS), ("g:LOG_TYPES", comparison.NEW)])
        found = log_file.by_channel(self.make("new", {"run/run.lcmlog": log_of([(40, "LOG_TYPES", b"types")])}) + "/run/run.lcmlog", self.none)
        self.assertEqual((found["LOG_TYPES"], found[log_file.FINGERPRINTS]), ([log_file.TIME.pack(40) + b"types"], []))

    def test_version_and_commit_are_left_out_and_the_scene_is_not(self):
        self.assertEqual(self.bad_rows(self.replaced(0, 0, "LOG_INFO", message(text("0.2.0") + text("defg") + text("scene.sdf")))), [])
        self.assertEqual(self.one_row(self.replaced(0, 0, "LOG_INFO", message(text("0.1.0") + text("abc") + text("other.sdf")))).artefact, "case/run/run.lcmlog:LOG_INFO")

    def test_a_damaged_log_is_refused_in_a_sentence(self):
        for damage in (log_of(LOG)[:-1], log_of(LOG) + b"\0" * 30, log_of(LOG)[:-60]):
            with self.assertRaises(log_file.Damaged):
                artefacts.records(self.make("damaged", {"run/run.lcmlog": damage}), self.none)


class Exclusions(Folders):
    def test_comments_of_message_types_and_the_version_are_left_out(self):
        self.assertEqual(self.bad_rows({"tables/schema.json": FILES["tables/schema.json"].replace(b'"Force"', b'"The force"'),
                                        "tables/LOG_INFO.csv": FILES["tables/LOG_INFO.csv"].replace(b"0.1.0", b"0.2.0")}), [])

    def test_every_exclusion_has_a_reason(self):
        for table in (artefacts.EXCLUDED_ROWS, artefacts.EXCLUDED_COLUMNS, artefacts.EXCLUDED_KEYS):
            for reasons in table.values():
                self.assertTrue(all(reasons.values()))

    def test_a_column_can_be_left_out(self):
        found = list(artefacts.kept_lines("LOG_INFO.csv", [b"log_s,version,seed\n", b"0,0.1.0,7\n"]))
        self.assertEqual(found, [b"log_s,seed\n", b"0,7\n"])


class Announced(Folders):
    def announced(self, *rows):
        return changes.Changes([dict(zip(changes.COLUMNS, (*row, "for the test"))) for row in rows])

    def test_renamed_channels_columns_keys_and_files_are_no_difference(self):
        messages = [(time_us, channel.replace("TOOL", "HAND"), payload) for time_us, channel, payload in LOG]
        new = {"run/run.lcmlog": log_of(messages), "tables/TOOL_STATE.csv": None, "clean/haptic.csv": None,
               "tables/HAND_STATE.csv": FILES["tables/TOOL_STATE.csv"], "clean/force.csv": FILES["clean/haptic.csv"].replace(b"force_x_N", b"fx_N"),
               "run/summary.json": FILES["run/summary.json"].replace(b"ticks", b"done")}
        self.assertGreater(len(self.bad_rows(new)), 4)
        announced = self.announced(("channel", "", "TOOL_STATE", "HAND_STATE"), ("file", "", "haptic.csv", "force.csv"),
                                   ("column", "*force.csv", "force_x_N", "fx_N"), ("key", "summary.json", "ticks", "done"))
        self.assertEqual(self.bad_rows(new, announced), [])

    def test_texts_are_renamed_in_tables_and_json(self):
        new = {"clean/presented_audio.csv": b"modality,event_id\nsound,7\n", "run/summary.json": FILES["run/summary.json"].replace(b"4}", b'4, "a": "x"}')}
        rows = self.bad_rows(new, self.announced(("text", "presented_*.csv", "audio", "sound")))
        self.assertEqual([row.artefact for row in rows], ["case/run/summary.json"])

    def test_an_accepted_difference_is_announced_and_is_not_a_failure(self):
        row = self.one_row({"clean/thermal.csv": b"host_s\n"}, self.announced(("accept", "case/clean/thermal*", "", "")))
        self.assertEqual(row.result, comparison.ANNOUNCED)
        self.assertNotIn(row.result, comparison.FAILURES)

    def test_programs_and_options_get_the_names_of_the_build(self):
        announced = self.announced(("program", "", "export_csv", "tactus export"), ("option", "export_csv", "--out", "--output"))
        for name in ("old/export_csv", "new/tactus"):
            path = os.path.join(self.folder, name)
            os.makedirs(os.path.dirname(path))
            with open(path, "w", encoding="utf-8") as file:
                os.chmod(file.fileno(), 0o755)
        helps = {"old": "--out TEXT", "new": "--output TEXT"}
        words = lambda folder: announced.words(os.path.join(self.folder, folder), ["export_csv", "LOG", "--out", "."], lambda _: helps[folder])
        self.assertEqual([os.path.basename(word) for word in words("old")], ["export_csv", "LOG", "--out", "."])
        self.assertEqual([os.path.basename(word) for word in words("new")], ["tactus", "export", "LOG", "--output", "."])

    def test_bad_tables_are_refused(self):
        changes.read()
        for row in ("smell,,a,b,why", "column,,a,b,", "column,,,b,why", "accept,x"):
            path = os.path.join(self.folder, "changes.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write("kind,where,old,new,reason\n# a comment\n" + row + "\n")
            with self.assertRaises(changes.Refused):
                changes.read(path)


class Stored(Folders):
    KEY = {"instructions": "avx2", "forced": False, "libraries": {"libode8": "1"}}

    def test_results_of_other_instruction_sets_and_cases_stay(self):
        path = os.path.join(self.folder, "results.json")
        records = artefacts.records(self.make("stored"), self.none)
        stored.write(path, self.KEY, {"one": records})
        stored.write(path, {**self.KEY, "instructions": "sse2"}, {"one": {}})
        stored.write(path, self.KEY, {"two": records})
        entries = stored.read(path)
        self.assertEqual([sorted(entry["cases"]) for entry in entries], [["one", "two"], ["one"]])
        self.assertEqual(entries[1]["cases"]["one"], {})
        self.assertEqual(stored.entry_for(entries, self.KEY)["cases"]["one"], records)
        self.assertEqual(stored.entry_for(entries, {**self.KEY, "libraries": {}})["key"], self.KEY)
        self.assertIsNone(stored.entry_for(entries, {**self.KEY, "forced": True}))
        self.assertEqual(environment.different_libraries({"libode8": "2"}, {"libode8": "1"}), ["libode8: 1 stored, 2 here"])

    def test_equal_records_of_another_instruction_set_are_stored_once(self):
        path = os.path.join(self.folder, "results.json")
        records = artefacts.records(self.make("stored"), self.none)
        other = {**records, "clean/audio.wav": records["clean/haptic.csv"]}
        for instructions, found in (("avx2", records), ("sse2", other)):
            stored.write(path, {**self.KEY, "instructions": instructions}, {"one": found})
        self.assertEqual([entry["cases"]["one"] for entry in stored.read(path)], [records, other])
        with open(path, encoding="utf-8") as file:
            self.assertEqual(file.read().count(records["clean/thermal.csv"]["sha256"]), 1)

    def test_a_file_without_stored_results_is_refused(self):
        path = os.path.join(self.folder, "results.json")
        for content in ("", "[]", '{"format": 99}'):
            with open(path, "w", encoding="utf-8") as file:
                file.write(content)
            with self.assertRaises(stored.Refused):
                stored.read(path)


class Cases(Folders):
    def test_every_scene_and_profile_exists(self):
        root = os.path.dirname(os.path.dirname(HERE))
        self.assertGreaterEqual(len(cases.CASES), 6)
        for case in cases.CASES:
            self.assertTrue(os.path.isfile(os.path.join(root, cases.SCENES, case.scene_file())), case.name)
            self.assertTrue(not case.profile or os.path.isfile(cases.profile_file(root, case.profile)))
        self.assertTrue(os.path.isfile(cases.profile_file(root, "several_operators")))

    def test_quick_selects_one_case_and_a_log_is_a_separate_case(self):
        names = lambda *words: [case.name for case in cases.chosen(*words)]
        self.assertEqual(names(None, True, None), ["dark_room"])
        self.assertEqual(names(None, False, "x.lcmlog"), ["log"])
        self.assertEqual(names(["stack"], False, "x.lcmlog"), ["stack", "log"])
        self.assertEqual(len(names(None, False, None)), len(cases.CASES))
        self.assertNotIn("virtual_time", [words[0] for _, words in cases.steps(cases.of_log("x.lcmlog"), "/", {}, [])])

    def test_commands_do_not_contain_the_path_of_the_output_folder(self):
        for case in cases.CASES:
            for name, words in cases.steps(case, "/root", {}, ["sse2"]):
                self.assertEqual([word for word in words if word.startswith("/") and not word.endswith((".sdf", ".xml"))], [], name)

    def test_the_error_names_a_program_that_fails_or_is_missing(self):
        build = runner.Build(self.folder, "/", self.none, "best", [], environment.of_programs("best", self.folder), {})
        os.makedirs(os.path.join(self.folder, "logs"))
        with self.assertRaisesRegex(runner.Failed, "metronome: a: ended with status 3 .no scene"):
            build.step(cases.CASES[-1], "a", ["sh", "-c", "echo no scene >&2; exit 3"], self.folder)
        with self.assertRaisesRegex(runner.Failed, "cannot start"):
            build.step(cases.CASES[-1], "b", [os.path.join(self.folder, "none")], self.folder)


class Whole(Folders):
    def test_wrong_arguments_end_with_one_sentence(self):
        program = os.path.join(HERE, "compare_outputs")
        for words in (["--bin", "/none"], ["--bin", "/", "--jobs", "0"], ["--bin", "/", "--keep", "/"], ["--bin", "/", "--against", "/none.json"]):
            done = subprocess.run([program, *words], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)

    def test_rows_that_differ_are_printed_and_counted(self):
        rows = [comparison.Row("case/a", comparison.IDENTICAL, record={"bytes": 1}), comparison.Row("case/b", comparison.DIFFERS, "byte 3")]
        printed = io.StringIO()
        comparison.print_rows(rows, False, printed)
        self.assertEqual(printed.getvalue(), "case/b  DIFFERS    byte 3\n")
        self.assertEqual(comparison.total(rows), "1 identical, 1 DIFFERS")
        json.dumps([vars(row) for row in rows])
        with contextlib.redirect_stdout(io.StringIO()):
            comparison.print_rows([], True, sys.stdout)


if __name__ == "__main__":
    unittest.main()
