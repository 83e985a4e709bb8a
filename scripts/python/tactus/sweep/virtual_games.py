"""The games of a sweep: their seeds, profiles and chunks, and their rows of the trial table."""
import dataclasses
import hashlib

from tactus import players
from tactus.refusal import Refusal

CHUNK = 50  # games of one job, about 15 s: short against the sweep, long against reading the scene; design
MOST = 2_000_000  # games of a sweep: their table of about 300 bytes each stays below trial_table.LARGEST_BYTES; design


@dataclasses.dataclass(frozen=True)
class Game:
    """One game: its number in the sweep (from 1), its condition, its number within the condition and player (from 1), and its player."""
    number: int
    condition: object
    repetition: int
    player: players.Player = players.Player()

    def seed(self, study):
        """Seed of all random draws of the game. It depends on the seed of the study, the condition, the repetition, and the number of a player of a population;
        with common starts not on the condition. 53 bits: exact in JSON."""
        text = f"{study.seed}|{'' if study.stimulus.common_starts else self.condition.id}|{self.repetition}"
        if self.player.number is not None:  # players start differently, so that a common start is no common cause
            text += f"|{self.player.number}"
        return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") >> 11


def require_few(study, repetitions, number_of_players):
    """Raises Refusal when a sweep would have more games than MOST."""
    count = repetitions * number_of_players * len(study.conditions)
    if count > MOST:
        raise Refusal(f"--games {repetitions}: with {number_of_players} players and {len(study.conditions)} conditions these are {count} games, and a sweep has at most {MOST}; give fewer "
                      "games, players or conditions")


def games_of(study, repetitions, all_players=(players.Player(),)):
    """[[Game]]: chunks of games, each of one condition. The first chunks of all conditions come before the second ones, and the first game of all players
    before the second ones."""
    of_a_condition = [(n, player) for n in range(1, repetitions + 1) for player in all_players]
    games, number = [], 0
    for first in range(0, len(of_a_condition), CHUNK):
        for condition in study.conditions:
            games.append([])
            for repetition, player in of_a_condition[first:first + CHUNK]:
                number += 1
                games[-1].append(Game(number, condition, repetition, player))
    return games


def request(study, game):
    """Request of a game for bin/play_games."""
    return {"game": str(game.number), "seed": game.seed(study), "limit_s": study.stimulus.limit_s, "profile": study.profile(game.condition, game.condition.fixed),
            **game.player.request()}


def row(study, game, result):
    """Row of the trial table (tactus/study/trial_table.py) from the result of bin/play_games."""
    level = game.condition.fixed
    row = {"participant_id": game.player.participant, "session": 1, "block": 1, "trial": game.number, "task": "game", "observer": "simulated",
           "player": game.player.words(), "failed_checks": game.player.verdict(), "study": study.name, "condition": game.condition.id, "seed": game.seed(study),
           "profile_sha256": hashlib.sha256(study.profile(game.condition, level).encode()).hexdigest(),
           "latency_profile": "virtual time", **game.condition.row(level)}
    if "trouble" in result:
        said = f": {result['said']}" if result.get("said") else ""
        return {**row, "missed": 1, "missed_reason": result["trouble"] + said}
    return {**row, "missed": 0, "success": int(result["won"]), "completion_time_s": round(result["time_s"], 4), "errors": result["wrong"],
            "peak_force_n": round(result["peak_force_N"], 4), "path_m": round(result["path_m"], 4)}
