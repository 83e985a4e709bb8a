"""tactus study sweep: games depend on their seeds only; after a kill at any moment no game is lost or played twice."""
import csv
import io
import json
import lzma
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.refusal import Refusal
from tactus.study import study_file, trial_table
from tactus.sweep import chunk_file, virtual_games
from tactus.sweep.sweep_folder import SweepFolder

STUDY = f"""<?xml version="1.0" encoding="UTF-8"?>
<study name="short" version="1" scene="{ROOT}/sim_node/scenes/dark_room_game.sdf" task="game" seed="3">
  <conditions>
    <nothing/><remove modality="audio"/>
    <factor modality="visual" operator="delay" levels="50ms 300ms"/>
    <pair><factor modality="audio" operator="delay" levels="100ms"/><factor modality="visual" operator="loss" levels="50%"/></pair>
  </conditions>
  <procedure kind="constant" repetitions="1"/>
  <response kind="performance"/>
  <stimulus by="participant" limit="1s"/>
</study>
"""


def sweep(*words, status=0):
    done = subprocess.run([str(ROOT / "scripts" / "tactus"), "study", "sweep", *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != status:
        raise AssertionError(f"status {done.returncode}: {done.stdout}{done.stderr}")
    return done


class Sweep(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.study = self.folder / "short.xml"
        self.study.write_text(STUDY, encoding="utf-8")

    def test_games_do_not_depend_on_the_number_of_jobs_and_their_rows_name_the_degradation(self):
        for jobs in (1, 3):
            sweep(self.study, "--games", 2, "--jobs", jobs, "--out", self.folder / str(jobs))
        one, three = ((self.folder / str(jobs) / "games.csv").read_bytes() for jobs in (1, 3))
        self.assertEqual(one, three)
        rows = trial_table.read(self.folder / "1" / "games.csv")
        self.assertEqual(len(rows), 10)
        self.assertEqual({r["observer"] for r in rows}, {"simulated"})
        self.assertEqual({(r["modality_degraded"], r["operator"], r["level"]) for r in rows},
                         {("", "", None), ("audio", "off", None), ("visual", "delay", 50), ("visual", "delay", 300), ("audio", "delay", 100)})
        self.assertEqual({(r["second_modality"], r["second_operator"], r["second_level"]) for r in rows}, {("", "", None), ("visual", "loss", 50)})
        self.assertTrue(all(r["missed"] == 0 and r["success"] == 0 and r["completion_time_s"] == 1 for r in rows), rows)  # 1 s is too short to win
        self.assertEqual(len({r["seed"] for r in rows}), 10)

    def test_a_folder_of_a_stranger_is_no_sweep_and_is_said_so_at_once(self):
        for kind, text in (("deep", "[" * 100_000), ("number", '{"games": 1e999, "study": "s"}'), ("list", "[]"), ("long", " " * 200_000 + "{}"), ("pipe", None),
                           ("no games", json.dumps({"games": 0, "study": str(self.study)})), ("no players", json.dumps({"games": 1, "study": str(self.study), "players": []})),
                           ("players", json.dumps({"games": 1, "study": str(self.study), "players": [{}] * 2049}))):
            folder = self.folder / kind
            folder.mkdir()
            if text is None:
                os.mkfifo(folder / "sweep.json")
            else:
                (folder / "sweep.json").write_text(text, encoding="utf-8")
            with self.assertRaisesRegex(Refusal, "holds no sweep to resume"):
                SweepFolder(folder)

    def test_a_sweep_killed_at_random_moments_resumes_without_lost_or_repeated_games(self):
        whole, killed = self.folder / "whole", self.folder / "killed"
        sweep(self.study, "--games", 4, "--jobs", 2, "--out", whole)
        random.seed(8)
        words, kills = [str(self.study), "--games", "4"], 0
        while True:
            process = subprocess.Popen([str(ROOT / "scripts" / "tactus"), "study", "sweep", *words, "--jobs", "2", "--out", str(killed)],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                process.wait(random.uniform(0.7, 2.5) if kills < 6 else None)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
            else:
                if process.returncode == 0:
                    break
            if (killed / "sweep.json").exists():
                words = ["--resume"]
        self.assertGreater(kills, 0)
        self.assertEqual((whole / "games.csv").read_bytes(), (killed / "games.csv").read_bytes())

    def test_a_game_with_an_incomplete_line_is_played_again(self):
        out = self.folder / "out"
        sweep(self.study, "--games", 1, "--jobs", 1, "--out", out)
        before = (out / "games.csv").read_bytes()
        chunk = out / "chunks" / "00001.csv"
        chunk.write_bytes(chunk.read_bytes()[:-7])
        sweep("--resume", "--out", out)
        self.assertEqual((out / "games.csv").read_bytes(), before)

    def test_a_study_is_copied_unchanged_and_one_in_another_encoding_is_refused(self):
        self.study.write_bytes(STUDY.replace("<conditions>", "<!-- Größe 大きさ -->\r\n<conditions>").encode())
        sweep(self.study, "--games", 1, "--out", self.folder / "out")
        self.assertEqual((self.folder / "out" / "study.xml").read_bytes(), self.study.read_bytes())
        self.study.write_bytes(STUDY.replace("UTF-8", "UTF-16").encode("utf-16"))
        done = sweep(self.study, "--games", 1, "--out", self.folder / "again", status=1)
        self.assertIn("is UTF-16 and not UTF-8; save it as UTF-8", done.stderr)

    def test_a_failed_game_is_marked_in_its_row(self):
        study = study_file.read(str(self.study))
        game = virtual_games.games_of(study, 1)[0][0]
        row = virtual_games.row(study, game, {"trouble": "the world does not begin", "said": "sim_node: no"})
        self.assertEqual((row["missed"], row["missed_reason"]), (1, "the world does not begin: sim_node: no"))
        self.assertIsNone(trial_table.wrong(row))

    def test_only_one_process_holds_a_chunk(self):
        held = chunk_file.ChunkFile(self.folder / "chunk.csv")
        with self.assertRaises(chunk_file.Busy):
            chunk_file.ChunkFile(self.folder / "chunk.csv")
        held.close()
        chunk_file.ChunkFile(self.folder / "chunk.csv").close()

    def test_a_larger_sweep_reuses_the_games_of_a_smaller_one_with_the_same_result(self):
        sweep(self.study, "--games", 3, "--jobs", 2, "--out", self.folder / "whole")
        sweep(self.study, "--games", 2, "--jobs", 2, "--out", self.folder / "small")
        small = self.folder / "small" / "games.csv"
        (self.folder / "small.csv.xz").write_bytes(lzma.compress(small.read_bytes()))
        for table in (small, self.folder / "small.csv.xz"):
            out = self.folder / f"from{table.suffix}"
            self.assertIn("10 games are reused from", sweep(self.study, "--games", 3, "--jobs", 2, "--from", table, "--out", out).stdout)
            self.assertEqual((self.folder / "whole" / "games.csv").read_bytes(), (out / "games.csv").read_bytes())

    def test_games_of_another_build_are_refused(self):
        sweep(self.study, "--games", 1, "--jobs", 1, "--out", self.folder / "small")
        table = self.folder / "small" / "games.csv"
        rows = list(csv.reader(io.StringIO(table.read_text(encoding="utf-8"), newline="")))
        rows[2][rows[0].index("path_m")] = "0.5"
        other = self.folder / "other.csv"
        with open(other, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
        self.assertIn("has another result", sweep(self.study, "--games", 2, "--from", other, "--out", self.folder / "mixed", status=1).stderr)
        other.with_suffix(".csv.xz").write_bytes(b"none")
        self.assertIn("holds no table", sweep(self.study, "--games", 2, "--from", other.with_suffix(".csv.xz"), "--out", self.folder / "none", status=1).stderr)

    def test_an_invalid_sweep_is_refused_with_one_sentence(self):
        other = self.folder / "other.xml"
        out = self.folder / "out"
        sweep(self.study, "--games", 1, "--jobs", 1, "--out", out)
        for words in ([self.study, "--out", out], [self.study, "--games", 0, "--out", out], [self.study, "--games", 1, "--out", out],
                      ["--resume", "--out", other], ["--resume", "--games", 3, "--out", out], ["audio_visual_synchrony", "--games", 1, "--out", other],
                      [self.study, "--games", 1, "--slurm", "--jobs", 2, "--out", other], [self.study, "--games", 1, "--partition", "a", "--out", other]):
            done = sweep(*words, status=1)
            self.assertEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)


if __name__ == "__main__":
    sys.exit(unittest.main())
