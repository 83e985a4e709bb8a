"""The command `tactus cluster`: runs a scene on several hosts. `up` first installs missing packages and builds."""
import pathlib

import tactus.cluster
from tactus.commands import prepare


def main(words):
    if not words or {"--help", "-h"} & set(words):
        usage = pathlib.Path(tactus.cluster.__file__).with_name("usage.txt")
        return prepare.print_usage(usage.read_text(encoding="utf-8").rstrip("\n"), requested=bool(words))
    if words[0] == "up":
        prepare.install_and_build()
    from tactus.cluster import main as operator
    return operator.main(words)
