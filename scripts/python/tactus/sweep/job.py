"""Plays chunks of games of a sweep, as one job on this machine or a task of a Slurm array.

    tactus --module tactus.sweep.job FOLDER CHUNK...                     these chunks
    tactus --module tactus.sweep.job FOLDER --of-array LIST.txt          every SLURM_ARRAY_TASK_COUNT-th line of the list, from SLURM_ARRAY_TASK_ID on

Finished games are not played again. One process of bin/play_games plays all games of a chunk.
"""
import os
import pathlib
import signal
import sys
import time

from tactus import signals, terminal
from tactus.refusal import Refusal
from tactus.sweep import virtual_games
from tactus.sweep.chunk_file import Busy, ChunkFile
from tactus.sweep.player import Player
from tactus.sweep.sweep_folder import SweepFolder


def play(folder, number):
    """Plays the missing games of a chunk. Raises Refusal, OSError."""
    try:
        file = ChunkFile(folder.file(number))
    except Busy:
        return
    try:
        begun = time.monotonic()  # the first game of a chunk includes the start of the player
        with Player(folder.study.scene) as player:
            for game in (g for g in folder.chunks[number] if g.number not in file.done):
                row = virtual_games.row(folder.study, game, player.play(virtual_games.request(folder.study, game)))
                now = time.monotonic()
                file.append(row, now - begun)
                begun = now
    finally:
        file.close()


def chunks_of(words):
    if words[:1] != ["--of-array"]:
        return [int(w) for w in words]
    listed = pathlib.Path(words[1]).read_text(encoding="utf-8").split()
    first, step = int(os.environ["SLURM_ARRAY_TASK_ID"]), int(os.environ["SLURM_ARRAY_TASK_COUNT"])
    return [int(w) for w in listed[first::step]]


def stop(*_):
    raise KeyboardInterrupt


def main(words):
    signals.handle([signal.SIGTERM], stop)  # removes the temporary folder of the player
    if not words or words[0] in ("-h", "--help"):
        print(__doc__)
        return 0
    try:
        folder = SweepFolder(words[0])
        for number in chunks_of(words[1:]):
            play(folder, number)
        return 0
    except KeyboardInterrupt:
        return 130
    except (Refusal, OSError, ValueError) as error:
        terminal.report_refusal(f"sweep job: {error}")
        return 1
