"""Properties of every answer to a changed input: no crash, no NaN, no silence. Each check returns the violations as sentences."""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import subprocess

LIMIT_S = 60  # of one program; the inputs are small
RUN_S = 0.2  # of simulated time
NODES = ("recorder", "sync_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "sim_node")
NAN = re.compile(rb"(?i)(?<![a-z_.])[-+]?(nan|inf|infinity)(?![a-z_])")
# Words of libraries and of the compiler, which say nothing to a user.
RAW = re.compile(r"terminate called|what\(\)|std::|basic_string|vector::|json\.exception|XML_ERROR|bad_alloc|bad_optional|filesystem error|invalid primitive type|"
                 r"Assertion|Traceback|Segmentation|runtime error:|stoi|stod")
QUIET = {"LC_ALL": "C", "ASAN_OPTIONS": "abort_on_error=1"}


class Answer:
    """The answer of a program: status, output, lines of stderr."""

    def __init__(self, words):
        self.name = pathlib.Path(words[0]).name
        try:
            done = subprocess.run([str(word) for word in words], stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT_S, check=False, env={**os.environ, **QUIET})
            self.status, self.out, self.err = done.returncode, done.stdout, done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired as end:
            self.status, self.out, self.err = None, end.stdout or b"", (end.stderr or b"").decode(errors="replace")
        self.lines = [line for line in self.err.splitlines() if line.strip()]

    def crashes(self):
        if self.status is None:
            return [f"{self.name} did not end within {LIMIT_S} s"]
        if self.status < 0 or self.status > 128:
            return [f"{self.name} died by signal {-self.status if self.status < 0 else self.status - 128}: {self.last()}"]
        return []

    def last(self):
        return self.lines[-1][:300] if self.lines else "no output"

    def raw_words(self):
        return [f"{self.name} prints words of a library: {line[:300]}" for line in self.lines if RAW.search(line)][:1]


def refusal_faults(answer, *names):
    """A refusal has status 1, and its last line is one sentence that names one of the files. Lines before it are warnings."""
    faults = []
    if answer.status != 1:
        faults.append(f"{answer.name} ends with status {answer.status}: {answer.last()}")
    if not answer.lines:
        return [*faults, f"{answer.name} refuses its input in silence"]
    sentence = answer.lines[-1]
    if not sentence.startswith(f"{answer.name}: ") or len(sentence) < len(answer.name) + 20:
        faults.append(f"{answer.name} prints no sentence: {sentence[:300]}")
    if not any(name in sentence for name in names):
        faults.append(f"{answer.name} does not name the file: {sentence[:300]}")
    return faults


def nan_faults(path):
    """A text file with a number that is not finite."""
    match = NAN.search(path.read_bytes())
    return [f"{path.name} holds {match.group(0).decode()}"] if match else []


def table_faults(folder):
    """Tables with a value that is not finite. Texts, such as the name of a body, may be any words."""
    faults = []
    for path in sorted(folder.glob("*.csv")):
        if not NAN.search(path.read_bytes()):
            continue
        with open(path, encoding="utf-8", newline="", errors="replace") as file:
            for row in csv.DictReader(line.replace("\0", "") for line in file):
                found = [name for name, cell in row.items() if isinstance(cell, str) and not_finite(cell) and (name != "value" or row.get("unit") or "." in row.get("field", ""))]
                if found:
                    faults.append(f"{path.name} holds {row[found[0]]} as {found[0]}{' of ' + row['field'] if 'field' in row else ''}")
                    break
    return faults


def not_finite(cell):
    try:
        return not math.isfinite(float(cell))
    except ValueError:
        return False


def plan_of(bin_folder, scene, out):
    """The plan of virtual_time: all nodes of a run without pictures."""
    own = {"recorder": ["--scene", str(scene), "--seconds", str(RUN_S)], "audio_node": ["--audio-device", "virtual"], "visual_node": ["--no-pictures"],
           "sim_node": [str(scene), *(word for name in NODES if name != "sim_node" for word in ("--await", name))]}
    common = ["--run-id", "2", "--seed", "1", "--out", str(out)]
    return {name: [str(bin_folder / name), *common, *own.get(name, [])] for name in NODES}


def world_faults(bin_folder, scene, folder, others=(), must_speak=False):
    """(answer class, violations) of a scene: it is refused, it stops, or it runs. others: names of files that a refusal may name instead. must_speak: it
    holds a text that is no number, or a body whose mass is unknown, so it is refused or causes a warning."""
    check = Answer([bin_folder / "sim_node", "--check", scene])
    faults = check.crashes() + check.raw_words()
    if faults:
        return "failed", faults
    if check.status != 0:
        return "refused", refusal_faults(check, scene.name, *others)
    if must_speak and not any(name in line for name in (scene.name, *others) for line in check.lines):
        return "failed", ["the change is accepted in silence"]
    out = folder / "out"
    out.mkdir()
    plan = out / "plan.json"
    plan.write_text(json.dumps(plan_of(bin_folder, scene, out)), encoding="utf-8")
    run = Answer([bin_folder / "virtual_time", plan, "--seconds", RUN_S, "--seed", "1"])
    faults = run.crashes() + run.raw_words()
    if faults:
        return "failed", faults
    kind = "runs"
    if run.status != 0:
        kind = "stops"
        if not any("so the world stops" in line for line in run.lines):
            return "failed", [f"a world that --check accepts ends with status {run.status}: {run.last()}"]
    return kind, run_faults(bin_folder, out, kind == "runs")


def run_faults(bin_folder, out, complete):
    """Violations in the log of a run: a number that is not finite, an expected event that a modality does not present."""
    tables = out / "tables"
    tables.mkdir()
    summary = Answer([bin_folder / "summarise", out, "--out", out / "summary.json"])
    faults = summary.crashes() + [fault for name in ("export_log", "export_events", "export_csv")
                                  for fault in Answer([bin_folder / name, out, "--out", tables, "--quiet"]).crashes()]
    faults += table_faults(tables)
    if (out / "summary.json").exists():
        faults += nan_faults(out / "summary.json")
    else:  # a world that stops at its first step leaves no run
        faults += refusal_faults(summary, "out")
    if complete and (out / "summary.json").exists():
        facts = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        for name, sense in facts["contacts"]["by_modality"].items():
            if sense["expected"] != sense["presented"]:
                faults.append(f"{name} presents {sense['presented']} of {sense['expected']} expected events")
    return faults


def log_faults(bin_folder, log, folder, renderers):
    """(answer class, violations) of a log, in every reader and in these renderers."""
    out = folder / "out"
    out.mkdir()
    describe = Answer([bin_folder / "replay", log, "--describe"])
    commands = [describe, Answer([bin_folder / "summarise", log, "--out", out / "summary.json"])]
    commands += [Answer([bin_folder / name, log, "--out", out]) for name in ("export_log", "export_events", "export_csv")]
    outputs = {"audio_node": ["--wav", out / "audio.wav"], "haptic_node": ["--trace", out / "trace.csv"], "thermal_node": ["--trace", out / "warmth.csv"]}
    commands += [Answer([bin_folder / name, "--log", log, *outputs[name]]) for name in renderers]
    faults = []
    for answer in commands:
        # summarise reports a run that lost events by status 1, with its summary.
        incomplete = answer.name == "summarise" and answer.status == 1 and (out / "summary.json").exists()
        faults += answer.crashes() + answer.raw_words()
        if answer.status not in (0, None) and not incomplete and not answer.crashes():
            faults += refusal_faults(answer, log.name)
    for name in ("summary.json",):
        if (out / name).exists():
            faults += nan_faults(out / name)
    faults += table_faults(out) + sound_faults(out / "audio.wav")
    if describe.status == 0:
        faults += silent_damage(log, json.loads(describe.out))
    return "refused" if describe.status else "read", faults


def silent_damage(log, described):
    """Bytes of a log that belong to no event and are not reported as damage."""
    data, at = log.read_bytes(), 0
    while at + 28 <= len(data) and data[at:at + 4] == b"\xed\xa1\xda\x01":
        name, size = (int.from_bytes(data[at + k:at + k + 4], "big") for k in (20, 24))
        if name > 63 or at + 28 + name + size > len(data):
            break
        at += 28 + name + size
    if at < len(data) and not described.get("damaged_regions") and not described.get("warnings"):
        return [f"replay --describe does not report the {len(data) - at} bytes behind byte {at} as damaged"]
    return []


def sound_faults(wav):
    """A sample that is not finite, in a file of 32-bit floats."""
    if not wav.exists():
        return []
    data = wav.read_bytes()
    at = data.find(b"data") + 8
    samples = memoryview(data[at:at + (len(data) - at) // 4 * 4]).cast("f")
    return [] if all(map(math.isfinite, samples)) else [f"{wav.name} holds a sample that is not finite"]


def remove(folder):
    shutil.rmtree(folder, ignore_errors=True)
