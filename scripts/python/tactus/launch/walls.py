"""The walls of a room: one visual_node for each, so that a slow one makes no other slower."""
import csv
import re

from tactus.paths import REPOSITORY

FIRST = "visual_node"  # draws the first wall, or what the scene's camera sees when there is no room
LONGEST_NAME = 40      # of a process: its folder, its log and its video bear it too
ROOMS = REPOSITORY / "visual_node" / "rooms"


def room(here, text):
    """(what the nodes are told, names of its walls) of --room; ValueError with one sentence. The nodes check what is in the file."""
    shipped = sorted(path.stem for path in ROOMS.glob("*.csv"))
    path = ROOMS / f"{text}.csv" if text in shipped else here / text
    try:
        with open(path, newline="", encoding="utf-8") as file:
            names = [row["wall"] for row in csv.DictReader(file)]
    except (OSError, KeyError, TypeError, UnicodeDecodeError, csv.Error):
        raise ValueError(f"--room {text}: is no file of walls; choose {', '.join(shipped)} or a CSV file such as {ROOMS}/cave4.csv") from None
    names = [name for name in names if name and name != "eye"]
    if not names:
        raise ValueError(f"--room {text}: has no wall; choose {', '.join(shipped)} or another file")
    return (text if text in shipped else str(path.resolve())), names


def processes(names):
    """{process: wall} of the walls: visual_node the first, visual_node_WALL each other, in letters that a folder and a shell bear."""
    walls = {FIRST: names[0]} if names else {}
    for number, wall in enumerate(names[1:], 2):
        process = f"{FIRST}_{re.sub(r'[^A-Za-z0-9_-]', '_', wall)}"[:LONGEST_NAME]
        walls[process if process not in walls else f"{process[:LONGEST_NAME - 4]}_{number}"] = wall
    return walls
