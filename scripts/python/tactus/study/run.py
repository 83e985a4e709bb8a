"""tactus study run: leads one participant through a study on a live cluster."""
import argparse
import os

from tactus import terminal
from tactus.refusal import Refusal, sentence_of
from tactus.study import session, study_file

USAGE = """Leads a participant through a study on a live cluster: instructions, trials, questions, breaks. Every trial sets its profile, waits until it is in
force in every sense, presents its stimulus, and reads back what was really presented. A trial whose apparatus missed the study's tolerance is
marked and repeated. Interrupted at any point, the same command goes on with the next trial."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study run --help")


def parsed(words):
    p = Parser(prog="tactus study run", description=USAGE, allow_abbrev=False)
    p.add_argument("study", help="a study file, or the name of a shipped one")
    p.add_argument("--participant", required=True, help="a name for him that says nothing of who he is, for example P01; its number is his row of the square")
    p.add_argument("--out", default="studies", help="where all studies go: OUT/STUDY/PARTICIPANT; default: ./studies")
    p.add_argument("--session", type=int, default=1, help="number of the session; from 2 on in a folder of its own")
    p.add_argument("--seed", type=int, help="instead of that of the study file")
    p.add_argument("--simulated", action="store_true", help="a simulated participant answers, with the observer of the study file; so says every row")
    p.add_argument("--window", action="store_true", help="questions are asked in the window of the pictures")
    p.add_argument("--live", nargs="?", const="0", metavar="PORT", help="questions are asked on the live page; its address, that of the participant and yours, is printed")
    p.add_argument("--listen", action="store_true", help="plays on the real sound card, too")
    p.add_argument("--device", help="the haptic device of the participant, as scripts/run --device has it; default: the apparatus' own hand")
    p.add_argument("--set", action="append", default=[], metavar="NODE.NAME=VALUE", help="a setting of the cluster; may be repeated")
    p.add_argument("--most", type=int, help="ends after so many trials; the same command goes on later")
    p.add_argument("--json", metavar="FILE", help="writes what is printed at the end here, too")
    a = p.parse_args(words)
    if not a.participant.replace("-", "").replace("_", "").isalnum() or len(a.participant) > 40:
        raise Refusal(f"--participant {a.participant}: give a name of letters, digits, - and _, for example P01")
    if a.session < 1:
        raise Refusal(f"--session {a.session}: sessions are counted from 1")
    if a.seed is not None and not 0 <= a.seed < 2**32:
        raise Refusal(f"--seed {a.seed}: is not from 0 to {2**32 - 1}")
    if not (a.simulated or a.window or a.live is not None):
        raise Refusal("nobody could be asked: give --window, --live or --simulated")
    if a.window and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise Refusal("--window needs a display and neither DISPLAY nor WAYLAND_DISPLAY is set; give --live, and open the page elsewhere")
    return a


def main(words):
    terminal.prepare()
    try:
        options = parsed(words)
        study = study_file.read(options.study)
        if options.simulated and study.task != "game" and any(study.observer(c) is None for c in study.conditions):
            raise Refusal(f"{options.study}: has no <observer> for {next(c.id for c in study.conditions if study.observer(c) is None)}; a simulated participant needs one")
        return session.lead(study, options)
    except Refusal as refusal:
        terminal.complain(f"study: {refusal}")
    except OSError as error:
        terminal.complain(f"study: {sentence_of(error)}")
    except KeyboardInterrupt:
        terminal.complain("study: interrupted; the same command goes on with the next trial")
        return 130
    return 1
