"""Arguments, errors and JSON files of the commands."""
import argparse
import json
import os
import pathlib
import sys

from tactus.refusal import Refusal, sentence_of

SKIPPED = 77  # exit status of a measurement that the system does not permit


class Skipped(Exception):
    """The system does not permit the measurement; one sentence."""


class Parser(argparse.ArgumentParser):
    """Prints the docstring of the command as help. Every command has --json; commands that start programs of the build have --bin."""

    def __init__(self, description, starts_programs=True):
        super().__init__(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
        self.starts_programs = starts_programs

    def parse(self):
        """The options. With --bin the command restarts, because the modules of tactus read TACTUS_BIN when they are imported."""
        self.add_argument("--json", metavar="FILE", help="also write the figures to FILE")
        if self.starts_programs:
            self.add_argument("--bin", metavar="DIR", help="folder of the programs (default: $TACTUS_BIN, then build/dev/bin)")
        options = self.parse_args()
        if getattr(options, "bin", None):
            folder = os.path.abspath(options.bin)
            if not os.path.isdir(folder):
                self.error(f"there is no folder {folder}; name the programs of a build with --bin")
            if os.environ.get("TACTUS_BIN") != folder:
                os.environ["TACTUS_BIN"] = folder
                sys.stdout.flush()
                os.execv(sys.executable, sys.orig_argv)
        return options

    def numbers(self, option, text, kind=float):
        """The numbers of a list with commas, such as 1,8,64."""
        try:
            return [kind(word) for word in text.split(",")]
        except ValueError:
            self.error(f"{option} {text}: give numbers separated by commas, for example 1,8,64")


def write_json(path, figures, **options):
    """Writes the figures as JSON; nothing without a path. Raises Refusal."""
    if path:
        try:
            pathlib.Path(path).write_text(json.dumps(figures, indent=1, **options) + "\n", encoding="utf-8")
        except OSError as error:
            raise Refusal(f"cannot write {sentence_of(error)}; choose another --json") from error


def run(main):
    """Ends the process with the status of main(). An error of the user or the system is printed as one sentence."""
    name = os.path.basename(sys.argv[0])
    try:
        sys.exit(main())
    except Skipped as reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    except Refusal as error:
        sys.exit(f"{name}: {error}")
    except KeyboardInterrupt:
        sys.exit(f"{name}: interrupted")
