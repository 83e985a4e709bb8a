"""What the study files beside the tables say of the analysis: margins, the time limit of games, and what was matched."""
import dataclasses
import pathlib

NAME = "study.xml"
HIGHEST = 3  # design: folders above a table in which the study may lie: OUT/study/participant/session/trials.csv


@dataclasses.dataclass(frozen=True)
class Stated:
    """margin_success, margin_time: shares. limit_s: of a game. felt: the property that was matched, or judged of two presses, or ""."""
    margin_success: float
    margin_time: float
    limit_s: float
    felt: str


def beside(table):
    """The study file that belongs to a table, or None."""
    folders = list(pathlib.Path(table).resolve().parents)[:HIGHEST]
    return next((folder / NAME for folder in folders if (folder / NAME).is_file()), None)


def stated(tables):
    """{study's name: Stated} of the study files beside the tables. Raises Refusal when one of them is wrong."""
    found = {}
    for path in sorted({p for p in map(beside, tables) if p}):
        from tactus.study import study_file
        study = study_file.read(path, with_scene=False)
        found[study.name] = Stated(study.margin["success"], study.margin["time"], study.stimulus.limit_s, study.of)
    return found
