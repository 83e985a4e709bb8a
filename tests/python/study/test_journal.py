"""The journal of a participant: no answer is lost or asked twice, however the session ends."""
import fcntl
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import unittest
import zlib
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import bids_labels, journal, session, study_file
from tactus.study.journal import Journal
from tactus.study.plan import Plan

MEMORY = "/dev/shm"
SESSION = {"study": "s", "study_sha256": "00", "participant": "P01", "seed": 7, "observer": "simulated"}
STUDY = """<study name="random" version="1" scene="single_taps.sdf" task="{task}" seed="{seed}">
  <conditions>{conditions}</conditions>
  {procedure}
  <response kind="{response}"/>
  <blocks count="{blocks}"/>
</study>
"""
# A program that appends trials until it is killed, and prints the number of each stored trial.
WRITER = """
import sys
sys.path.insert(0, {python!r})
from tactus.study.journal import Journal
with Journal({folder!r}) as j:
    j.begin(**{session!r})
    while True:
        n = len(j.answered()) + 1
        j.append({{"kind": "trial", "trial": n, "attempt": 1, "block": 1, "condition": "c" * 3000, "question": "synchrony", "level": 0.5, "response": "yes", "yes": True,
                   "missed": "", "row": {{"trial": n}}}})
        print(n, flush=True)
"""


def trial(number, missed="", yes=True, level=1.5, condition="audio-visual", **more):
    return {"kind": "trial", "trial": number, "attempt": 1, "block": 1, "condition": condition, "question": "synchrony", "level": level, "response": "yes", "yes": yes,
            "missed": missed, "row": {"trial": number}, **more}


class Folder(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory(dir=MEMORY if os.path.isdir(MEMORY) else None)  # every entry is synced, which a disk takes milliseconds for
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name) / "s" / "P01"
        self.path = self.folder / journal.NAME

    def opened(self):
        j = Journal(self.folder)
        self.addCleanup(j.close)
        return j

    def written(self, count=4):
        """The bytes of a journal of `count` trials, with texts that need escapes."""
        with Journal(self.folder) as j:
            j.begin(**SESSION)
            j.append({"kind": "note", "text": 'they said "ä \u2028 \\ no"\n\t, "crc32": "'})
            for n in range(1, count + 1):
                j.append(trial(n, missed="late by 30 ms"))
                j.append(trial(n, level=[n / 3, -1.0] if n % 2 else n / 3))
        return self.path.read_bytes()

    def refused(self, *words):
        with self.assertRaises(Refusal) as caught:
            Journal(self.folder).close()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))


