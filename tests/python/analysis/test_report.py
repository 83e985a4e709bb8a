#!/usr/bin/env python3
"""`study analyse`: one page without outside references, every figure as SVG and PNG, tables that name the observer, and the same bytes each time."""
import csv
import json
import pathlib
import re
import subprocess
import tempfile
import unittest

import analysis_tables
import numpy as np
from analysis_tables import ROOT, game, games, judgements

TACTUS = ROOT / "scripts" / "tactus"
PNG = b"\x89PNG\r\n\x1a\n"
HOSTILE = 'dark<script>alert(1)</script>"&'


def study(rng):
    """A small study of everything: judgements, matches, games with levels, pairs and removals."""
    rows = [r for i in range(3) for r in judgements(rng, 10, 60, 0.02, np.arange(-160, 161, 40), 8, f"P{i:02}")]
    for i in range(3):
        for x in (0, 40, 120):
            for _ in range(4):
                rows.append({"study": "stiffness", "participant_id": f"P{i:02}", "task": "matching", "observer": "simulated", "trial": len(rows) + 1, "question": "stiffness",
                             "modality_degraded": "haptic", "operator": "delay", "level": x, "unit": "ms", "answer_value": 200 * (1 - 0.003 * x) + rng.normal(0, 10)})
    for i in range(60):
        level, degraded = (10.0, 20.0, 40.0)[i % 3], 1 + i // 3 % 2
        felt = [40 * (1 - 0.01 * level * (k == degraded)) for k in (1, 2)]
        rows.append({"study": "pressed", "participant_id": "P00", "task": "2ifc", "observer": "simulated", "trial": len(rows) + 1, "modality_degraded": "haptic", "operator": "delay",
                     "level": level, "unit": "ms", "degraded_interval": degraded, "stiffness_first_n_m": felt[0], "stiffness_second_n_m": felt[1],
                     "response": ("first", "second")[degraded - 1], "correct": int(rng.random() < 0.5 + 0.0125 * level)})
    for condition, share, mean in (((), 0.95, 8), ((("visual", "delay", 50, "ms"),), 0.9, 9), ((("visual", "delay", 200, "ms"),), 0.6, 14), ((("haptic", "delay", 20, "ms"),), 0.9, 9),
                                   ((("haptic", "delay", 20, "ms"), ("visual", "delay", 50, "ms")), 0.8, 10),
                                   ((("haptic", "delay", 20, "ms"), ("visual", "delay", 200, "ms")), 0.4, 17), ((("audio", "off", "", ""),), 0.9, 9),
                                   ((("haptic", "off", "", ""),), 0.0, 20), ((("visual", "rate", 30, "Hz"),), 0.9, 9), ((("visual", "rate", 5, "Hz"),), 0.5, 15)):
        rows += games(rng, 40, list(condition), share, mean, first=len(rows) + 1, study=HOSTILE, participant="player")
    return rows


