"""A game as a trial: won or not, how fast, with how many mistakes."""
import dataclasses

from tactus.refusal import Refusal
from tactus.study import stimuli
from tactus.study.lead import Lead
from tactus.study.live_cluster import LiveCluster

BEGINS_WITHIN_S = 60


@dataclasses.dataclass
class Played:
    """As stimuli.Observed, of a game."""
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


def outcome(lead, limit_s):
    """Waits for the end of the game; a Played."""
    began_ns = lead.sim_ns
    wrong = [0]

    def over():
        if lead.game is not None:
            wrong[0] = max(wrong[0], lead.game["wrong"])
        return lead.game is not None and lead.game["won"] or lead.sim_ns - began_ns >= limit_s * 1e9
    if not lead.wait_for(over, 2 * limit_s + 10):
        return Played(missed="the world did not go on")
    if lead.game is None:
        return Played(missed="the scene says nothing of a game")
    won = lead.game["won"]
    seconds = min(limit_s, (lead.game["won_sim_ns"] - began_ns) * 1e-9) if won else limit_s
    return Played(row={"success": int(won), "completion_time_s": round(max(0.0, seconds), 4), "errors": wrong[0]})


def play(session, trial, attempt):
    """With a person, in the world that runs: it is put back to its beginning."""
    lead, study = session.lead, session.study
    missed = stimuli.ready(lead, study.profile(trial.condition, trial.level))
    if missed:
        return Played(missed=missed)
    session.read("Ready for the next game?")
    lead.reply = lead.game = None
    lead.order(command={"kind": "reset"})
    if not lead.wait_for(lambda: lead.reply is not None, 5) or not lead.reply["done"]:
        return Played(missed="the world was not put back to its beginning")
    stimuli.wait(lead, 0.6)  # until the senses and the clock of the world are heard anew
    return outcome(lead, study.stimulus.limit_s)


def play_anew(session, trial, attempt):
    """With the artificial player, in a world of its own, whose seed says where the balls lie."""
    study = session.study
    runs = session.folder / "runs"
    runs.mkdir(exist_ok=True)
    profile = runs / "profile.xml"
    profile.write_text(study.profile(trial.condition, trial.level), encoding="utf-8")
    seed = session.plan.draw(f"game {trial.number} {attempt}")
    out = runs / f"game{trial.number}_{attempt}"
    played = in_a_world_of_its_own(out, study.scene, profile, seed, study.stimulus.limit_s, session.options.set)
    played.row["seed"] = seed
    played.row["log_file"] = str((out / "run.lcmlog").relative_to(session.folder))
    return played


def in_a_world_of_its_own(out, scene, profile, seed, limit_s, settings):
    """The artificial player's game in a live cluster that begins and ends with it and leaves its results in `out`; a Played. profile: a file.
    settings: of the cluster, NODE.NAME=VALUE each. Raises Refusal."""
    words = [str(scene), "--player", "--seed", str(seed), "--degrade", str(profile)]
    cluster = LiveCluster(out, words + [w for s in settings for w in ("--set", s)])
    lead = None
    try:
        cluster.wait_until_it_runs()
        lead = Lead(out)
        if not lead.wait_for(lambda: lead.sim_ns is not None and lead.sim_ns > 0, BEGINS_WITHIN_S):
            raise Refusal(f"the world has not begun after {BEGINS_WITHIN_S} s; see {cluster.log}")
        lead.sim_ns = 0  # the player begins with the world
        return outcome(lead, limit_s)
    finally:
        if lead is not None:
            lead.end()
        cluster.end()
