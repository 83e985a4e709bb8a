"""Puts a degradation profile in force in a running cluster, or takes it away."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command

USAGE = """Usage: tactus degrade PROFILE.xml|off [OUT_DIR]

Puts the degradation profile in force in the running cluster that writes to OUT_DIR; default: the one that was started last.
"off" takes it away. Says which senses have taken it, and since when in the time of the world."""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.show(USAGE, asked=bool(words))
    if words[0].startswith("-"):
        return prepare.refuse("degrade", f"unknown option '{words[0]}'; see tactus degrade --help")
    if len(words) > 2:
        return prepare.refuse("degrade", "too many arguments; see tactus degrade --help")
    profile, *folder = words
    if profile != "off" and not os.path.isfile(profile):
        return prepare.refuse("degrade", f"the profile {profile} is not a file; give the path of an XML file, or off")
    if folder and not os.path.isdir(folder[0]):
        return prepare.refuse("degrade", f"the folder {folder[0]} is not there; name the folder that a run writes to")
    prepare.become([*tactus_command("attach"), *map(os.path.realpath, folder), "degrade", profile])