class Whole(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(kept.cleanup)
        cls.root = pathlib.Path(kept.name)
        rows = study(np.random.default_rng(1))
        rows[3]["missed"] = 1
        analysis_tables.write(cls.root / "trials.csv", rows)
        cls.done = cls.call("--out", cls.root / "a", "--json", cls.root / "a.json")
        cls.page = (cls.root / "a" / "report.html").read_text(encoding="utf-8") if not cls.done.returncode else ""

    @classmethod
    def call(cls, *words, place=None):
        return subprocess.run(["/usr/bin/python3", "-I", "-W", "error", TACTUS, "study", "analyse", place or cls.root / "trials.csv", *words], capture_output=True, text=True, check=False)

    def test_it_succeeds_and_lists_its_results(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        for word in ("L_detect", "L_appear", "L_break", "1 left out", "observer = simulated", "report.html"):
            self.assertIn(word, self.done.stdout)

    def test_the_page_is_self_contained(self):
        for reference in re.findall(r"""(?:src|href|url)\s*[=(]\s*["']?([^"')\s>]*)""", self.page):
            self.assertRegex(reference, r"^(#|data:image/svg\+xml;base64,)")
        self.assertNotIn("<script", self.page)
        self.assertNotIn("<link", self.page)

    def test_senses_degraded_only_together_have_a_map_and_no_frontier(self):
        rng, pair = np.random.default_rng(1), [("haptic", "delay", 20, "ms"), ("visual", "delay", 50, "ms")]
        place = self.root / "together.csv"
        rows = games(rng, 6, [], 1, 8, first=1)
        analysis_tables.write(place, rows + games(rng, 6, pair, 0.5, 14, first=len(rows) + 1))
        done = self.call("--out", self.root / "together", place=place)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual({p.stem for p in (self.root / "together" / "figures").iterdir()}, {"frontier_map_haptic_delay_visual_delay"})

    def test_every_figure_exists_as_svg_and_png(self):
        named = re.findall(r'<figure id="([^"]+)">', self.page)
        self.assertEqual(len(named), len(set(named)))
        wanted = {"curve_audio_visual_sj", "participants_audio_visual_sj", "achieved_audio_visual_sj", "levels_audio_visual_sj", "felt_stiffness_haptic_delay", "felt_stiffness_haptic_delay_2", "games_visual_delay",
                  "games_visual_rate", "removal", "frontier_map_haptic_delay_visual_delay", "frontier_haptic_delay_visual_delay", "ratio_break_detect", "limits_visual_delay"}
        self.assertLessEqual(wanted, set(named))
        folder = self.root / "a" / "figures"
        self.assertEqual({p.name for p in folder.iterdir()}, {n + end for n in named for end in (".svg", ".png")})
        for name in named:
            self.assertTrue((folder / f"{name}.png").read_bytes().startswith(PNG))
            self.assertTrue((folder / f"{name}.svg").read_bytes().rstrip().endswith(b"</svg>"))

    def test_simulated_results_are_marked_everywhere(self):
        captions = re.findall(r"<(?:figcaption|caption)>(.*?)</(?:figcaption|caption)>", self.page)
        self.assertGreater(len(captions), 12)
        for caption in captions:
            self.assertIn("observer = simulated", caption)
        for table in (self.root / "a").glob("*.csv"):
            with open(table, newline="", encoding="utf-8") as file:
                self.assertEqual({row["observer"] for row in csv.DictReader(file)}, {"simulated"}, table.name)

    def test_the_same_input_and_seed_give_the_same_bytes(self):
        self.call("--out", self.root / "b", "--json", self.root / "b.json")
        files = sorted(p.relative_to(self.root / "a") for p in (self.root / "a").rglob("*") if p.is_file())
        self.assertGreater(len(files), 25)
        for file in files:
            self.assertEqual((self.root / "a" / file).read_bytes(), (self.root / "b" / file).read_bytes(), file)
        self.assertEqual((self.root / "a.json").read_bytes(), (self.root / "b.json").read_bytes())

    def test_json_holds_the_tables_and_neither_nan_nor_infinity(self):
        def refuse(word):
            raise AssertionError(word)
        found = json.loads((self.root / "a.json").read_text(), parse_constant=refuse)
        self.assertEqual(found["left_out"], 1)
        self.assertEqual({r["limit"] for r in found["limits"]}, {"L_detect", "L_appear", "L_break"})
        with open(self.root / "a" / "limits.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), len(found["limits"]))

    def test_published_thresholds_are_shown_with_their_sources(self):
        for source in ("Vogels 2004", "Jones and Hunter 1990"):
            self.assertIn(source, self.page)

    def test_measured_and_judged_stiffness_are_separate(self):
        with open(self.root / "a" / "felt.csv", newline="", encoding="utf-8") as file:
            measured = [float(r["shift"]) for r in csv.DictReader(file) if r["by"] == "measured"]
        np.testing.assert_allclose(measured, [-0.1, -0.2, -0.4], atol=1e-5)  # each stiffness has six digits
        self.assertIn("Measured stiffness under touch: delay", self.page)
        self.assertIn("Felt stiffness under touch: delay", self.page)
        self.assertIn("stiffness, measured", (self.root / "a" / "limits.csv").read_text())

    def test_texts_stay_texts(self):
        self.assertIn("dark&lt;script&gt;", self.page)

    def test_senses_of_any_name_are_drawn_and_write_inside_the_folder(self):
        rows = judgements(np.random.default_rng(1), 10, 60, 0.02, np.arange(-200, 201, 40), 5, pair=("../../$\\frac{", "<b>x</b>"))
        done = self.call("--out", self.root / "odd", place=analysis_tables.write(self.root / "odd.csv", rows))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertNotIn("<b>x</b>", (self.root / "odd" / "report.html").read_text(encoding="utf-8"))
        self.assertFalse([p for p in self.root.glob("**/*frac*") if p.parent != self.root / "odd" / "figures"])

    def test_input_that_cannot_be_analysed_is_refused_with_one_sentence(self):
        empty = analysis_tables.write(self.root / "free.csv", [{"participant_id": "P01", "task": "free", "observer": "human", "trial": 1}])
        lost = analysis_tables.write(self.root / "lost.csv", [game(1, True, 5), game(2, False, 0, limit_s=float("nan"))])
        for words, place, reason in ((("--seed", "x"), None, "invalid int value"), (("--alpha", "3"), None, "--alpha 3"), (("--nonsense",), None, "--nonsense"), ((), self.root / "no", "does not exist"),
                                     ((), empty, "holds no judgements"), ((), lost, "--time-limit")):
            done = self.call("--out", self.root / "c", *words, place=place)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(reason, done.stderr)

    def test_help_lists_options_and_tables(self):
        done = self.call("--help")
        self.assertEqual(done.returncode, 0)
        for word in ("--seed", "--margin-time", "--time-limit", "limits.csv"):
            self.assertIn(word, done.stdout)


if __name__ == "__main__":
    unittest.main()
