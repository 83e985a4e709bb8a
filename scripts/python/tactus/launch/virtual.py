"""A run in virtual time: all nodes in one process, as fast as possible."""
import json
import os
import signal
import subprocess
import time

from tactus.launch import arguments, cluster, delays, privileges
from tactus.launch.results import WORLD_STOPPED, git_commit, summarise
from tactus.paths import remedy
from tactus.refusal import Refusal, reason_of
from tactus.terminal import report_error, report_run

POLL_S = 0.1
PROGRAMS = ("virtual_time", "summarise", "export_csv", "export_events")


def commands(plan, git):
    """{name: command line} of every node, as in a live run but without pictures; the run id comes from the seed, not from the clock."""
    words = cluster.commands(plan, plan.seed + 1, git)
    for name in words:
        if plan.program(name) == "visual_node":
            words[name].append("--no-pictures")
    return words


def as_json(word):
    """The word, or its bytes when it is not UTF-8, such as the name of a folder."""
    try:
        word.encode()
        return word
    except UnicodeEncodeError:
        return {"hex": os.fsencode(word).hex()}


def run(plan, stop, claim_out, kept=privileges.KEPT):
    """Executes one run in the folder that claim_out locks. kept: the capabilities that the nodes of root keep. Returns the errors, one sentence each. Raises Refusal when it does not start."""
    for name in [*dict.fromkeys(plan.program(n) for n in plan.nodes()), *PROGRAMS]:
        if not os.access(cluster.BIN / name, os.X_OK):
            raise Refusal(f"{name}: {cluster.BIN / name} is missing; {remedy()}")
    git = git_commit()
    words = commands(plan, git)
    cluster.check(words, stop, kept)
    for name in arguments.unknown_modalities(plan):
        report_run(f"{name!r} is not a modality of this run; check the names in the profile and in --soa")
    claim = claim_out(plan)
    for name in words:  # claim_out may have chosen another folder
        words[name][words[name].index("--out") + 1] = str(plan.out)
    (plan.out / "logs").mkdir(mode=0o700, exist_ok=True)
    plan_file = plan.out / "logs" / "virtual_time.json"
    plan_file.write_text(json.dumps({name: [*map(as_json, command)] for name, command in words.items()}, indent=1) + "\n", encoding="utf-8")
    report_run(f"{plan.scene.name}, {plan.seconds:g} s of virtual time, seed {plan.seed}, without pictures, results in {plan.out}")
    errors = play(plan, plan_file, stop, kept)
    warnings = [f"ended by {stop.reason} before {plan.seconds:g} s of virtual time were over"] if stop.requested else []
    for warning in warnings:
        report_run(warning)
    errors += summarise(plan, git, set(), {}, warnings)
    report_run(f"results in {plan.out}")
    os.close(claim)
    return errors


def play(plan, plan_file, stop, kept):
    """Runs virtual_time and prints its progress. Returns the errors."""
    command = [str(cluster.BIN / "virtual_time"), str(plan_file), "--seconds", f"{plan.seconds:g}", "--seed", str(plan.seed),
               "--last-presentations", f"{delays.longest_s(plan):g}", *plan.virtual]
    log = plan.out / "logs" / "virtual_time.log"
    with open(log, "w", encoding="utf-8") as log_file, open(log, encoding="utf-8", errors="replace") as output:
        process = subprocess.Popen(privileges.least(command, kept), stdin=subprocess.DEVNULL, stdout=log_file, stderr=log_file, start_new_session=True,
                                   preexec_fn=cluster.die_with_parent)
        forwarded = False
        while process.poll() is None:
            if stop.requested and not forwarded:
                process.send_signal(signal.SIGTERM)
                forwarded = True
            forward_output(output)
            time.sleep(POLL_S)
        forward_output(output)
    if process.returncode == 0:
        return []
    return [f"virtual_time: ended with status {process.returncode} ({reason(log.read_text(encoding='utf-8', errors='replace'))}); see {log}"]


def reason(said):
    """The line of an output that names why it ended: that of a world that stopped, otherwise that of the node that ended."""
    lines = said.strip().split("\n")
    return next((line for line in reversed(lines) if WORLD_STOPPED in line), reason_of(said))


def forward_output(output):
    """Prints the lines of virtual_time itself; the output of its nodes stays in the log."""
    for line in output:
        if line.startswith("virtual_time:"):
            report_error(line.rstrip("\n"))
