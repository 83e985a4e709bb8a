"""The remaining time of a sweep follows from the games that remain and the measured times of their conditions, for any order of the chunks."""
import pathlib
import random
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.sweep import chunk_file, progress
from tactus.sweep.progress import Chunk


def played(durations, workers):
    """End of chunks of games with these durations, each played by the first free worker, in order."""
    free = [0.0] * workers
    for chunk in durations:
        first = min(range(workers), key=free.__getitem__)
        free[first] += sum(chunk)
    return max(free)


class Progress(unittest.TestCase):
    def test_a_long_condition_at_the_end_counts_with_its_own_times(self):
        # Of 4 conditions of 100 games, three take 0.1 s a game and the last one 1 s. All but the last have been played: a share of games would promise 10 s.
        chunks = [Chunk(c, 0, [0.1] * 100) for c in "abc"] + [Chunk("d", 98, [1.0, 1.0])]
        self.assertAlmostEqual(98, progress.remaining(chunks, 2).seconds)

    def test_the_remaining_time_is_right_for_random_sweeps(self):
        draw = random.Random(5)
        for _ in range(200):
            workers = draw.randint(1, 8)
            each = {f"c{i}": draw.uniform(0.05, 2) for i in range(draw.randint(1, 12))}
            left = [(condition, draw.randint(1, 50)) for condition in each for _ in range(draw.randint(1, 4))]
            chunks = [Chunk(condition, n, []) for condition, n in left] + [Chunk(condition, 0, [s]) for condition, s in each.items()]
            expected = played([[each[condition]] * n for condition, n in left], workers)
            result = progress.remaining(chunks, workers)
            self.assertAlmostEqual(expected, result.seconds)
            self.assertEqual(0, result.unmeasured)

    def test_a_condition_without_a_game_is_counted_like_the_mean_of_the_others_and_said_so(self):
        chunks = [Chunk("a", 0, [1.0] * 9), Chunk("b", 0, [3.0]), Chunk("c", 10, []), Chunk("d", 5, [])]
        left = progress.remaining(chunks, 1)
        self.assertEqual((30, 2), (left.seconds, left.unmeasured))  # the mean of the conditions is 2 s, for any numbers of games
        self.assertEqual("sweep: 10 of 25 games, 2.00 a second, 30 s left if the 2 conditions without a game yet are like the others",
                         progress.sentence(10, 25, 2, left))

    def test_before_the_first_game_no_time_is_promised(self):
        self.assertIsNone(progress.remaining([Chunk("a", 5, [])], 2))
        self.assertEqual("sweep: 0 of 5 games, 0.00 a second", progress.sentence(0, 5, 0, None))

    def test_the_times_of_a_chunk_are_kept_beside_its_rows_and_an_unfinished_line_is_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "00001.csv"
            self.assertEqual([], chunk_file.times(path))
            chunk_file.times_file(path).write_text("0.25\n1.5\n0.", encoding="utf-8")
            self.assertEqual([0.25, 1.5], chunk_file.times(path))


if __name__ == "__main__":
    unittest.main()
