"""The command line of tactus cluster."""
import argparse
import json
import os
import pathlib
import sys
import time

from tactus import own_files, terminal
from tactus.refusal import Refusal, sentence_of
from tactus.terminal import report

LAB = "TACTUS_LAB"
PERIOD_S = 1.0
BUS_PROGRAMS = ("degrade", "playout", "set")
MAX_FILE_CHARACTERS = 65536  # kMaxProfileBytes of sync/degradation/profile_exchange.h
MAX_LINES = 100_000


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus cluster --help")


def parsed(words):
    parser = Parser(add_help=False, allow_abbrev=False, prog="cluster")
    commands = parser.add_subparsers(dest="command", required=True, parser_class=Parser)
    def command(name, *arguments):
        c = commands.add_parser(name, add_help=False, allow_abbrev=False)
        c.add_argument("--file")
        c.add_argument("--ssh-config")
        for flags, options in arguments:
            c.add_argument(*flags, **options)
    flag = {"action": "store_true"}
    command("up", (["name"], {"nargs": "?"}))
    command("check", (["name"], {"nargs": "?"}))
    command("down", (["--out"], {}))
    command("status", (["--once"], flag), (["--json"], {"nargs": "?", "const": "/dev/stdout"}))
    command("logs", (["nodes"], {"nargs": "*"}), (["--lines"], {"type": int, "default": 10}), (["--follow"], flag))
    command("restart", (["node"], {}))
    command("move", (["node"], {}), (["host"], {}), (["--restart"], flag), (["--lost"], flag), (["--shaders"], flag))
    for name in BUS_PROGRAMS:
        command(name, (["words"], {"nargs": argparse.REMAINDER}))
    command("doctor", (["--seconds"], {"type": float, "default": 5.0}), (["--json"], {}))
    a = parser.parse_args(words)
    if getattr(a, "name", None) and a.file:
        raise Refusal("the cluster file is given twice, as an argument and with --file; remove one")
    if a.command == "logs" and not 0 <= a.lines <= MAX_LINES:
        raise Refusal(f"--lines {a.lines}: give a number from 0 to {MAX_LINES}")
    return a


def last_file_path():
    """Path of the file that holds the cluster file of the last up."""
    return pathlib.Path(os.environ.get("XDG_STATE_HOME") or "~/.local/state").expanduser() / "tactus" / "cluster"


def cluster_file_name(a):
    named = getattr(a, "name", None) or a.file or os.environ.get("TACTUS_CLUSTER")
    if named:
        return named
    if pathlib.Path("cluster.xml").is_file():
        # A cluster file is as powerful as a script: it names programs, options and environments for its hosts, this machine among them.
        if own_files.owner("cluster.xml") not in (0, os.geteuid()):
            raise Refusal("cluster.xml in this folder belongs to another user, and a cluster file can run any program; read it, and name it with --file if you "
                          "trust it")
        return "cluster.xml"
    try:
        return last_file_path().read_text(encoding="utf-8").strip()
    except OSError:
        raise Refusal("no cluster file is named, and there is no cluster.xml here; give one with --file, or the name of a shipped file: "
                      "one_machine, desk_and_sound, cave4, cave6") from None


def remember(path):
    try:
        own_files.make_private_folder(last_file_path().parent)
        last_file_path().write_text(str(path), encoding="utf-8")
    except (OSError, Refusal):
        pass  # the next command then needs --file


def operator_of(a, cluster):
    from tactus.cluster.cluster_operator import Operator
    config = a.ssh_config or (os.path.join(os.environ[LAB], "ssh_config") if LAB in os.environ else None)
    if config and not os.path.isfile(config):
        raise Refusal(f"--ssh-config {config}: is not a file; give the path of an ssh configuration")
    return Operator(cluster, config)


def up(a, cluster):
    from tactus.launch import results
    operator = operator_of(a, cluster)
    begin = time.monotonic()
    remember(cluster.path)
    unreachable = operator.up(results.git_commit())
    if not operator.wait_for_world():
        raise Refusal("sim_node: its world has not begun after 10 minutes; see tactus cluster logs sim_node")
    operator.report(f"{cluster.name} runs on {len(cluster.hosts) - len(unreachable)} of {len(cluster.hosts)} hosts, {time.monotonic() - begin:.1f} s after the command")
    return []


def down(a, cluster):
    from tactus.launch import results
    out = pathlib.Path(a.out) if a.out else pathlib.Path("out") / time.strftime("%Y-%m-%d_%H-%M-%S")
    if out.is_file() or out.is_dir() and any(out.iterdir()):
        raise Refusal(f"--out {out}: already exists; choose another folder")
    operator = operator_of(a, cluster)
    errors, ran = operator.down(out.absolute())
    if ran:
        errors += operator.summarise(out.absolute(), results.git_commit(), **ran)
    if out.is_dir():
        operator.report(f"results in {out}")
    return errors


