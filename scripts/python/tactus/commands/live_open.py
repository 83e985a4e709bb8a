"""The command `tactus live open`: shows a log in a web page."""
from tactus.commands import prepare
from tactus.paths import BIN, INSTALLED, SCRIPTS

USAGE = """Usage: tactus live open LOG [--run N] [--http-port N]

Serves the live page for a log, with a seek bar, and prints its address. Ctrl-C ends it. --run: number of the run, of a log with
several; default: 1."""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.print_usage(USAGE, requested=bool(words))
    if words[0].startswith("-"):
        return prepare.refuse("live open", f"unknown option '{words[0]}'; give the log first; see tactus live open --help")
    prepare.install_and_build("live_server")
    if not INSTALLED:
        prepare.run_script(SCRIPTS / "live" / "bundle")
    prepare.replace_process([str(BIN / "live_server"), *words, "--page", str(SCRIPTS / "live" / "page" / "dist")])
