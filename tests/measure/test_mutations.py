"""Tests of the mutators and of the judge of measure_mutations, and a short campaign.

TACTUS_BIN: the folder of the programs.
"""
import pathlib
import random
import struct
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as ET

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import common  # noqa: F401  makes the package tactus importable
from mutations import campaign, logs, meshes, oracle, worlds

SEED, COUNT = 20, 45  # one input of each kind


def answer(status=1, *lines):
    return types.SimpleNamespace(name="sim_node", status=status, lines=list(lines), last=lambda: lines[-1] if lines else "no output")


class Mutators(unittest.TestCase):
    def test_every_kind_changes_every_scene_or_says_that_it_cannot_and_one_seed_gives_the_same_bytes(self):
        for name in campaign.WORLDS:
            text = (campaign.SCENES / name).read_bytes()
            plain = ET.tostring(ET.fromstring(text), encoding="utf-8", xml_declaration=True)
            for kind in worlds.KINDS:
                changed = [campaign.Campaign.changed(worlds.mutated, text, kind, random.Random(7)) for _ in range(2)]
                self.assertEqual(*changed, (name, kind))
                if kind not in ("swapped axes", "bytes"):  # equal numbers, or the same byte
                    self.assertNotEqual(plain, changed[0], (name, kind))

    def test_every_kind_changes_a_mesh_of_every_format(self):
        for form in meshes.FORMATS:
            valid = {meshes.written(*shape(), form) for shape in meshes.SHAPES}
            for kind in meshes.KINDS:
                changed = [meshes.mutated(kind, form, random.Random(3)) for _ in range(2)]
                self.assertEqual(*changed, (form, kind))
                if kind not in ("swapped axes", "bytes", "empty"):
                    self.assertNotIn(changed[0], valid, (form, kind))

    def test_every_kind_changes_a_log(self):
        events = [(i * 1000, b"TOOL_STATE" if i % 2 else b"CONTACTS", struct.pack(">q", i) * 12) for i in range(200)]
        data = logs.written(events)
        self.assertEqual(events, logs.events_of(data))
        for kind in logs.KINDS:
            changed = [logs.mutated(data, kind, random.Random(5)) for _ in range(2)]
            self.assertEqual(*changed, kind)
            if kind != "bytes":
                self.assertNotEqual(data, changed[0], kind)


class Judge(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_refusal_is_one_sentence_that_names_a_file(self):
        self.assertEqual([], oracle.refusal_faults(answer(1, "sim_node: a.sdf:3: <box> lacks its size; write it"), "a.sdf"))
        self.assertIn("silence", oracle.refusal_faults(answer(1), "a.sdf")[-1])
        self.assertIn("does not name the file", oracle.refusal_faults(answer(1, "sim_node: this is wrong; correct it"), "a.sdf")[-1])
        self.assertIn("status 3", oracle.refusal_faults(answer(3, "sim_node: a.sdf: it is wrong; correct it"), "a.sdf")[0])

    def test_words_of_a_library_and_signals_are_violations(self):
        self.assertIn("signal 6", oracle.Answer(["/bin/sh", "-c", "kill -ABRT $$"]).crashes()[0])
        self.assertIn("library", oracle.Answer(["/bin/sh", "-c", "echo 'terminate called after throwing' >&2"]).raw_words()[0])
        self.assertEqual([], oracle.Answer(["/bin/sh", "-c", "exit 1"]).crashes())

    def test_a_number_that_is_not_finite_is_found_in_tables_and_a_text_is_none(self):
        table = self.folder / "t.csv"
        table.write_text("log_s,field,unit,value,run\n1,x.y,m,nan,1\n", encoding="utf-8")
        self.assertEqual(1, len(oracle.table_faults(self.folder)))
        table.write_text("log_s,field,unit,value,run\n1,name,,nan,1\n1,x.y,m,2,1\n", encoding="utf-8")  # a body called nan
        self.assertEqual([], oracle.table_faults(self.folder))

    def test_bytes_that_belong_to_no_event_must_be_reported(self):
        log = self.folder / "a.lcmlog"
        log.write_bytes(logs.written([(1, b"A", b"xyz")]) + b"rest")
        self.assertEqual(1, len(oracle.silent_damage(log, {"damaged_regions": 0, "warnings": []})))
        self.assertEqual([], oracle.silent_damage(log, {"damaged_regions": 1, "warnings": []}))
        log.write_bytes(logs.written([(1, b"A", b"xyz")]))
        self.assertEqual([], oracle.silent_damage(log, {"damaged_regions": 0, "warnings": []}))

    def test_a_sample_that_is_not_finite_is_found(self):
        wav = self.folder / "a.wav"
        for sample, faults in ((0.5, 0), (float("nan"), 1)):
            wav.write_bytes(b"RIFF....WAVEdata" + struct.pack("<I2f", 8, 0.1, sample))
            self.assertEqual(faults, len(oracle.sound_faults(wav)))


class ShortCampaign(unittest.TestCase):
    def test_changed_worlds_meshes_and_logs_cause_no_crash_no_nan_and_no_silence(self):
        print(f"seed {SEED}", file=sys.stderr)
        played = campaign.Campaign(SEED)
        for case in campaign.plan(COUNT):
            with self.subTest(f"seed {SEED}, number {case.number}: {case.family}, {case.kind}"):
                self.assertEqual((), tuple(played.play(case).faults), case.source)


if __name__ == "__main__":
    unittest.main()
