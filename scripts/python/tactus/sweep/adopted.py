"""Reuses the games of an earlier sweep, which had fewer games or other levels, in a new sweep."""
import lzma
import pathlib
import tempfile

from tactus.refusal import Refusal
from tactus.study import trial_table
from tactus.sweep import virtual_games
from tactus.sweep.chunk_file import ChunkFile
from tactus.sweep.player import Player

SAME = ("missed", "success", "completion_time_s", "errors", "peak_force_n", "path_m")  # columns with the result of a game


def read(path):
    """{(condition, seed): row} of the games of a table, CSV or CSV.xz. Raises Refusal."""
    path = pathlib.Path(path)
    try:
        if path.suffix != ".xz":
            rows = trial_table.read(path)
        else:
            with tempfile.TemporaryDirectory() as scratch:
                plain = pathlib.Path(scratch) / path.stem
                plain.write_bytes(lzma.decompress(path.read_bytes()))
                rows = trial_table.read(plain)
    except (lzma.LZMAError, ValueError) as error:
        raise Refusal(f"{path}: holds no table of games ({error}); give games.csv or .csv.xz of a sweep") from None
    return {(row["condition"], row["seed"]): row for row in rows if row["task"] == "game"}


def adopt(folder, table):
    """Copies the rows of the table that belong to this sweep into its chunks; returns their number. Replays the first game of each condition; its result must
    be identical, since another build may give other games. Raises Refusal, OSError."""
    known, seen, count = read(table), set(), 0
    with Player(folder.study.scene) as player:
        for number, chunk in enumerate(folder.chunks):
            rows = []
            for game in chunk:
                row = known.get((game.condition.id, game.seed(folder.study)))
                if row is None or row["missed"]:
                    continue
                row = {**row, "trial": game.number}
                if game.condition.id not in seen:
                    seen.add(game.condition.id)
                    again = virtual_games.row(folder.study, game, player.play(virtual_games.request(folder.study, game)))
                    if [row[k] for k in ("profile_sha256", *SAME)] != [again.get(k) for k in ("profile_sha256", *SAME)]:
                        raise Refusal(f"{table}: its game {row['condition']}, seed {row['seed']}, has another result with this build; remove --from")
                rows.append(row)
            if rows:
                file = ChunkFile(folder.file(number))
                for row in rows:
                    file.append(row)
                file.close()
                count += len(rows)
    return count