class Lines(Folder):
    def test_appended_entries_are_read_back(self):
        j = self.opened()
        self.assertFalse(j.begin(**SESSION))
        kept = [j.append(trial(1, row={"pair": "audio,visual"}, level=(1, 2.5))), j.append({"kind": "questionnaire", "item": "demand", "answer": 55.0}),
                j.append({"kind": "break"}), j.append({"kind": "end"})]
        self.assertTrue(j.ended)
        j.close()
        again = self.opened()
        self.assertEqual(again.entries[1:], kept)
        self.assertEqual(journal.read(self.folder), again.entries)
        self.assertEqual([e["n"] for e in again.entries], [1, 2, 3, 4, 5])
        self.assertEqual(again.entries[1]["level"], [1, 2.5])
        self.assertTrue(all(e["time_utc"].endswith("+00:00") for e in again.entries))

    def test_an_entry_is_synced_to_the_disk_before_append_returns(self):
        j = self.opened()
        j.begin(**SESSION)
        synced = []
        with mock.patch("tactus.study.journal.os.fsync", side_effect=lambda fd: synced.append(self.path.read_bytes())):
            j.append(trial(1))
        self.assertEqual(synced, [self.path.read_bytes()], "one sync, after the complete line is written")

    def test_texts_of_any_language_and_numbers_are_unchanged(self):
        dice = random.Random(2)
        j = self.opened()
        j.begin(**SESSION)
        for n in range(1, 60):
            text = "".join(chr(dice.choice((9, 10, 34, 92, 44, 0x7f, 228, 0x2028, 0x1f600, dice.randrange(32, 0xd000)))) for _ in range(12))
            j.append(trial(n, level=dice.uniform(-1e3, 1e3), condition=text, response=text))
        self.assertEqual(journal.read(self.folder), j.entries)
        lines = self.path.read_bytes().split(b"\n")
        self.assertEqual(len(lines), 61, "an entry is one line")
        self.assertEqual([json.loads(line)["response"] for line in lines[1:-1]], [e["response"] for e in j.answered()])

    def test_a_trial_is_answered_once_and_repeated_only_when_it_was_missed(self):
        j = self.opened()
        j.begin(**SESSION)
        j.append(trial(1, missed="late"))
        j.append(trial(1))
        before = self.path.read_bytes()
        with self.assertRaisesRegex(ValueError, "trial 1 is answered already"):
            j.append(trial(1))
        self.assertEqual(self.path.read_bytes(), before)
        self.assertEqual([e["n"] for e in j.answered()], [3])

    def test_an_invalid_entry_is_not_written(self):
        j = self.opened()
        for entry in (trial(1), {"kind": "end"}):
            with self.assertRaisesRegex(ValueError, "begins with its session"):
                j.append(entry)
        with self.assertRaisesRegex(ValueError, "observer"):
            j.begin(**{**SESSION, "observer": "robot"})
        j.begin(**SESSION)
        before = self.path.read_bytes()
        for entry in ({"kind": "session", **SESSION}, {"kind": "trail"}, {}, {"kind": ["trial"]}, trial(1, level=float("nan")), trial(1, level=[1, 2, 3]), trial(1, yes="yes"),
                      trial(1, row=[]), trial(-1), trial(1.5), trial(1, condition=None), {k: v for k, v in trial(1).items() if k != "response"}, trial(1, n=7),
                      trial(1, level=True), trial(1, row={"level": float("inf")}), trial(1, response="\ud800")):
            with self.assertRaises(ValueError, msg=str(entry)):
                j.append(entry)
            self.assertEqual(self.path.read_bytes(), before)

    def test_a_session_is_resumed_only_with_the_same_parameters(self):
        self.written()
        with Journal(self.folder) as j:
            self.assertTrue(j.begin(**SESSION))
        for name, other in (("study_sha256", "01"), ("seed", 8), ("observer", "human"), ("participant", "P02")):
            with Journal(self.folder) as j, self.assertRaisesRegex(Refusal, f":1: {name} was .* and is"):
                j.begin(**{**SESSION, name: other})


class Damage(Folder):
    def test_a_journal_cut_at_any_byte_keeps_all_complete_lines(self):
        data = self.written(2)
        self.assertGreater(len(data), 500)
        for size in range(len(data)):
            self.path.write_bytes(data[:size])
            whole = data[:size].count(b"\n") + (data[size:size + 1] == b"\n")
            self.assertEqual(len(journal.read(self.folder)), whole)
            with Journal(self.folder) as j:
                self.assertEqual(len(j.entries), whole)
                self.assertEqual(bool(j.repaired), size > 0 and data[size - 1:size] != b"\n")
                if j.repaired:
                    self.assertIn(f"{self.path}:", j.repaired)
                lines = b"".join(data.splitlines(keepends=True)[:whole])
                self.assertEqual(self.path.read_bytes(), lines)
                j.begin(**SESSION)
                j.append({"kind": "note"})
            with Journal(self.folder) as j:
                self.assertEqual((j.repaired, j.entries[-1]["kind"]), ("", "note"))

    def test_any_other_damage_is_refused_with_its_line_and_the_file_left_as_it_is(self):
        data = self.written(2)
        dice = random.Random(4)
        for at in range(len(data) - 1):
            damaged = bytearray(data)
            damaged[at] ^= 1 << dice.randrange(8)
            self.path.write_bytes(damaged)
            self.refused(f"{self.path}:{data[:at].count(10) + 1}: ")
            self.assertEqual(self.path.read_bytes(), bytes(damaged))

    def test_lines_that_are_missing_doubled_or_swapped_are_refused(self):
        lines = self.written(3).splitlines(keepends=True)
        for changed, line in ((lines[:2] + lines[3:], 3), (lines[:3] + lines[2:], 4), ([lines[0], lines[2], lines[1], *lines[3:]], 2), (lines[1:], 1), ([b"\n", *lines], 1),
                              ([b"{}\n", *lines], 1), (lines + [b"\n"], len(lines) + 1), (lines + [b"\0" * 40 + b"\n"], len(lines) + 1)):
            self.path.write_bytes(b"".join(changed))
            self.refused(f"{self.path}:{line}: ")

    def test_zeros_at_the_end_after_a_crash_are_removed(self):
        data = self.written()
        self.path.write_bytes(data + b"\0" * 4096)
        with Journal(self.folder) as j:
            self.assertIn("incomplete", j.repaired)
        self.assertEqual(self.path.read_bytes(), data)

    def test_an_impossible_entry_with_a_valid_checksum_is_refused(self):
        first = {"n": 1, "time_utc": "t", "kind": "session", **SESSION}
        for entries, line in (([{**trial(1), "n": 1}], 1), ([first, {**trial(1), "n": 2, "missed": ""}, {**trial(1), "n": 3}], 3), ([first, {**first, "n": 2}], 2),
                              ([first, {"n": 2, "kind": "?"}], 2)):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self.path.write_bytes(b"".join(map(journal.line_of, entries)))
            self.refused(f"{self.path}:{line}: ")

    def test_a_deeply_nested_line_with_a_valid_checksum_is_refused(self):
        body = '{"n": 1, "kind": ' + "[" * 100_000 + "]" * 100_000 + "}"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_bytes(f'{body[:-1]}, "crc32": "{zlib.crc32(body.encode()):08x}"}}\n'.encode())
        self.refused(f"{self.path}:1: ")
        self.assertIsNone(bids_labels.first_entry(self.path))  # a session beside it begins all the same


