"""Runs a program that sends a request to a running cluster, with the arguments of the command of the same name."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command


def main(program, usage, words, may_be_none=False, command=""):
    """words: the arguments; "--in OUT_DIR", at any position, selects the cluster; default: the cluster that was started last.
    may_be_none: the program accepts a call without other arguments. command: of tactus, if its name differs from that of the program. Returns an exit status, or does not return."""
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(usage)
    folder, rest, words, command = [], [], list(words), command or program
    while words:
        word = words.pop(0)
        if word != "--in":
            rest.append(word)
            continue
        if not words:
            return prepare.refuse(command, f"--in needs the folder that a run writes to; see tactus {command} --help")
        if not os.path.isdir(words[0]):
            return prepare.refuse(command, f"the folder {words[0]} does not exist; name the folder that a run writes to")
        folder = [os.path.realpath(words.pop(0))]
    if not rest and not may_be_none:
        return prepare.print_usage(usage, requested=False)
    prepare.replace_process([*tactus_command("attach"), *folder, program, *rest])
