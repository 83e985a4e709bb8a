"""The command line of tactus cluster."""
import argparse
import json
import os
import pathlib
import sys
import time

from tactus import terminal
from tactus.refusal import Refusal, sentence_of
from tactus.terminal import tell

LAB = "TACTUS_LAB"
PERIOD_S = 1.0
TOLD = ("degrade", "playout", "set")
LONGEST_FILE = 65536  # kMaxProfileBytes of sync/degradation/profile_exchange.h
MOST_LINES = 100_000


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
        for flags, how in arguments:
            c.add_argument(*flags, **how)
    flag = {"action": "store_true"}
    command("up", (["name"], {"nargs": "?"}))
    command("check", (["name"], {"nargs": "?"}))
    command("down", (["--out"], {}))
    command("status", (["--once"], flag), (["--json"], flag))
    command("logs", (["nodes"], {"nargs": "*"}), (["--lines"], {"type": int, "default": 10}), (["--follow"], flag))
    command("restart", (["node"], {}))
    command("move", (["node"], {}), (["host"], {}), (["--anew"], flag), (["--lost"], flag))
    for name in TOLD:
        command(name, (["words"], {"nargs": argparse.REMAINDER}))
    command("doctor", (["--seconds"], {"type": float, "default": 5.0}), (["--json"], {}))
    a = parser.parse_args(words)
    if getattr(a, "name", None) and a.file:
        raise Refusal("the cluster file is given twice, as an argument and with --file; remove one")
    if a.command == "logs" and not 0 <= a.lines <= MOST_LINES:
        raise Refusal(f"--lines {a.lines}: give a number from 0 to {MOST_LINES}")
    return a


def memory():
    """Path of the file that holds the cluster file of the last up."""
    return pathlib.Path(os.environ.get("XDG_STATE_HOME") or "~/.local/state").expanduser() / "tactus" / "cluster"


def file_of(a):
    named = getattr(a, "name", None) or a.file or os.environ.get("TACTUS_CLUSTER")
    if named:
        return named
    if pathlib.Path("cluster.xml").is_file():
        return "cluster.xml"
    try:
        return memory().read_text(encoding="utf-8").strip()
    except OSError:
        raise Refusal("no cluster file is named, and there is no cluster.xml here; give one with --file, or the name of a shipped file: "
                      "one_machine, desk_and_sound, cave4, cave6") from None


def remember(path):
    try:
        memory().parent.mkdir(parents=True, exist_ok=True)
        memory().write_text(str(path), encoding="utf-8")
    except OSError:
        pass  # the next command then needs --file


def operator_of(a, cluster):
    from tactus.cluster.orders import Operator
    config = a.ssh_config or (os.path.join(os.environ[LAB], "ssh_config") if LAB in os.environ else None)
    if config and not os.path.isfile(config):
        raise Refusal(f"--ssh-config {config}: is not a file; give the path of an ssh configuration")
    return Operator(cluster, config)


def up(a, cluster):
    from tactus.launch import results
    operator = operator_of(a, cluster)
    begin = time.monotonic()
    remember(cluster.path)
    away = operator.up(results.git_commit())
    if not operator.wait_for_world():
        raise Refusal("sim_node: its world has not begun after 10 minutes; see tactus cluster logs sim_node")
    operator.say(f"{cluster.name} runs on {len(cluster.hosts) - len(away)} of {len(cluster.hosts)} hosts, {time.monotonic() - begin:.1f} s after the command")
    return []


def down(a, cluster):
    from tactus.launch import results
    out = pathlib.Path(a.out) if a.out else pathlib.Path("out") / time.strftime("%Y-%m-%d_%H-%M-%S")
    if out.is_file() or out.is_dir() and any(out.iterdir()):
        raise Refusal(f"--out {out}: already exists; choose another folder")
    operator = operator_of(a, cluster)
    wrong, ran = operator.down(out.absolute())
    if ran:
        wrong += operator.sum_up(out.absolute(), results.git_commit(), **ran)
    if out.is_dir():
        operator.say(f"results in {out}")
    return wrong


