"""Applies a degradation profile to a running cluster, or removes it."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command

USAGE = """Usage: tactus degrade PROFILE.xml|off [OUT_DIR]

Applies the degradation profile to the running cluster that writes to OUT_DIR; default: the cluster that was started last.
"off" removes it. Prints the modalities that applied it, and since which simulation time."""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.print_usage(USAGE, requested=bool(words))
    if words[0].startswith("-"):
        return prepare.refuse("degrade", f"unknown option '{words[0]}'; see tactus degrade --help")
    if len(words) > 2:
        return prepare.refuse("degrade", "too many arguments; see tactus degrade --help")
    profile, *folder = words
    if profile != "off" and not os.path.isfile(profile):
        return prepare.refuse("degrade", f"the profile {profile} is not a file; give the path of an XML file, or off")
    if folder and not os.path.isdir(folder[0]):
        return prepare.refuse("degrade", f"the folder {folder[0]} does not exist; name the folder that a run writes to")
    prepare.replace_process([*tactus_command("attach"), *map(os.path.realpath, folder), "degrade", profile])
