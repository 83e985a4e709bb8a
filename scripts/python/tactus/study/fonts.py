"""Fonts for the texts of a study: a character that no installed font covers is named before a participant sees it."""
import subprocess
import unicodedata

from tactus.commands import prepare
from tactus.paths import BIN, packages_remedy, remedy
from tactus.refusal import Refusal
from tactus.terminal import report

TIMEOUT_S = 60
MAX_NAMED = 3


def shown(study):
    """All texts that the participant may see, in the order of the file."""
    questions = [study.question, *study.choices]
    for item in study.questionnaire:
        questions += [item.text, *item.choices]
    return [*study.instructions, *study.phrases.values(), *questions]


def uncovered(lines):
    """Characters of these texts that no installed font covers; None: this is not known, because the program draw_text is not built. Raises Refusal."""
    lines = [line for line in lines if not line.isascii()]
    if not lines:
        return []
    if not (BIN / "draw_text").is_file():
        return None
    try:
        done = subprocess.run([BIN / "draw_text", "--check"], input="\n".join(lines).encode(), capture_output=True, timeout=TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        raise Refusal(f"the fonts for the texts of the study are not checked within {TIMEOUT_S} s; shorten the texts") from None
    if done.returncode:
        said = done.stderr.decode(errors="replace").strip().splitlines() or [f"draw_text: ended with {done.returncode}"]
        raise Refusal(f"{said[-1]}; {packages_remedy('fonts')} and {remedy()}")
    return [chr(int(line[2:], 16)) for line in done.stdout.decode().split()]


def names(characters):
    """The characters in words: the first of them with code and name."""
    named = [f"{c} (U+{ord(c):04X} {unicodedata.name(c, 'without a name')})" for c in characters[:MAX_NAMED]]
    more = len(characters) - len(named)
    return ", ".join(named) + (f" and {more} other character{'s' if more > 1 else ''}" if more else "")


def words(study):
    """[a line for tactus study check] if the study has texts beyond ASCII; else []."""
    if all(text.isascii() for text in shown(study)):
        return []
    missing = uncovered(shown(study))
    if missing is None:
        return [f"fonts not checked: draw_text is missing; {remedy()}"]
    if not missing:
        return ["the installed fonts cover all texts"]
    return [f"no installed font covers {names(missing)}; {packages_remedy('fonts')}, or install another font that does"]


def provide(study, window):
    """Installs the group of fonts if the installed ones do not cover the texts. window: the window of this machine shows them; then a character without a font is
    a Refusal. A page uses the fonts of its own machine, and reports what they lack."""
    missing = uncovered(shown(study))
    if not missing:
        return
    prepare.install("fonts")
    missing = uncovered(shown(study))
    if not missing:
        return
    sentence = f"{study.path}: no installed font covers {names(missing)}; install one that does"
    if window:
        raise Refusal(sentence)
    report(f"study: {sentence} on the machine of the page")
