"""How measure_motion reads ages out of what frames name, where the truth is made up."""
import importlib.machinery
import importlib.util
import os
import sys
import unittest

PATH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "measure", "measure_motion")
sys.path.insert(0, os.path.dirname(PATH))
loader = importlib.machinery.SourceFileLoader("measure_motion", PATH)
measure_motion = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure_motion", loader))
loader.exec_module(measure_motion)

MS = 1_000_000


class Ages(unittest.TestCase):
    # Tool 0 reports each ms from 0 on, report n at n ms; frames are seen at 20, 40, 60 ms.
    sent = {0: {n: n * MS for n in range(100)}}
    fences = {0: 20 * MS, 1: 40 * MS, 2: 60 * MS}

    def test_the_age_of_a_frame_is_that_of_its_newest_report_at_the_fence(self):
        newest, _ = measure_motion.ages({0: {0: 12}, 1: {0: 35}, 2: {0: 57}}, self.sent, self.fences)
        self.assertEqual([8, 5, 3], newest)

    def test_every_report_waits_for_the_first_frame_that_shows_it_or_a_later_one(self):
        _, each = measure_motion.ages({0: {0: 12}, 1: {0: 14}}, self.sent, self.fences)
        self.assertEqual([40 - 13, 40 - 14], each)

    def test_a_repeated_frame_is_older_and_each_report_counts_once(self):
        newest, each = measure_motion.ages({0: {0: 12}, 1: {0: 13}, 2: {0: 13}}, self.sent, self.fences)
        self.assertEqual([8, 27, 47], newest)
        self.assertEqual([27], each)

    def test_the_low_bits_of_a_number_are_drawn(self):
        high = 5 << 28
        sent = {1: {high + n: n * MS for n in range(100)}}
        newest, _ = measure_motion.ages({0: {1: 12}}, sent, self.fences)
        self.assertEqual([8], newest)

    def test_frames_without_a_clock_and_unsent_reports_are_ignored(self):
        self.assertEqual(([], []), measure_motion.ages({7: {0: 12}, 0: {0: 1000}, 1: {3: 1}}, self.sent, self.fences))


if __name__ == "__main__":
    unittest.main()
