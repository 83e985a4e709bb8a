"""What scripts/run does once all is built: checks, starts, shows, stops, sums up."""
import fcntl
import os
import signal
import subprocess
import sys
import time

import arguments
import cluster
import network
import priority
import services
from refusal import Refusal


class Stop:
    """Set by Ctrl-C and its like; looked at by the loop."""

    def __init__(self):
        self.asked = False
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.ask)

    def ask(self, *_):
        self.asked = True


def git_commit():
    """The commit of this repository, with + when files differ from it; "unknown" without git."""
    git = ["git", "-c", "safe.directory=*", "-C", str(arguments.REPOSITORY)]
    try:
        commit = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
        changed = subprocess.run([*git, "status", "--porcelain", "-uno"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return commit + ("+" if changed.strip() else "")


def say(text):
    print(f"run: {text}", flush=True)


def watch_over(running, seconds, stop):
    """Returns after `seconds`, or earlier when asked to. Names each node that is lost as it happens."""
    end = time.monotonic() + seconds
    named = set()
    while not stop.asked and time.monotonic() < end:
        if not running.alive():
            raise Refusal(f"supervisor: ended before its time; see {running.plan.out}/logs/supervisor.log")
        for name, why in running.lost().items():
            if name not in named:
                named.add(name)
                say(f"{name}: {why}; the others go on ({running.services[name].last_words()})")
        time.sleep(0.1)


def sum_up(plan, git, lost, restarts):
    """Writes summary.json and the CSVs from the log. Returns what went wrong, a sentence each."""
    logs = [str(path) for path in sorted(plan.out.glob("run*.lcmlog"), key=lambda p: p.stat().st_mtime)]
    if not logs:
        return [f"recorder: {plan.out}/run.lcmlog was not written; see {plan.out}/logs/recorder.log"]
    kept = [name for name in plan.nodes() if name not in lost]
    summarise = [str(cluster.BIN / "summarise"), *logs, "--out", str(plan.out / "summary.json"), "--nodes", ",".join(kept),
                 "--seconds", f"{plan.seconds:g}", "--scene", str(plan.scene), "--seed", str(plan.seed), "--git", git,
                 *(word for name, count in restarts.items() for word in ("--restarts", f"{name}={count}"))]
    wrong = []
    for words in (summarise, [str(cluster.BIN / "export_csv"), *logs, "--out", str(plan.out)]):
        done = subprocess.run(words, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            wrong.append(done.stderr.strip().split("\n")[-1] or f"{words[0]}: ended with status {done.returncode}")
        else:
            sys.stderr.write(done.stderr)
    return wrong


def claim_out(plan):
    """Makes the folder of the results and keeps others out of it until the descriptor returned is closed, or this process
    is no more: of two runs that start in the same second the later takes the next name. Raises Refusal."""
    while True:
        try:
            plan.out.mkdir(parents=True, exist_ok=not plan.out_is_ours)
            claim = os.open(plan.out, os.O_RDONLY | os.O_DIRECTORY)
        except FileExistsError:
            plan.out = plan.out.with_name(plan.out.name + "+")
            continue
        except OSError as error:
            raise Refusal(f"recorder: the folder {plan.out} cannot be made ({error.strerror}); name another with --out") from None
        try:
            fcntl.flock(claim, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(claim)
            raise Refusal(f"recorder: another run is writing to --out {plan.out}; name another folder") from None
        except OSError:
            pass  # a file system without locks
        return claim


def run(plan):
    """One run. Returns what went wrong, a sentence each. Raises Refusal when it does not start."""
    stop = Stop()
    git = git_commit()
    run_id = time.time_ns()
    for name in [*plan.nodes(), "watch", "summarise", "export_csv"]:
        if not os.access(cluster.BIN / name, os.X_OK):
            raise Refusal(f"{name}: {cluster.BIN / name} is not built; run scripts/build")
    cluster.check(cluster.commands(plan, run_id, git))
    expectation = priority.expectation(plan.realtime)
    net = network.choose(plan.network, plan.port)
    services.remove_leftovers()
    claim = claim_out(plan)
    running = cluster.Cluster(plan, net, cluster.commands(plan, run_id, git), run_id)
    say(f"{plan.scene.name}, {plan.seconds:g} s, seed {plan.seed}, network {net.how}, results in {plan.out}")
    say(expectation)
    wrong = []
    try:
        running.start()
        running.show_table()
        watch_over(running, plan.seconds, stop)
    except Refusal as refusal:
        wrong.append(str(refusal))
    finally:
        running.end_table()
        say("stopping")
        stubborn = running.stop()
        lost = running.lost()
        restarts = {name: s.deaths() for name, s in running.services.items() if s.deaths()}
        words_of = {name: running.services[name].last_words() for name in lost}
        running.clean()
    wrong += [f"{name}: could not be kept running: {why} ({words_of[name]}); see {plan.out}/logs/{name}.log"
              for name, why in lost.items()]
    wrong += [f"{name}: did not end when asked and was killed; see {plan.out}/logs/{name}.log" for name in stubborn]
    for name, count in restarts.items():
        if name not in lost:
            say(f"{name} died and was started again, {count} times in all" if count > 1 else f"{name} died once and was started again")
    wrong += sum_up(plan, git, lost, restarts)
    say(f"results in {plan.out}")
    os.close(claim)
    return wrong


def names_its_speaker(sentence):
    speaker = sentence.split(":")[0]
    return speaker.endswith("_node") or speaker in ("recorder", "network", "supervision", "supervisor", "summarise", "export_csv")


def main(words):
    only_arguments = words[:1] == ["--arguments-only"]
    try:
        plan = arguments.parse(words[1:] if only_arguments else words, os.getcwd())
        wrong = [] if only_arguments else run(plan)
    except Refusal as refusal:
        wrong = [str(refusal)]
    for sentence in wrong:
        print(sentence if names_its_speaker(sentence) else f"run: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
