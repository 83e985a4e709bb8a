"""The parser of command lines: an invalid argument ends the command with one sentence and exit status 1."""
import argparse
import sys


class OptionParser(argparse.ArgumentParser):
    """prog: the words of the command, for example "tactus report"."""

    def error(self, message):
        sys.exit(f"{self.prog.removeprefix('tactus ')}: {message}; see {self.prog} --help")
