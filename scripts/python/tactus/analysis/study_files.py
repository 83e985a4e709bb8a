"""Settings of the analysis from the study files beside the tables: margins, time limit of games, matched property."""
import dataclasses
import pathlib

NAME = "study.xml"
HIGHEST = 3  # design: folders above a table in which the study may lie: OUT/study/participant/session/trials.csv


@dataclasses.dataclass(frozen=True)
class Stated:
    """margin_success, margin_time: shares. limit_s: time limit of a game. felt: the property that was matched, or compared between two presses, or ""."""
    margin_success: float
    margin_time: float
    limit_s: float
    felt: str


def beside(table):
    """The study file that belongs to a table, or None."""
    folders = list(pathlib.Path(table).resolve().parents)[:HIGHEST]
    return next((folder / NAME for folder in folders if (folder / NAME).is_file()), None)


def stated(tables):
    """{study's name: Stated} of the study files beside the tables. Raises Refusal if one of them is invalid."""
    found = {}
    for path in sorted({p for p in map(beside, tables) if p}):
        from tactus.study import study_file
        study = study_file.read(path, with_scene=False)
        found[study.name] = Stated(study.margin["success"], study.margin["time"], study.stimulus.limit_s, study.of)
    return found
