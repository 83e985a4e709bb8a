"""The command `tactus live`: the live page of a log, and a client without a browser."""
import importlib

from tactus.commands import prepare

VERBS = {"open": "tactus.commands.live_open", "follow": "tactus.commands.live_follow"}
USAGE = """Usage: tactus live VERB ...

  open LOG [--http-port N]     shows a log in a web page with a seek bar; for a run: tactus run --live
  follow URL [option]...       connects to a live page without a browser, and counts frames, values and pictures

tactus live VERB --help describes a verb."""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.print_usage(USAGE, requested=bool(words))
    verb, *words = words
    if verb not in VERBS:
        return prepare.refuse("live", f"there is no verb '{verb}'; choose from {', '.join(VERBS)}")
    return importlib.import_module(VERBS[verb]).main(words)
