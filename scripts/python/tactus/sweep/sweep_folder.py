"""The folder of a sweep: a copy of the study, the requested games, a file for each chunk of games, and the table."""
import dataclasses
import fcntl
import hashlib
import json
import os
import pathlib

from tactus import own_files, players
from tactus.refusal import Refusal
from tactus.study import study_file, trial_table
from tactus.sweep import chunk_file
from tactus.sweep.virtual_games import games_of, require_few

LARGEST_BYTES = 1_000_000  # of sweep.json: design, twice players.MOST players that fail all checks
FORMAT = 2  # the order of the games and the seeds of players of a population; 1, without the word: before 2026-11-28


class SweepFolder:
    """path: of an existing sweep. Raises Refusal if it holds none."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            self.asked = json.loads(own_files.read_regular(self.path / "sweep.json", LARGEST_BYTES))
            self.games_each, study = int(self.asked["games"]), str(self.asked["study"])
            self.players = [player_of(p) for p in self.asked.get("players", [{}])]
            if self.games_each < 1 or not 1 <= len(self.players) <= players.MOST:
                raise ValueError
            known = self.asked.get("format") == FORMAT
        except (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError):
            raise Refusal(f"{self.path}: holds no sweep to resume; remove --resume and give a new --out") from None
        if not known and (len(self.players) > 1 or self.players[0].number is not None):
            raise Refusal(f"{self.path}: was begun by another release, whose games of players of a population differ; start a new sweep with another --out")
        self.study = study_file.read(study)
        for file, sha256, name in ((self.study.path, self.study.sha256, "study_sha256"), (self.study.scene, scene_sha256(self.study), "scene_sha256")):
            if sha256 != self.asked.get(name):
                raise Refusal(f"{file}: has changed since this sweep began, so its games would differ; start a new sweep with another --out")
        require_few(self.study, self.games_each, len(self.players))
        self.chunks = games_of(self.study, self.games_each, self.players)
        (self.path / "chunks").mkdir(exist_ok=True)
        trial_table.replace(self.path / "study.xml", self.study.path.read_bytes())  # for an analysis on another machine

    @staticmethod
    def refuse_used(path):
        """The path of a new sweep. Raises Refusal if it is in use."""
        path = pathlib.Path(path)
        if path.exists() and (not path.is_dir() or any(path.iterdir())):
            raise Refusal(f"{path}: already exists; add --resume to continue that sweep, or choose another --out")
        return path

    @staticmethod
    def begin(path, study, games, all_players=(players.Player(),)):
        """Creates the folder of a new sweep of these players. Raises Refusal if the path is in use."""
        path = SweepFolder.refuse_used(path)
        path.mkdir(parents=True, exist_ok=True)
        trial_table.replace(path / "sweep.json", json.dumps(
            {"format": FORMAT, "study": str(study.path.resolve()), "games": games, "study_sha256": study.sha256, "scene_sha256": scene_sha256(study), "players": [dataclasses.asdict(p) for p in all_players]}, indent=1) + "\n")
        return SweepFolder(path)

    def hold(self):
        """Locks the sweep until the process ends. Raises Refusal if another process holds it."""
        self.lock = os.open(self.path, os.O_RDONLY)
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Refusal(f"{self.path}: another tactus study sweep is running there; wait for it, or stop it") from None

    def file(self, number):
        return self.path / "chunks" / f"{number:05}.csv"

    def unfinished(self):
        """Numbers of the chunks that lack games."""
        return [i for i, chunk in enumerate(self.chunks) if chunk_file.count(self.file(i)) < len(chunk)]

    def done(self):
        """(number of finished games, number of all games)."""
        return sum(chunk_file.count(self.file(i)) for i in range(len(self.chunks))), sum(len(c) for c in self.chunks)

    def merge(self):
        """Writes games.csv from all chunks. Returns its rows."""
        rows = []
        for i in range(len(self.chunks)):
            if self.file(i).exists():
                rows += trial_table.read(self.file(i))
        trial_table.write(self.path / "games.csv", rows)
        return rows


def player_of(stored):
    """A player of sweep.json. Raises TypeError, ValueError."""
    player = players.Player(**stored)
    if not players.is_player(player.name):
        raise ValueError
    return dataclasses.replace(player, population=int(player.population), practice=int(player.practice),
                               failed=None if player.failed is None else tuple(map(int, player.failed)))


def scene_sha256(study):
    return hashlib.sha256(pathlib.Path(study.scene).read_bytes()).hexdigest()
