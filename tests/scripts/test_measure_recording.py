#!/usr/bin/env python3
"""tests/measure/measure_recording counts what is lost, and by whom: against logs and tables of which it is known."""
import importlib.machinery
import importlib.util
import pathlib
import random
import struct
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "measure" / "measure_recording"
sys.path.insert(0, str(SCRIPT.parent))
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("measure_recording", str(SCRIPT))
measure_recording = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure_recording", loader))
loader.exec_module(measure_recording)


def event(number, channel, data):
    return struct.pack(">IqqII", measure_recording.SYNC, number, 1000 + number, len(channel), len(data)) + channel.encode() + data


def message(source, incarnation, seq, run=7):
    """As lcmtypes/types/status/header_t.lcm has it, behind the hash of the type."""
    return struct.pack(">qqqiqiqq", 1, 0, 0, 4711, run, source, incarnation, seq)


class Logs(unittest.TestCase):
    def log(self, *events):
        file = tempfile.NamedTemporaryFile(suffix=".lcmlog")
        self.addCleanup(file.close)
        file.write(b"".join(event(i, *e) for i, e in enumerate(events)))
        file.flush()
        return file.name

    def test_gaps_in_the_sequence_numbers_of_each_sender_are_counted(self):
        drawn = random.Random(3)
        kept, expected = [], {}
        for source in (5, 6):
            numbers = sorted(drawn.sample(range(1000), 700))
            expected["A", source, 1] = set(numbers)
            kept += [("A", message(source, 1, n)) for n in numbers]
        drawn.shuffle(kept)
        recorded, seen = measure_recording.numbered(self.log(*kept))
        self.assertEqual(recorded, 1400)
        self.assertEqual(dict(seen), expected)

    def test_repeated_messages_count_once_and_foreign_ones_never(self):
        recorded, _ = measure_recording.numbered(self.log(("A", message(5, 1, 3)), ("A", message(5, 1, 3)), ("B", b"letter"),
                                                          ("C", message(5, 1, 0, run=0))))
        self.assertEqual(recorded, 1)

    def test_a_truncated_log_is_read_to_its_last_complete_event(self):
        path = self.log(("A", b"1" * 100), ("B", b"2" * 100))
        whole = pathlib.Path(path).read_bytes()
        for length in range(len(whole)):
            with tempfile.NamedTemporaryFile() as cut:
                cut.write(whole[:length])
                cut.flush()
                self.assertEqual(len(list(measure_recording.events(cut.name))), 1 if length >= len(whole) // 2 else 0)


class Drops(unittest.TestCase):
    TABLE = "\n".join(["  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref pointer drops",
                       "   10: 00000000:1DF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 111 2 0000000000000000 42",
                       "   11: 00000000:1DF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 222 2 0000000000000000 7",
                       "   12: 00000000:1DF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 333 2 0000000000000000 9"])

    def test_drops_of_a_socket_count_once_for_its_process(self):
        text = self.TABLE + "\nprocess recorder\nlrwx 1 0 0 3 -> socket:[111]\nlrwx 1 0 0 4 -> socket:[111]\n" \
            "process lcm-logger\nlrwx 1 0 0 3 -> socket:[222]\nlrwx 1 0 0 4 -> socket:[333]\nlrwx 1 0 0 5 -> socket:[999]\n"
        looked = measure_recording.drops(text)
        self.assertEqual(looked["recorder"], 42)
        self.assertEqual(looked["lcm-logger"], 16)
        self.assertEqual(looked["somebody"], 0)


if __name__ == "__main__":
    unittest.main()