def status(a, cluster):
    from tactus.cluster import status as table
    operator = operator_of(a, cluster)
    live = not a.once and sys.stdout is not None and sys.stdout.isatty()
    while True:
        begin = time.monotonic()
        states, bus = table.gather(operator)
        found = table.rows(cluster, states, bus)
        if a.json:
            tell(json.dumps({"cluster": cluster.name, "whole": table.whole(cluster, states, bus), "nodes": found}))
        else:
            if live:
                os.write(1, b"\x1b[H\x1b[2J")  # cursor home, clear the screen
            tell(table.text(found, os.get_terminal_size().columns if live else 160))
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
        answers = operator.ask_all("logs", names=a.nodes, lines=a.lines, offsets=lambda h: offsets.get(h, {}))
        for host, said in answers.items():
            if isinstance(said, Exception):
                terminal.complain(f"cluster: {said}")
                continue
            for node, part in said.items():
                for line in part["lines"]:
                    tell(f"{host} {node}: {line}")
                offsets.setdefault(host, {})[node] = part["offset"]
        if not a.follow:
            return []
        time.sleep(PERIOD_S)


def restart(a, cluster):
    operator_of(a, cluster).restart(a.node)
    return []


def move(a, cluster):
    operator_of(a, cluster).move(a.node, a.host, a.anew, a.lost)
    return []


def tell_program(a, cluster):
    """Runs degrade, playout or set on a host of the cluster; copies a profile there."""
    words, files = [a.command], {}
    for word in a.words:
        if a.command == "degrade" and os.path.isfile(word):
            files["told.xml"] = pathlib.Path(word).read_text(encoding="utf-8", errors="replace")
            if len(files["told.xml"]) > LONGEST_FILE:
                raise Refusal(f"{word}: is longer than {LONGEST_FILE} bytes; this cannot be a profile; give a smaller file")
            word = "@FILES@/told.xml"
        words.append(word)
    said = operator_of(a, cluster).tell(words, files)
    tell(said["out"].rstrip("\n"))
    return [] if said["status"] == 0 else [(said["err"].strip().splitlines() or ["it ended with status " + str(said["status"])])[-1]]


def doctor(a, cluster):
    from tactus.cluster import checkup
    if not 0.5 <= a.seconds <= 600:
        raise Refusal(f"--seconds {a.seconds:g}: give a number from 0.5 to 600")
    figures, wrong = checkup.run(operator_of(a, cluster), a.seconds)
    if a.json:
        pathlib.Path(a.json).write_text(json.dumps(figures, indent=1), encoding="utf-8")
    tell("" if wrong else "\nno fault found")
    return wrong


def check(_, cluster):
    tell(f"cluster: {cluster.name} is valid: {len(cluster.nodes)} nodes on {len(cluster.hosts)} hosts, {cluster.bus.group}:{cluster.bus.port}, ttl {cluster.bus.ttl}")
    return []


def main(words):
    terminal.prepare()
    try:
        from tactus.cluster.reach import Failed, Unreachable
        a = parsed(words)
        from tactus.cluster import cluster_file
        cluster = cluster_file.read(file_of(a), os.path.abspath(os.path.join("out", f"cluster-{os.getpid()}")))
        try:
            wrong = {"up": up, "down": down, "status": status, "logs": logs, "restart": restart, "move": move, "check": check, "doctor": doctor, **{name: tell_program for name in TOLD}}[a.command](a, cluster)
        except (Failed, Unreachable) as error:
            raise Refusal(str(error)) from None
    except Refusal as refusal:
        wrong = [str(refusal)]
    except OSError as error:
        wrong = [sentence_of(error)]
    except KeyboardInterrupt:
        return 130
    for sentence in wrong:
        terminal.complain(f"cluster: {sentence}")
    return 1 if wrong else 0
