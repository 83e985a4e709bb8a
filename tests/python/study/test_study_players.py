"""The simulated players of a study: their names, their checks, and their place in every table and report."""
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus import players
from tactus.analysis import trials
from tactus.refusal import Refusal
from tactus.study import games, study_file, trial_table
from tactus.sweep import main as sweep_main
from tactus.sweep import verdicts, virtual_games
from tactus.sweep.sweep_folder import SweepFolder

STUDY = f"""<?xml version="1.0" encoding="UTF-8"?>
<study name="who" version="1" scene="{ROOT}/sim_node/scenes/dark_room.sdf" task="game" seed="3">
  <conditions><nothing/><factor modality="visual" operator="delay" levels="100ms 300ms"/></conditions>
  <procedure kind="constant" repetitions="1"/>
  <response kind="performance"/>
  <stimulus by="participant" limit="30s"/>
  PLAYERS
</study>
"""
RESULT = {"won": True, "time_s": 12.5, "wrong": 0, "peak_force_N": 3.0, "path_m": 1.5}


class Players(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def study(self, elements, **change):
        text = STUDY.replace("PLAYERS", elements)
        for old, new in change.items():
            text = text.replace(*new) if isinstance(new, tuple) else text.replace(old, new)
        path = self.folder / "who.xml"
        path.write_text(text, encoding="utf-8")
        return study_file.read(str(path))

    def test_a_study_without_a_player_has_the_player_of_fixed_rules(self):
        study = self.study("")
        self.assertEqual(study.players, (players.Player("stage_model"),))
        game = virtual_games.games_of(study, 1, study.players)[0][0]
        self.assertEqual(set(virtual_games.request(study, game)), {"game", "seed", "limit_s", "profile"})
        row = virtual_games.row(study, game, RESULT)
        self.assertEqual((row["participant_id"], row["player"], row["failed_checks"]), ("player", "stage_model", ""))

    def test_a_study_names_players_of_a_population_and_every_one_plays_every_condition(self):
        study = self.study('<player name="observer" numbers="0-2 7" population="5" practice="20" checks="count"/><player name="stage_model"/>')
        self.assertEqual([p.name for p in study.players], ["observer:0", "observer:1", "observer:2", "observer:7", "stage_model"])
        self.assertEqual(study.checks, "count")
        chunks = virtual_games.games_of(study, 2, study.players)
        plays = [(g.player.name, g.condition.id) for chunk in chunks for g in chunk]
        self.assertEqual(len(plays), 2 * 5 * 3)
        self.assertEqual(len(set(plays)), 5 * 3)
        self.assertEqual([g.number for chunk in chunks for g in chunk], list(range(1, 31)))
        request = virtual_games.request(study, chunks[0][0])
        self.assertEqual((request["player"], request["population"], request["practice"], request["checks"]), ("observer:0", 5, 20, "skip"))
        row = virtual_games.row(study, chunks[0][0], RESULT)
        self.assertEqual(row["player"], "observer:0 of population 5, 20 actions of practice")
        self.assertIsNone(trial_table.wrong(row))

    def test_players_of_a_population_start_differently_and_with_common_starts_alike_in_all_conditions(self):
        for starts, seeds in (("own", 12), ("common", 4)):
            study = self.study('<player name="observer" numbers="0-3"/>', limit=('limit="30s"', f'limit="30s" starts="{starts}"'))
            found = {g.seed(study) for chunk in virtual_games.games_of(study, 1, study.players) for g in chunk}
            self.assertEqual(len(found), seeds)

    def test_wrong_players_are_refused_with_the_line(self):
        for elements in ('<player name="observer" numbers="3-1"/>', '<player name="observer" numbers="a"/>', '<player name="observer" numbers="1 1"/>',
                         '<player name="observer" numbers="0-4000"/>', '<player name="stage_model" numbers="1"/>', '<player name="stage_model" practice="3"/>',
                         '<player name="observer"/><player name="observer"/>', '<player name="robot"/>', '<player name="observer" checks="maybe"/>',
                         '<player name="observer" numbers="1" checks="count"/><player name="observer" numbers="2" checks="require"/>'):
            with self.assertRaisesRegex(Refusal, r"who\.xml:7: "):
                self.study(elements)
        tap = STUDY.replace('task="game"', 'task="tap"').replace("<nothing/>", '<asynchrony between="audio visual" levels="0ms"/>').replace(
            '<factor modality="visual" operator="delay" levels="100ms 300ms"/>', "").replace("performance", "synchrony")
        (self.folder / "tap.xml").write_text(tap.replace("PLAYERS", '<player name="observer"/>'), encoding="utf-8")
        with self.assertRaisesRegex(Refusal, "plays games"):
            study_file.read(str(self.folder / "tap.xml"))

    def test_a_number_that_no_player_has_is_one_sentence(self):
        for number in ("4294967296", "9" * 5000, "-1", "\u0661", "1_0", " 1", ""):
            self.assertFalse(players.is_player(f"observer:{number}"), number[:20])
            if number.strip() not in ("", "1"):
                with self.assertRaisesRegex(ValueError, "is no number of a player"):
                    players.numbers_of(f"0 {number}")
        self.assertTrue(players.is_player("observer:4294967295"))

    def checked(self, rule, failing):
        with mock.patch.object(players, "failing", side_effect=lambda player, first_only=False: failing.get(player.number, ())[:1 if first_only else None]):
            return players.checked(players.several("observer", "0-3", 1, 0), rule, self.said.append)

    def test_a_player_that_fails_a_check_is_refused_left_out_or_counted_and_named(self):
        self.said = []
        with self.assertRaisesRegex(Refusal, "observer:2 of population 1 fails check 2 and is not asked"):
            self.checked("require", {2: (2, 3)})
        self.assertEqual([p.number for p in self.checked("leave_out", {2: (2, 3)})], [0, 1, 3])
        self.assertIn("1 of 4 players fail a check and are not asked: observer:2: 2", self.said)
        counted = self.checked("count", {2: (2, 3)})
        self.assertEqual([p.verdict() for p in counted], ["none", "none", "2 3", "none"])
        with self.assertRaisesRegex(Refusal, "no player is left"):
            self.checked("leave_out", dict.fromkeys(range(4), (1,)))
        self.assertEqual(players.named([players.Player(f"observer:{n}", failed=(3,)) for n in range(22)]).count("observer"), 20)
        self.assertTrue(players.named([players.Player(f"observer:{n}", failed=(3,)) for n in range(22)]).endswith("observer:19: 3; and 2 more"))

    def test_the_first_player_that_fails_ends_the_checks_of_the_others(self):
        asked = []
        def failing(player, first_only):
            asked.append(player.number)
            return (2,) if player.number == 3 else ()
        pool = mock.MagicMock()
        pool.return_value.__enter__.return_value.map = map  # in order and only as far as the results are taken
        with mock.patch.object(players, "failing", side_effect=failing), mock.patch("concurrent.futures.ThreadPoolExecutor", pool):
            with self.assertRaisesRegex(Refusal, "observer:3 "):
                players.checked(players.several("observer", "0-999", 1, 0), "require")
        self.assertEqual(asked, [0, 1, 2, 3])
        shutdown = pool.return_value.__enter__.return_value.shutdown
        self.assertTrue(shutdown.call_args.kwargs["cancel_futures"])
        shutdown.reset_mock()
        with mock.patch.object(players, "failing", side_effect=KeyboardInterrupt), mock.patch("concurrent.futures.ThreadPoolExecutor", pool):
            with self.assertRaises(KeyboardInterrupt):
                players.checked(players.several("observer", "0-999", 1, 0), "leave_out")
        self.assertTrue(shutdown.call_args.kwargs["cancel_futures"])

    def test_progress_is_reported_after_each_twentieth_player(self):
        said = []
        with mock.patch.object(players, "failing", return_value=()):
            players.checked(players.several("observer", "0-44", 1, 0), "leave_out", said.append)
        self.assertEqual(said[1:], ["20 of 45 players are checked", "40 of 45 players are checked"])

    def test_known_verdicts_are_not_asked_again(self):
        with mock.patch.object(players, "failing", return_value=()) as failing:
            found = players.checked(players.several("observer", "0-3", 1, 0), "leave_out", known={(1, 0): (), (1, 2): (3,), (2, 3): (3,)})
        self.assertEqual([p.number for p in found], [0, 1, 3])
        self.assertEqual(sorted(call.args[0].number for call in failing.call_args_list), [1, 3])

    def test_the_typical_person_and_the_player_of_fixed_rules_have_no_checks_to_run(self):
        with mock.patch.object(players, "failing", side_effect=AssertionError):
            found = players.checked([players.Player("observer"), players.Player()], "require")
        self.assertEqual([p.verdict() for p in found], ["", ""])

    def test_the_command_line_of_a_sweep_chooses_the_players(self):
        study = self.study('<player name="observer" numbers="0-7" checks="leave_out"/>')
        with mock.patch.object(players, "failing", return_value=()):
            asked = lambda *words: sweep_main.players_of(sweep_main.parsed(["s", "--games", "1", "--out", "o", *words]), study)
            self.assertEqual(len(asked()), 8)
            self.assertEqual([p.number for p in asked("--players", "3")], [0, 1, 2])
            self.assertEqual([p.name for p in asked("--player", "stage_model")], ["stage_model"])
            self.assertEqual([(p.name, p.population, p.practice) for p in asked("--player", "observer:4-5", "--population", "9", "--practice", "20")],
                             [("observer:4", 9, 20), ("observer:5", 9, 20)])
            for words in (["--player", "robot"], ["--player", "observer:x"], ["--population", "3"], ["--player", "stage_model", "--practice", "3"]):
                with self.assertRaises(Refusal):
                    asked(*words)

    def test_a_sweep_of_more_games_than_a_table_holds_is_refused_before_the_checks_of_its_players(self):
        study = self.study('<player name="observer" numbers="0-999"/>')
        largest = virtual_games.MOST // (1000 * len(study.conditions))
        with mock.patch.object(players, "failing", return_value=()) as failing:
            parsed = lambda games: sweep_main.parsed(["s", "--games", str(games), "--out", "o"])
            self.assertEqual(len(sweep_main.players_of(parsed(largest), study)), 1000)
            failing.reset_mock()
            with self.assertRaisesRegex(Refusal, "2001000 games, and a sweep has at most 2000000"):
                sweep_main.players_of(parsed(largest + 1), study)
            failing.assert_not_called()
        SweepFolder.begin(self.folder / "few", study, 1, study.players[:1])
        stored = self.folder / "few" / "sweep.json"
        stored.write_text(stored.read_text(encoding="utf-8").replace('"games": 1,', '"games": 1000000000000,'), encoding="utf-8")
        with self.assertRaisesRegex(Refusal, "a sweep has at most"):
            SweepFolder(self.folder / "few")

    def test_the_lines_of_a_sweep_reach_the_terminal_without_control_characters(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            sweep_main.say("sweep: falsifier \x9b2J\n\x1b]0;t\x07")
        self.assertEqual(said.getvalue(), "sweep: falsifier \\x9b2J\\n\\x1b]0;t\\x07\n")

    def test_a_resumed_sweep_has_the_players_of_its_begin_and_an_old_one_those_of_fixed_rules(self):
        study = self.study("")
        asked = [players.Player("observer:3", 2, 5, ()), players.Player("observer:4", 2, 5, (2, 3))]
        SweepFolder.begin(self.folder / "new", study, 2, asked)
        self.assertEqual(SweepFolder(self.folder / "new").players, asked)
        text = (self.folder / "new" / "sweep.json").read_text(encoding="utf-8")
        (self.folder / "new" / "sweep.json").write_text(text[:text.index(',\n "players"')] + "\n}\n", encoding="utf-8")
        self.assertEqual(SweepFolder(self.folder / "new").players, [players.Player()])
        (self.folder / "new" / "sweep.json").write_text(text.replace('"format": 2,', ""), encoding="utf-8")
        with self.assertRaisesRegex(Refusal, "begun by another release"):
            SweepFolder(self.folder / "new")
        (self.folder / "new" / "sweep.json").write_text(text.replace("observer:3", "robot"), encoding="utf-8")
        with self.assertRaisesRegex(Refusal, "holds no sweep"):
            SweepFolder(self.folder / "new")

    def test_a_sweep_of_the_most_players_begins_and_resumes(self):
        study = self.study("")
        asked = [players.Player(f"observer:{players.LARGEST_NUMBER - i}", players.LARGEST_NUMBER, players.LARGEST_PRACTICE, tuple(range(1, 13))) for i in range(players.MOST)]
        with mock.patch.object(SweepFolder, "unfinished"):
            self.assertEqual(SweepFolder.begin(self.folder / "many", study, 1, asked).players, asked)
        self.assertLess(2 * (self.folder / "many" / "sweep.json").stat().st_size, 2_000_000)

    def test_results_name_their_players_and_those_that_fail_a_check(self):
        study = self.study('<player name="observer" numbers="0-4"/>')
        def found(those):
            return trials.of_rows([virtual_games.row(study, game, RESULT) for chunk in virtual_games.games_of(study, 1, those) for game in chunk])
        self.assertEqual(found([players.Player()]).observer(), "simulated (stage_model)")
        self.assertEqual(found([players.Player("observer:1", failed=()), players.Player("observer:2", failed=(3,))]).observer(),
                         "simulated (observer:1 of population 1, observer:2 of population 1; 1 of them fail a check)")
        self.assertEqual(found(study.players).observer(), "simulated (5 players, observer:0 of population 1 to observer:4 of population 1)")
        self.assertEqual(len(found(study.players).participants()), 5)
        many = self.study('<player name="observer" numbers="8-99 892"/>')
        self.assertEqual(found(many.players).observer(), "simulated (93 players, observer:8 of population 1 to observer:892 of population 1)")

    def test_falsifiers_are_in_the_file_before_the_games(self):
        study = self.study('<player name="observer"/><falsifier name="sound" decided_by="tactus study information">A delay of sound must do nothing.</falsifier>')
        self.assertEqual([(f.name, f.text, f.decided_by) for f in study.falsifiers], [("sound", "A delay of sound must do nothing.", "tactus study information")])
        shipped = study_file.read("percept_limits")
        self.assertEqual(len(shipped.falsifiers), 4)
        self.assertEqual((len(shipped.players), shipped.checks, shipped.stimulus.common_starts), (893, "leave_out", True))
        self.assertTrue({"", "percept", "force", "action"} <= {f.stage for c in shipped.conditions for f in c.factors})

    def test_a_live_session_has_one_player_of_the_first_population(self):
        with mock.patch.object(players, "failing", return_value=()):
            self.assertEqual(games.live_player(self.study('<player name="observer" numbers="3"/>'), print).name, "observer:3")
        for elements in ('<player name="observer" numbers="0-3"/>', '<player name="observer" numbers="3" population="2"/>', '<player name="observer" practice="2"/>'):
            with self.assertRaises(Refusal):
                games.live_player(self.study(elements), print)

    def test_the_checks_of_a_player_are_read_from_the_table_of_observer_players(self):
        program = self.folder / "observer_players"
        program.write_text("#!/bin/sh\necho player,check 1,check 2,check 3,admitted\necho $3,pass,FAIL,FAIL,no\necho failed,0,1,1,0 of 1 admitted\n", encoding="utf-8")
        program.chmod(0o755)
        with mock.patch.object(players, "PROGRAM", program):
            self.assertEqual(players.failing(players.Player("observer:3")), (2, 3))
        for last, found in (("yes,", ()), ("no,11", (11,))):
            program.write_text(f"#!/bin/sh\n[ $1 = admit ] || exit 1\necho '{verdicts.HEADER}'\necho $7,$3,{last}\n", encoding="utf-8")
            with mock.patch.object(players, "PROGRAM", program):
                self.assertEqual(players.failing(players.Player("observer:3"), True), found)
        program.write_text("#!/bin/sh\necho no >&2\nexit 1\n", encoding="utf-8")
        with mock.patch.object(players, "PROGRAM", program), self.assertRaisesRegex(Refusal, "does not check observer:3"):
            players.failing(players.Player("observer:3"))

    def test_a_table_of_verdicts_is_read_verified_or_refused_with_its_line(self):
        table = self.folder / "players.csv"
        table.write_text(f"{verdicts.HEADER}\n1,0,yes,\n1,1,no,2\n", encoding="utf-8")
        self.assertEqual(verdicts.read(table), {(1, 0): (), (1, 1): (2,)})
        of = players.several("observer", "0-3", 1, 0)
        with mock.patch.object(players, "failing", side_effect=lambda player, first_only: (2,) if player.number else ()):
            self.assertEqual(verdicts.verified(table, of), {(1, 0): (), (1, 1): (2,)})
        with mock.patch.object(players, "failing", return_value=()), self.assertRaisesRegex(Refusal, "verdict of observer:1 of population 1 is another one"):
            verdicts.verified(table, of)
        with self.assertRaisesRegex(Refusal, "no verdict of these players"):
            verdicts.verified(table, players.several("observer", "0-3", 2, 0))
        for line in ("1,0,yes,", "1,2,yes,3", "1,2,no,", "1,2,no,13", "1,2,no,x", "1,2,maybe,", "1,-2,yes,", "1,2", "", "1,4294967296,yes,"):
            table.write_text(f"{verdicts.HEADER}\n1,0,yes,\n{line}\n", encoding="utf-8")
            with self.assertRaisesRegex(Refusal, "players.csv:3: is no verdict"):
                verdicts.read(table)
        for content in (b"", b"player\n", b"\xff", f"{verdicts.HEADER}\n".encode() + b"1,0,yes,\n" * 200_000):
            table.write_bytes(content)
            with self.assertRaisesRegex(Refusal, "observer_players admit"):
                verdicts.read(table)


if __name__ == "__main__":
    sys.exit(unittest.main())
