"""Tables of recorded runs."""
import glob
import json
import os
import tempfile

from common import runs
from tactus.refusal import Refusal, sentence_of
from tactus.tables import read_rows


def read_csv(path):
    """Rows of a table as dictionaries. Raises Refusal."""
    try:
        return read_rows(path)
    except OSError as error:
        raise Refusal(f"cannot read {sentence_of(error)}; name the output folder of a run") from error


def read_json(path, remedy):
    """Contents of a JSON file. Raises Refusal with the remedy."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise Refusal(f"cannot read {path} ({error}); {remedy}") from error


def export(out, folder, exporters=("export_events",)):
    """Writes the tables of the log in the output folder of a run into a folder. Raises Refusal."""
    logs = sorted(glob.glob(os.path.join(out, "run*.lcmlog")))
    if not logs:
        raise Refusal(f"{out} holds no run.lcmlog; name the output folder of a run")
    for exporter in exporters:
        runs.output([runs.program(exporter), *logs, "--out", folder])


def tables(out, *names, exporters=("export_events",)):
    """The named tables of the log in the output folder of a run, for example "events". Raises Refusal."""
    with tempfile.TemporaryDirectory() as folder:
        export(out, folder, exporters)
        return [read_csv(os.path.join(folder, name + ".csv")) for name in names]