class Processes(Folder):
    def writer(self, **more):
        text = WRITER.format(python=str(SCRIPTS / "python"), folder=str(self.folder), session=SESSION)
        return subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)

    def test_a_second_process_is_refused_with_the_folder(self):
        self.opened()
        self.refused(str(self.folder), "another process")

    def test_the_lock_ends_with_its_process(self):
        with self.writer() as process:
            process.stdout.readline()
            self.refused("another process")
            process.kill()
        with Journal(self.folder) as j:
            self.assertGreaterEqual(len(j.answered()), 1)

    def test_a_killed_process_leaves_every_acknowledged_trial(self):
        said = 0
        dice = random.Random(3)
        for _ in range(12):
            with self.writer() as process:
                for _ in range(dice.randint(1, 20)):
                    said = int(process.stdout.readline())
                process.send_signal(signal.SIGKILL)
                said = max([said, *map(int, process.stdout.read().split("\n")[:-1])])
            with Journal(self.folder) as j:
                numbers = [e["trial"] for e in j.answered()]
            self.assertEqual(numbers, list(range(1, len(numbers) + 1)))
            self.assertLessEqual(said, len(numbers))
            self.assertLessEqual(len(numbers), said + 1)

    def test_a_full_disk_is_reported_and_leaves_the_journal_intact(self):
        limit = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))\n"
        text = limit + WRITER.format(python=str(SCRIPTS / "python"), folder=str(self.folder), session=SESSION)
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=False)
        self.assertIn("cannot be written", done.stderr)
        self.assertIn("free space", done.stderr)
        with Journal(self.folder) as j:
            self.assertEqual((j.repaired, len(j.answered())), ("", len(done.stdout.split())))
            self.assertGreaterEqual(len(j.answered()), 2)

    def test_a_partially_written_line_is_removed(self):
        j = self.opened()
        j.begin(**SESSION)
        before, take = self.path.read_bytes(), j.file.write
        with mock.patch.object(j, "file", wraps=j.file) as file:
            file.write.side_effect = [take(b'{"n": 2, "time'), OSError(28, "No space left on device")]
            with self.assertRaisesRegex(Refusal, "No space left"):
                j.append(trial(1))
        self.assertEqual(self.path.read_bytes(), before)
        j.append(trial(1))
        self.assertEqual(journal.read(self.folder), j.entries)

    def test_a_folder_that_cannot_be_written_is_refused_in_one_sentence(self):
        self.folder.parent.mkdir(parents=True)
        self.folder.write_text("a file stands where the folder should be")
        self.refused(str(self.folder), "choose a writable folder")
        with self.assertRaisesRegex(Refusal, "give the folder of a participant"):
            journal.read(self.folder.parent)

    def test_a_reader_needs_no_lock(self):
        j = self.opened()
        j.begin(**SESSION)
        with open(self.path, "ab") as file:
            self.assertRaises(BlockingIOError, fcntl.flock, file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        with open(self.path, "ab") as file:
            file.write(b'{"n": 2, "ti')
        torn = self.path.read_bytes()
        self.assertEqual(journal.read(self.folder), j.entries)
        self.assertEqual(self.path.read_bytes(), torn, "a reader changes nothing")


def random_study(dice):
    """Text of a random study of a kind that asks trial by trial."""
    response = dice.choice(["synchrony", "order", "two_interval"])
    levels = " ".join(f"{x}ms" for x in sorted(dice.sample(range(5, 200, 5), dice.randint(2, 4))))
    one = (lambda: f'<factor modality="{dice.choice(["haptic", "audio"])}" operator="delay" levels="{levels}"/>') if response == "two_interval" else (
        lambda: f'<asynchrony between="{dice.choice(["audio visual", "haptic audio"])}" levels="{levels} -20ms"/>')
    found = list(dict.fromkeys(one() for _ in range(3)))
    procedure = dice.choice([f'<procedure kind="constant" repetitions="{dice.randint(1, 3)}"/>',
                             '<procedure kind="staircase" rule="1up2down" start="80ms" step="40ms" minimum_step="10ms" lowest="0ms" highest="200ms" reversals="4"/>',
                             '<procedure kind="quest_plus" function="cumulative_gaussian" trials="8"><prior parameter="threshold" from="10" to="150" count="8"/>'
                             '<prior parameter="sd" from="10" to="40" count="3"/><prior parameter="guess" from="0.1" to="0.1" count="1"/>'
                             '<prior parameter="lapse" from="0.02" to="0.02" count="1"/></procedure>'])
    return STUDY.format(task="press" if response == "two_interval" else "tap", seed=dice.randrange(1000), conditions="".join(found), procedure=procedure, response=response,
                        blocks=dice.randint(1, 3))


class Resuming(Folder):
    """A session that ends after any line of its journal resumes with the same trials."""

    def study(self, dice):
        file = self.folder.parent / "study.xml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(random_study(dice), encoding="utf-8")
        return study_file.read(str(file))

    def led(self, study, seed, journal_of=None):
        """Asks all remaining trials, some of them missed at first; [(number, condition, level, attempt)]. Answers depend on the trial
        alone, so that two runs can be compared."""
        plan, asked = Plan(study, "P03"), []
        if journal_of is not None:
            journal_of.begin(**SESSION)
            session.resume(plan, journal_of.answered())
        while (t := plan.next()) is not None:
            dice = random.Random(f"{seed} {t.number}")
            level = list(t.level) if isinstance(t.level, tuple) else t.level
            attempts, yes = dice.choice([1, 1, 1, 2]), dice.random() < 0.6
            done = 0 if journal_of is None else sum(e["kind"] == "trial" and e["trial"] == t.number for e in journal_of.entries)
            for attempt in range(done + 1, attempts + 1):
                asked.append((t.number, t.condition.id, level, attempt))
                if journal_of is not None:
                    journal_of.append(trial(t.number, missed="late" if attempt < attempts else "", yes=yes, level=level, condition=t.condition.id, attempt=attempt, block=t.block))
            plan.answered(t, yes)
        return asked

    def test_the_same_trials_remain_after_each_line(self):
        for seed in range(12):
            study = self.study(random.Random(seed))
            everything = self.led(study, seed)
            with Journal(self.folder) as j:
                self.assertEqual(self.led(study, seed, j), everything)
            data = self.path.read_bytes()
            ends = [i + 1 for i, byte in enumerate(data) if byte == 10]
            for lines, end in enumerate(ends if len(ends) < 40 else random.Random(seed).sample(ends, 40)):
                self.path.write_bytes(data[:end])
                with Journal(self.folder) as j:
                    entries = len(j.entries) - 1
                    self.assertEqual(self.led(study, seed, j), everything[entries:], f"study {seed}, after {entries} trials")
                    trials = [(e["trial"], e["condition"], e["level"], e["attempt"]) for e in j.entries[1:]]
                self.assertEqual(trials, everything)
            self.path.unlink()

    def test_a_journal_of_another_plan_is_refused(self):
        study = self.study(random.Random(2))
        with Journal(self.folder) as j:
            j.begin(**SESSION)
            j.append(trial(1, level=12345.0))
            with self.assertRaisesRegex(Refusal, "is not in this plan"):
                session.resume(Plan(study, "P03"), j.answered())


if __name__ == "__main__":
    unittest.main()
