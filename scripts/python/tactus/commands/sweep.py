"""The command `tactus sweep`: the same as `tactus study sweep`."""
from tactus.commands import study


def main(words):
    return study.main(["sweep", *words])
