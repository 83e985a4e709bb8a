"""Studies: how far can one modality degrade before the interaction is ruined?"""
import importlib

from tactus.commands import prepare
from tactus.paths import SCRIPTS

VERBS = {"check": "tactus.study.check", "run": "tactus.study.run", "sweep": "tactus.sweep.main", "analyse": "tactus.analysis.main"}
USAGE = """Usage: tactus study VERB ...

  check STUDY.xml                        is the file right? Prints the plan, its trials, how long it takes, and how much it can find
  run STUDY.xml --participant P01        leads a participant through it on a live cluster; goes on where it was interrupted
  sweep STUDY.xml --games N --out DIR    games of the artificial player in virtual time, as many as the machine or a Slurm cluster has room for
  analyse FOLDER...                      fits, limits and one report, from what the others left

STUDY.xml is a file, or the name of a shipped one:"""


def usage():
    shipped = sorted(path.stem for path in (SCRIPTS / "studies").glob("*.xml"))
    return "\n".join([USAGE, *(f"  {name}" for name in shipped), "", "tactus study VERB --help says more of each."])


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.show(usage(), asked=bool(words))
    verb, *words = words
    if verb not in VERBS:
        return prepare.refuse("study", f"there is no verb '{verb}'; choose from {', '.join(VERBS)}")
    if verb != "analyse" and "--help" not in words:
        prepare.install_and_build()
    return importlib.import_module(VERBS[verb]).main(words)
