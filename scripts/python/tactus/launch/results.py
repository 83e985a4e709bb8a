"""Results of a run: the commit, and the summary and tables made from its log."""
import os
import subprocess

from tactus import terminal
from tactus.launch import privileges
from tactus.paths import BIN, INSTALLED, REPOSITORY

# In the sentence of a world whose state is not finite (sim_node/world/simulation.cpp).
WORLD_STOPPED = "so the world stops"


def git_commit():
    """The commit of this installation, or of this repository, with + for modified files; "unknown" without git. A repository that contains this one, or that the variables
    of git name, is another."""
    if INSTALLED:
        return INSTALLED["commit"]
    git = ["git", "-c", "safe.directory=*", "-C", str(REPOSITORY)]
    variables = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    variables["GIT_CEILING_DIRECTORIES"] = str(REPOSITORY.parent)
    try:
        git_output = lambda *words: subprocess.run([*git, *words], capture_output=True, check=True, text=True, errors="replace",
                                             start_new_session=True, env=variables).stdout
        commit, changed = git_output("rev-parse", "HEAD").strip(), git_output("status", "--porcelain", "-uno")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return commit + ("+" if changed.strip() else "")


def summarise(plan, git, lost, restarts, warnings):
    """Writes summary.json and the CSV tables from the log. lost: the nodes that are not expected at the end of the log.
    Returns the errors, one sentence each."""
    if not any(plan.out.glob("run*.lcmlog")):
        return [f"recorder: {plan.out}/run.lcmlog was not written; see {plan.out}/logs/recorder.log"]
    expected = [name for name in plan.nodes() if name not in lost]
    summary_command = [str(BIN / "summarise"), str(plan.out), "--out", str(plan.out / "summary.json"), "--nodes", ",".join(expected),
                       "--seconds", f"{plan.seconds:g}", "--scene", str(plan.scene), "--seed", str(plan.seed), "--git", git,
                       *(word for name, count in restarts.items() for word in ("--restarts", f"{name}={count}")),
                       *(word for sentence in warnings for word in ("--warning", sentence))]
    exports = [[str(BIN / name), str(plan.out), "--out", str(plan.out), "--quiet"] for name in ("export_csv", "export_events")]
    # All results are written before the first is printed. A second Ctrl-C does not reach these programs.
    kept = privileges.needed([BIN, plan.out])
    all_done = [subprocess.run(privileges.least(words, kept), capture_output=True, text=True, errors="replace", check=False, start_new_session=True)
                for words in (summary_command, *exports)]
    terminal.report(all_done[0].stdout.rstrip("\n"))
    errors = []
    for words, done in zip((summary_command, *exports), all_done):
        name = os.path.basename(words[0])
        if done.returncode != 0:
            errors.append(done.stderr.strip().split("\n")[-1] or f"{name}: ended with status {done.returncode}")
        elif done.stderr:
            terminal.report_error(done.stderr.rstrip("\n"))
    return errors
