"""Reuses the games of an earlier sweep, which had fewer games or other levels, in a new sweep."""
import lzma
import pathlib

from tactus import own_files
from tactus.refusal import Refusal, sentence_of
from tactus.study import trial_table
from tactus.sweep import virtual_games
from tactus.sweep.chunk_file import ChunkFile
from tactus.sweep.player import Player

DECOMPRESSOR_BYTES = 256 << 20  # design: memory of the decompressor; xz -9 needs 65 MB (xz(1))
CHUNK = 1 << 20
SAME = ("missed", "success", "completion_time_s", "errors", "peak_force_n", "path_m")  # columns with the result of a game


def read(path):
    """{(participant, condition, seed): row} of the games of a table, CSV or CSV.xz. Raises Refusal."""
    path = pathlib.Path(path)
    try:
        rows = trial_table.read(path) if path.suffix != ".xz" else trial_table.parsed(plain_bytes(path, trial_table.LARGEST_BYTES), path)
    except (lzma.LZMAError, EOFError, ValueError) as error:
        raise Refusal(f"{path}: holds no table of games ({error}); give games.csv or .csv.xz of a sweep") from None
    except OSError as error:
        raise Refusal(f"{path}: cannot be read ({sentence_of(error)}); give games.csv or .csv.xz of a sweep") from None
    return {(row["participant_id"], row["condition"], row["seed"]): row for row in rows if row["task"] == "game"}


def plain_bytes(path, largest_bytes):
    """The uncompressed bytes of an xz file, at most largest_bytes + 1: a small file can expand to any size. Raises OSError, lzma.LZMAError, EOFError."""
    decompressor = lzma.LZMADecompressor(format=lzma.FORMAT_XZ, memlimit=DECOMPRESSOR_BYTES)
    out = bytearray()
    with own_files.open_regular(path) as file:
        data = b""
        while not decompressor.eof and len(out) <= largest_bytes:
            data = file.read(CHUNK) if decompressor.needs_input else b""
            if decompressor.needs_input and not data:
                raise EOFError("it ends within the data")
            out += decompressor.decompress(data, max_length=min(CHUNK, largest_bytes + 1 - len(out)))
    return bytes(out)


def adopt(folder, table):
    """Copies the rows of the table that belong to this sweep into its chunks; returns their number. Replays the first game of each condition and of each player; its
    result must be identical, since another build may give other games. Raises Refusal, OSError."""
    known, seen, count = read(table), set(), 0
    with Player(folder.study.scene) as player:
        for number, chunk in enumerate(folder.chunks):
            rows = []
            for game in chunk:
                row = known.get((game.player.participant, game.condition.id, game.seed(folder.study)))
                if row is None or row["missed"]:
                    continue
                row = {**row, "trial": game.number, "player": game.player.words(), "failed_checks": game.player.verdict()}
                if not {game.player, game.condition.id} <= seen:
                    seen |= {game.player, game.condition.id}
                    again = virtual_games.row(folder.study, game, player.play(virtual_games.request(folder.study, game)))
                    if [row[k] for k in ("profile_sha256", *SAME)] != [again.get(k) for k in ("profile_sha256", *SAME)]:
                        raise Refusal(f"{table}: its game {row['condition']}, seed {row['seed']}, has another result with this build, or was played with another practice; remove --from")
                rows.append(row)
            if rows:
                file = ChunkFile(folder.file(number))
                for row in rows:
                    file.append(row)
                file.close()
                count += len(rows)
    return count