def status(a, cluster):
    from tactus.cluster import status as table
    operator = operator_of(a, cluster)
    live = not a.once and sys.stdout is not None and sys.stdout.isatty()
    while True:
        begin = time.monotonic()
        states, bus = table.query(operator)
        found = table.rows(cluster, states, bus)
        if a.json:
            with open(a.json, "a", encoding="utf-8") as file:
                print(json.dumps({"cluster": cluster.name, "whole": table.all_running(cluster, states, bus), "nodes": found}), file=file)
        else:
            if live:
                os.write(1, b"\x1b[H\x1b[2J")  # cursor home, clear the screen
            report(table.text(found, os.get_terminal_size().columns if live else 160))
        if not live:
            return [] if any(r.get("process") == "up" for r in found) else [f"no node of {cluster.name} runs; start it with tactus cluster up"]
        time.sleep(max(0.0, PERIOD_S - (time.monotonic() - begin)))


def logs(a, cluster):
    operator = operator_of(a, cluster)
    for name in a.nodes:
        if name not in cluster.nodes and name != "supervisor":
            raise Refusal(f"{name}: there is no such node in {cluster.name}; there are {', '.join(cluster.nodes)}")
    offsets = {}
    while True:
        answers = operator.request_all("logs", names=a.nodes, lines=a.lines, offsets=lambda h: offsets.get(h, {}))
        for host, answer in answers.items():
            if isinstance(answer, Exception):
                terminal.report_error(f"cluster: {answer}")
                continue
            for node, part in answer.items():
                for line in part["lines"]:
                    report(f"{host} {node}: {line}")
                offsets.setdefault(host, {})[node] = part["offset"]
        if not a.follow:
            return []
        time.sleep(PERIOD_S)


def restart(a, cluster):
    operator_of(a, cluster).restart(a.node)
    return []


def move(a, cluster):
    operator_of(a, cluster).move(a.node, a.host, a.restart, a.lost, a.shaders)
    return []


def run_bus_program(a, cluster):
    """Runs degrade, playout or set on a host of the cluster; copies a profile there."""
    words, files = [a.command], {}
    for word in a.words:
        if a.command == "degrade" and os.path.isfile(word):
            files["told.xml"] = pathlib.Path(word).read_text(encoding="utf-8", errors="replace")
            if len(files["told.xml"]) > MAX_FILE_CHARACTERS:
                raise Refusal(f"{word}: is longer than {MAX_FILE_CHARACTERS} bytes; this cannot be a profile; give a smaller file")
            word = "@FILES@/told.xml"
        words.append(word)
    result = operator_of(a, cluster).run_bus_program(words, files)
    report(result["out"].rstrip("\n"))
    return [] if result["status"] == 0 else [(result["err"].strip().splitlines() or ["it ended with status " + str(result["status"])])[-1]]


def doctor(a, cluster):
    from tactus.cluster import checkup
    if not 0.5 <= a.seconds <= 600:
        raise Refusal(f"--seconds {a.seconds:g}: give a number from 0.5 to 600")
    figures, errors = checkup.run(operator_of(a, cluster), a.seconds)
    if a.json:
        pathlib.Path(a.json).write_text(json.dumps(figures, indent=1), encoding="utf-8")
    report("" if errors else "\nno fault found")
    return errors


def check(_, cluster):
    report(f"cluster: {cluster.name} is valid: {len(cluster.nodes)} nodes on {len(cluster.hosts)} hosts, {cluster.bus.group}:{cluster.bus.port}, ttl {cluster.bus.ttl}")
    return []


def main(words):
    terminal.prepare()
    try:
        from tactus.cluster.host_connection import Failed, Unreachable
        a = parsed(words)
        from tactus.cluster import cluster_file
        cluster = cluster_file.read(cluster_file_name(a), os.path.abspath(os.path.join("out", f"cluster-{os.getpid()}")))
        try:
            errors = {"up": up, "down": down, "status": status, "logs": logs, "restart": restart, "move": move, "check": check, "doctor": doctor, **{name: run_bus_program for name in BUS_PROGRAMS}}[a.command](a, cluster)
        except (Failed, Unreachable) as error:
            raise Refusal(str(error)) from None
    except Refusal as refusal:
        errors = [str(refusal)]
    except OSError as error:
        errors = [sentence_of(error)]
    for sentence in errors:
        terminal.report_refusal(f"cluster: {sentence}")
    return 1 if errors else 0
