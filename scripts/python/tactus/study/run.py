"""tactus study run: runs a session of one participant on a live cluster."""
import argparse
import os

from tactus import terminal
from tactus.refusal import Refusal, sentence_of
from tactus.study import fonts, study_file, texts

USAGE = """Runs a session of one participant on a live cluster: instructions, trials, questions, breaks. Every trial applies its profile to every
sense, presents its stimulus, and reads the measured presentation times. A trial that misses the tolerance of the study is marked and repeated.
After an interruption, the same command resumes with the next trial."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study run --help")


def parsed(words):
    p = Parser(prog="tactus study run", description=USAGE, allow_abbrev=False)
    p.add_argument("study", help="a study file, or the name of a shipped one")
    p.add_argument("--participant", required=True, help="pseudonym of the participant in letters of any language, for example P01; its number selects the row of the Latin square")
    p.add_argument("--out", default="studies", help="folder of all studies: OUT/STUDY/PARTICIPANT; default: ./studies")
    p.add_argument("--session", type=int, default=1, help="number of the session; sessions from 2 on get their own folder; default: 1")
    p.add_argument("--seed", type=int, help="seed instead of that of the study file")
    p.add_argument("--simulated", action="store_true", help="a simulated participant answers, with the observer of the study file; every row is marked")
    p.add_argument("--window", action="store_true", help="shows the questions in the window of the visual node")
    p.add_argument("--live", nargs="?", const="0", metavar="PORT", help="shows the questions on the live page; prints the addresses for participant and experimenter")
    p.add_argument("--listen", action="store_true", help="also plays on the sound card")
    p.add_argument("--device", help="haptic device of the participant, as for tactus run --device; default: the hand of the apparatus")
    p.add_argument("--set", action="append", default=[], metavar="NODE.NAME=VALUE", help="a setting of the cluster; may be repeated")
    p.add_argument("--most", type=int, help="ends after this number of trials; the same command resumes later")
    p.add_argument("--json", metavar="FILE", help="also writes the final summary to FILE")
    a = p.parse_args(words)
    a.participant = texts.participant_name(a.participant)
    if a.session < 1:
        raise Refusal(f"--session {a.session}: is below 1; sessions count from 1")
    if a.seed is not None and not 0 <= a.seed < 2**32:
        raise Refusal(f"--seed {a.seed}: is not from 0 to {2**32 - 1}")
    if not (a.simulated or a.window or a.live is not None):
        raise Refusal("no way to ask the questions; give --window, --live or --simulated")
    if a.window and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise Refusal("--window needs a display, but neither DISPLAY nor WAYLAND_DISPLAY is set; give --live, and open its page elsewhere")
    return a


def main(words):
    terminal.prepare()
    try:
        options = parsed(words)
        study = study_file.read(options.study)
        if any(c.acts_in_participant for c in study.conditions) and not (options.simulated and study.task == "game"):
            raise Refusal(f"{options.study}: the stage percept acts in the simulated player only, and a person feels the device itself; add --simulated to a study with "
                          'task="game", or use study sweep')
        if options.simulated and study.task != "game" and any(study.observer(c) is None for c in study.conditions):
            raise Refusal(f"{options.study}: has no <observer> for {next(c.id for c in study.conditions if study.observer(c) is None)}; add one, or leave out --simulated")
        if options.window or options.live is not None:
            fonts.provide(study, options.window)
        from tactus.study import session  # loads slowly
        return session.run_session(study, options)
    except Refusal as refusal:
        terminal.report_refusal(f"study: {refusal}")
    except OSError as error:
        terminal.report_error(f"study: {sentence_of(error)}")
    except KeyboardInterrupt:
        terminal.report_error("study: interrupted; the same command resumes with the next trial")
        return 130
    return 1
