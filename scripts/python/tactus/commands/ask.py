"""Runs a program that speaks to a running cluster, with the words of the command of the same name."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command


def main(program, usage, words, may_be_none=False):
    """"--in OUT_DIR", anywhere among the words, says which cluster; default: the one that was started last. may_be_none: the program does
    something without any other word."""
    if {"--help", "-h"} & set(words):
        return prepare.show(usage)
    folder, rest, words = [], [], list(words)
    while words:
        word = words.pop(0)
        if word != "--in":
            rest.append(word)
            continue
        if not words:
            return prepare.refuse(program, f"--in needs the folder that a run writes to; see tactus {program} --help")
        if not os.path.isdir(words[0]):
            return prepare.refuse(program, f"the folder {words[0]} is not there; name the folder that a run writes to")
        folder = [os.path.realpath(words.pop(0))]
    if not rest and not may_be_none:
        return prepare.show(usage, asked=False)
    prepare.become([*tactus_command("attach"), *folder, program, *rest])
