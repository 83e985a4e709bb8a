"""The games of a sweep: which there are, with which seed and profile, and in which chunk each is played."""
import dataclasses
import hashlib

CHUNK = 50  # games that one job plays, one after the other; design: a quarter of a minute, so that little waits for the last, and reading the scene is little of it


@dataclasses.dataclass(frozen=True)
class Game:
    """One game: number of all (from 1), its condition of the study, its number within that (from 1)."""
    number: int
    condition: object
    repetition: int

    def seed(self, study):
        """Of all that is drawn by chance in it; another for each game, the same whoever plays it when. 53 bits: exact in JSON."""
        text = f"{study.seed}|{self.condition.id}|{self.repetition}"
        return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") >> 11


def games_of(study, repetitions):
    """All games, in an order in which those of a chunk are of one condition, and every condition is begun before one is finished."""
    chunks = []
    for first in range(1, repetitions + 1, CHUNK):
        for condition in study.conditions:
            chunks.append([(condition, n) for n in range(first, min(first + CHUNK, repetitions + 1))])
    games, number = [], 0
    for chunk in chunks:
        games.append([])
        for condition, n in chunk:
            number += 1
            games[-1].append(Game(number, condition, n))
    return games


def asked(study, game):
    """What bin/play_games is asked."""
    return {"game": str(game.number), "seed": game.seed(study), "limit_s": study.stimulus.limit_s, "profile": study.profile(game.condition, game.condition.fixed)}


def row(study, game, told):
    """The row of the trial table (scripts/python/tactus/study/trial_table.py) of a game, from what bin/play_games told of it."""
    level = game.condition.fixed
    row = {"participant_id": "player", "session": 1, "block": 1, "trial": game.number, "task": "game", "observer": "simulated",
           "study": study.name, "condition": game.condition.id, "seed": game.seed(study),
           "profile_sha256": hashlib.sha256(study.profile(game.condition, level).encode()).hexdigest(),
           "latency_profile": "virtual time", **game.condition.row(level)}
    if "trouble" in told:
        said = f": {told['said']}" if told.get("said") else ""
        return {**row, "missed": 1, "missed_reason": told["trouble"] + said}
    return {**row, "missed": 0, "success": int(told["won"]), "completion_time_s": round(told["time_s"], 4), "errors": told["wrong"],
            "peak_force_n": round(told["peak_force_N"], 4), "path_m": round(told["path_m"], 4)}
