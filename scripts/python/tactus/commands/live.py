"""The live page: of a log, and without a browser."""
import importlib

from tactus.commands import prepare

VERBS = {"open": "tactus.commands.live_open", "follow": "tactus.commands.live_follow"}
USAGE = """Usage: tactus live VERB ...

  open LOG [--http-port N]     shows a log in a web page, with seek; of a run: scripts/run --live
  follow URL [option]...       opens a live page without a browser, and counts its frames, values and pictures

tactus live VERB --help says more of each."""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.show(USAGE, asked=bool(words))
    verb, *words = words
    if verb not in VERBS:
        return prepare.refuse("live", f"there is no verb '{verb}'; choose from {', '.join(VERBS)}")
    return importlib.import_module(VERBS[verb]).main(words)
