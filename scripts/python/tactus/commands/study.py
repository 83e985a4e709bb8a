"""The command `tactus study`: studies of how far one modality can degrade before the interaction breaks down."""
import importlib

from tactus.commands import prepare
from tactus.paths import SCRIPTS

VERBS = {"check": "tactus.study.check", "run": "tactus.study.run", "sweep": "tactus.sweep.main", "analyse": "tactus.analysis.main",
         "replicate": "tactus.replication.main", "information": "tactus.information.main", "battery": "tactus.battery.main"}
USAGE = """Usage: tactus study VERB ...

  check STUDY.xml                        validates the file; prints the plan, its trials, the duration and the statistical power
  run STUDY.xml --participant P01        runs the study with a participant on a live cluster; resumes an interrupted study
  sweep STUDY.xml --games N --out DIR    plays games of the simulated player in virtual time, in parallel on this machine or on a Slurm cluster
  analyse FOLDER...                      computes fits, limits and one report from the results
  replicate [FILE...]                    repeats published experiments with simulated participants, and compares the results
  information [TASK]...                  measures the information that each sense carries about the hidden variable of a task, in bits
  battery [TASK]...                      asks a population of players how far each sense of a task can degrade

STUDY.xml is a file, or the name of a shipped study:"""


def usage():
    shipped = sorted(path.stem for path in (SCRIPTS / "studies").glob("*.xml"))
    return "\n".join([USAGE, *(f"  {name}" for name in shipped), "", "tactus study VERB --help describes a verb."])


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.print_usage(usage(), requested=bool(words))
    verb, *words = words
    if verb not in VERBS:
        return prepare.refuse("study", f"there is no verb '{verb}'; choose from {', '.join(VERBS)}")
    if verb != "analyse" and "--help" not in words:
        prepare.install_and_build(*(("experiment_trials",) if verb == "replicate" else ()))
    return importlib.import_module(VERBS[verb]).main(words)
