"""The walls of a room: one visual_node for each, so that a slow one does not delay the others."""
import re

from tactus.paths import ROOMS
from tactus.refusal import Refusal
from tactus.tables import read_rows

FIRST = "visual_node"  # draws the first wall, or the camera of the scene without a room
LONGEST_NAME = 40      # of a process name, which is also the name of its folder, log and video


def room(here, text):
    """(value for the nodes, names of the walls) of --room. Raises ValueError with one sentence. The nodes check the content."""
    shipped = sorted(path.stem for path in ROOMS.glob("*.csv"))
    path = ROOMS / f"{text}.csv" if text in shipped else here / text
    try:
        names = [row["wall"] for row in read_rows(path)]
    except Refusal as error:
        raise ValueError(f"--room {text}: is not a file of walls: {error}") from None
    except (OSError, KeyError):
        raise ValueError(f"--room {text}: is not a file of walls; choose {', '.join(shipped)} or a CSV file such as {ROOMS}/cave4.csv") from None
    names = [name for name in names if name and name != "eye"]
    if not names:
        raise ValueError(f"--room {text}: has no wall; choose {', '.join(shipped)} or another file")
    return (text if text in shipped else str(path.resolve())), names


def processes(names):
    """{process: wall}: visual_node for the first wall, visual_node_WALL for each other, with only letters, digits, _ and -."""
    walls = {FIRST: names[0]} if names else {}
    for number, wall in enumerate(names[1:], 2):
        process = f"{FIRST}_{re.sub(r'[^A-Za-z0-9_-]', '_', wall)}"[:LONGEST_NAME]
        walls[process if process not in walls else f"{process[:LONGEST_NAME - 4]}_{number}"] = wall
    return walls
