"""A game as a trial: runs it and records success, completion time and mistakes."""
import dataclasses

from tactus import players
from tactus.refusal import Refusal
from tactus.study import stimuli
from tactus.study.trial_runner_client import TrialRunnerClient
from tactus.study.live_cluster import LiveCluster

START_TIMEOUT_S = 60


@dataclasses.dataclass
class Played:
    """Result of a game, with the members of stimuli.Observed."""
    missed: str = ""
    row: dict = dataclasses.field(default_factory=dict)
    event: str = ""
    soa_ms: float = None
    uncertainty_ms: float = None
    sensed_ms: float = None
    stiffnesses_N_m: tuple = ()
    reached_N: float = None

    def words(self):
        return f"{'won' if self.row['success'] else 'not won'} after {self.row['completion_time_s']:.1f} s" if self.row else ""


def outcome(runner, limit_s):
    """Waits for the end of the game; returns a Played."""
    began_ns = runner.sim_ns
    wrong = [0]

    def over():
        if runner.game is not None:
            wrong[0] = max(wrong[0], runner.game["wrong"])
        return runner.game is not None and runner.game["won"] or runner.sim_ns - began_ns >= limit_s * 1e9
    if not runner.wait_for(over, 2 * limit_s + 10):
        return Played(missed="the simulation stopped")
    if runner.game is None:
        return Played(missed="the scene reports no game")
    won = runner.game["won"]
    seconds = min(limit_s, (runner.game["won_sim_ns"] - began_ns) * 1e-9) if won else limit_s
    return Played(row={"success": int(won), "completion_time_s": round(max(0.0, seconds), 4), "errors": wrong[0]})


def play(session, trial, attempt):
    """A game with a person, in the running simulation, after a reset."""
    runner, study = session.run_session, session.study
    missed = stimuli.ready(runner, study.profile(trial.condition, trial.level))
    if missed:
        return Played(missed=missed)
    session.read("Ready for the next game?")
    runner.reply = runner.game = None
    runner.send(command={"kind": "reset"})
    if not runner.wait_for(lambda: runner.reply is not None, 5) or not runner.reply["done"]:
        return Played(missed="the simulation was not reset")
    stimuli.wait(runner, 0.6)  # until health and simulation time arrive again
    return outcome(runner, study.stimulus.limit_s)


def play_simulated(session, trial, attempt):
    """A game with the simulated player, in a separate cluster; its seed places the balls."""
    study = session.study
    runs = session.folder / "runs"
    runs.mkdir(exist_ok=True)
    profile = runs / "profile.xml"
    profile.write_text(study.profile(trial.condition, trial.level), encoding="utf-8")
    seed = session.plan.draw(f"game {trial.number} {attempt}")
    out = runs / f"game{trial.number}_{attempt}"
    player = session.player
    played = play_in_new_cluster(out, study.scene, profile, seed, study.stimulus.limit_s, session.options.set, player.name)
    played.row["seed"] = seed
    played.row["player"], played.row["failed_checks"] = player.words(), player.verdict()
    played.row["log_file"] = str((out / "run.lcmlog").relative_to(session.folder))
    return played


def live_player(study, report):
    """The simulated player of the live games of a study, checked. Raises Refusal."""
    player = study.players[0]
    if len(study.players) > 1:
        raise Refusal(f"{study.path}: a session has one player, but the study has {len(study.players)}; keep one <player>, or use tactus study sweep")
    if player.population != 1 or player.practice:
        raise Refusal(f"{study.path}: a live game has players of population 1 without practice; remove population= and practice=, or use tactus study sweep")
    return players.checked([player], study.checks, report)[0]


def play_in_new_cluster(out, scene, profile, seed, limit_s, settings, player=players.NAMES[0]):
    """Starts a live cluster with the simulated player, plays one game and ends the cluster; returns a Played. out: results folder. profile: a file.
    settings: of the cluster, NODE.NAME=VALUE each. player: its name, which has passed its checks or need not. Raises Refusal."""
    words = [str(scene), "--player", player, *(["--checks", "skip"] if ":" in player else []), "--seed", str(seed), "--degrade", str(profile)]
    cluster = LiveCluster(out, words + [w for s in settings for w in ("--set", s)])
    runner = None
    try:
        cluster.wait_until_it_runs()
        runner = TrialRunnerClient(out)
        if not runner.wait_for(lambda: runner.sim_ns is not None and runner.sim_ns > 0, START_TIMEOUT_S):
            raise Refusal(f"the simulation has not started after {START_TIMEOUT_S} s; see {cluster.log}")
        runner.sim_ns = 0  # the player starts with the simulation
        return outcome(runner, limit_s)
    finally:
        if runner is not None:
            runner.end()
        cluster.end()
