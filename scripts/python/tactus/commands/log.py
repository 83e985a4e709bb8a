"""Commands about recordings: `tactus log upgrade`."""
import os

from tactus.commands import prepare

USAGE = """Usage: tactus log upgrade OLD NEW

Converts a recording to the message types of this release, so that replay, rerender, export and report read it. The values,
the time stamps and the order of the messages stay the same. Renamed fields get their new names, numbers that are more precise
now get their new form, and new fields say that their value is not known. A log whose messages have other fields is refused.

  OLD      run.lcmlog of a run, or its folder: all parts of its recording. It is not changed.
  NEW      name of the converted log; must not exist
  --help   this text

Example: tactus log upgrade out/2026-01-31_120000 old_run.lcmlog"""


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(USAGE)
    if len(words) != 3 or words[0] != "upgrade":
        return prepare.refuse("tactus log", "give `upgrade`, the log and the name of the new log; see tactus log --help")
    old, new = words[1:]
    if os.path.exists(new):
        return prepare.refuse("tactus log", f"{new} exists already; give the name of a new file")
    program = prepare.program("upgrade_log")
    prepare.replace_process([program, old, new])
