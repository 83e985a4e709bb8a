"""Tests of tables of an earlier sweep: a compressed one neither fills the memory nor ends the sweep with a trace."""
import lzma
import pathlib
import resource
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.refusal import Refusal
from tactus.study import trial_table
from tactus.sweep import adopted

ROW = {"participant_id": "sim", "task": "game", "observer": "simulated", "condition": "=c", "seed": 5, "trial": 1}


class Adopted(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.path = pathlib.Path(kept.name) / "games.csv.xz"

    def refused(self, data, said):
        self.path.write_bytes(data)
        with self.assertRaises(Refusal) as caught:
            adopted.read(self.path)
        self.assertIn(said, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_a_compressed_table_is_read(self):
        self.path.write_bytes(lzma.compress(trial_table.text([ROW]).encode()))
        self.assertEqual(5, adopted.read(self.path)[ROW["participant_id"], "=c", 5]["seed"])

    def test_a_small_file_that_expands_without_end_is_refused_at_the_limit(self):
        self.addCleanup(setattr, trial_table, "LARGEST_BYTES", trial_table.LARGEST_BYTES)
        trial_table.LARGEST_BYTES = 4 << 20
        compressor = lzma.LZMACompressor(preset=0)
        bomb = b"".join(compressor.compress(bytes(1 << 20)) for _ in range(200)) + compressor.flush()
        self.assertLess(len(bomb), 50_000)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.refused(bomb, "is longer than 4194304 bytes")
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 150_000)  # kB; the table itself has 200 MB

    def test_damaged_files_and_other_files_are_one_sentence(self):
        whole = lzma.compress(trial_table.text([ROW]).encode())
        for data in (b"", b"no archive", whole[:-20], whole[:30] + b"x" + whole[31:], lzma.compress(b"a,b\r\n1,2\r\n"), lzma.compress(b"\xff")):
            self.refused(data, str(self.path))

    def test_a_decompressor_that_needs_much_memory_is_refused(self):
        self.addCleanup(setattr, adopted, "DECOMPRESSOR_BYTES", adopted.DECOMPRESSOR_BYTES)
        adopted.DECOMPRESSOR_BYTES = 1 << 20
        self.refused(lzma.compress(b"x", preset=6), "holds no table of games")


if __name__ == "__main__":
    unittest.main()
