"""Games that were played before go into a new sweep: of a table that an earlier one left, with fewer games or other levels."""
import lzma
import pathlib
import tempfile

from tactus.refusal import Refusal
from tactus.study import trial_table
from tactus.sweep import virtual_games
from tactus.sweep.chunk_file import ChunkFile
from tactus.sweep.player import Player

SAME = ("missed", "success", "completion_time_s", "errors", "peak_force_n", "path_m")  # what a game comes to


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
        raise Refusal(f"{path}: holds no table of games ({error})") from None
    return {(row["condition"], row["seed"]): row for row in rows if row["task"] == "game"}


def adopt(folder, table):
    """How many games of the table are games of this sweep too: their rows go into its chunks. The first one of each condition is played anew, and
    must come to the same to the digit: else another build would be mixed with this one. Raises Refusal, OSError."""
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
                    again = virtual_games.row(folder.study, game, player.told(virtual_games.asked(folder.study, game)))
                    if [row[k] for k in ("profile_sha256", *SAME)] != [again.get(k) for k in ("profile_sha256", *SAME)]:
                        raise Refusal(f"{table}: its game {row['condition']}, seed {row['seed']}, comes to something else with this build; leave --from away")
                rows.append(row)
            if rows:
                file = ChunkFile(folder.file(number))
                for row in rows:
                    file.append(row)
                file.close()
                count += len(rows)
    return count
