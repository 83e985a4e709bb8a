"""tactus cluster doctor: checks every host, then every pair of hosts."""
import json
import os
import random

from tactus.cluster import pairs, shipment
from tactus.cluster.reach import Failed, Unreachable
from tactus.refusal import Refusal
from tactus.terminal import tell

BESIDE = 2            # offset to the ports after the two of the bus, so that probes do not disturb the run
HOST_S, WAKE_S = 60, 2
NEEDED = ("multicast route", "multicast loopback", "receive buffers", "real-time priority")  # on every host; other weak points are remarks


def run(operator, seconds):
    """(figures for --json, errors, one sentence each). Prints the tables."""
    operator.files = shipment.parts()
    operator.identity = shipment.identity(operator.files)
    looked = ask_again(operator, "look", list(operator.reaches), patience_s=15)
    wrong = [str(a) for a in looked.values() if isinstance(a, Exception)]
    hosts = [h for h, a in looked.items() if not isinstance(a, Exception)]
    if not hosts:
        raise Refusal(wrong[0])
    operator.refuse_mixed(looked, hosts, {})
    operator.install(looked, hosts)
    tell(f"{'host':14} {'reached in':>10}  cores  load  priority  weak or missing")
    figures = {"hosts": {}, "pairs": {}, "wrong": wrong, "remarks": []}
    answers = ask_again(operator, "on_the_bus", hosts, patience_s=HOST_S + 5, patience=HOST_S, words=examination(operator))
    states = ask_again(operator, "state", hosts)
    for host in hosts:
        wrong += of_host(operator, host, looked[host], answers[host], states[host], figures)
    for site in dict.fromkeys(operator.cluster.hosts[h].site for h in hosts):
        of_site = [h for h in hosts if operator.cluster.hosts[h].site == site]
        if len(of_site) > 1:
            wrong += of_pairs(operator, of_site, seconds, figures)
    for sentence in figures["remarks"]:
        tell(f"remark: {sentence}")
    return figures, wrong


def ask_again(operator, what, hosts, **request):
    """operator.ask_all, repeated once for unreachable hosts, because a faulty cable also breaks connections."""
    answers = operator.ask_all(what, hosts, **request)
    away = unreachable(answers)
    return answers | operator.ask_all(what, away, **request) if away else answers


def unreachable(answers):
    return [h for h, a in answers.items() if isinstance(a, Unreachable)]


def examination(operator):
    """Command line of `tactus doctor` on a host."""
    return ["sh", "-c", f"@BUILD@/share/scripts/tactus doctor --seconds {WAKE_S} --port {operator.cluster.bus.port} --out /tmp --json \"$1\" >&2; cat \"$1\"; "
            "rm -f \"$1\"", "doctor", f"/tmp/tactus-doctor-{os.getpid()}-{random.randrange(10**9)}.json"]


def of_host(operator, host, looked, answer, state, figures):
    if isinstance(answer, Exception):
        return [str(answer)]
    try:
        said = json.loads(answer["out"])
    except ValueError:
        return [f"{host}: tactus doctor failed ({(answer['err'].strip().splitlines() or ['no output'])[-1]}); run it on this host"]
    not_good = [line for line in said["lines"] if line["verdict"] != "good" and line["what"] not in unneeded(operator, host)]
    late = []
    try:
        took_s = operator.reaches[host].measure_s()
    except (Unreachable, Failed) as error:
        took_s, late = None, [f"{error}, but was reached a moment before; check cable, switch or wireless link of this host"]
    load = state["load"] if not isinstance(state, Exception) else None
    figures["hosts"][host] = {**said, "reached_s": took_s, "machine": looked["machine"], "cores": looked["cores"], "load": load}
    priority = next((line["verdict"] for line in said["lines"] if line["what"] == "real-time priority"), "?")
    tell(f"{host:14} {shown(took_s, 1000, 7, 0)} ms  {looked['cores']:5d} {shown(load, 1, 5, 1)}  {priority:8}  {', '.join(line['what'] for line in not_good) or '-'}")
    sentence = lambda line: f"{host}: {line['found']}" + (f"; {line['remedy']}" if line["remedy"] else "")
    bad = [line for line in not_good if line["verdict"] == "missing" or line["what"] in NEEDED]
    figures["remarks"] += [sentence(line) for line in not_good if line not in bad]
    return late + [sentence(line) for line in bad]


def shown(value, factor, width, digits):
    return "-".rjust(width) if value is None else f"{value * factor:{width}.{digits}f}"


def unneeded(operator, host):
    """Checks that are irrelevant for the nodes of a host."""
    nodes = operator.cluster.of_host(host)
    lines = {"private network", "other clocks"}  # the pairs below measure the clocks
    if not any(n.startswith("audio_node") for n in nodes):
        lines.add("sound card")
    if not any(n.startswith("visual_node") for n in nodes):
        lines.add("pictures (EGL)")
    return lines


def of_pairs(operator, hosts, seconds, figures):
    bus = operator.cluster.bus
    words = lambda h, round_: ["@BUILD@/bin/probe_pairs", "--host", h, "--expect", ",".join(hosts), "--round", str(round_), "--seconds", f"{seconds:g}", "--group", bus.group,
                       "--port", str(bus.port + BESIDE), "--ttl", str(bus.ttl)]
    for _ in range(2):  # repeated for all hosts when one is missing, because probes belong to one round
        round_ = random.getrandbits(60)
        answers = operator.ask_all("on_the_bus", hosts, patience_s=seconds + 20, patience=seconds + 15, words=lambda h: words(h, round_))
        if not unreachable(answers):
            break
    wrong, said = [], {}
    for host, a in answers.items():
        if isinstance(a, Exception):
            wrong.append(str(a))
        elif a["status"] != 0:
            wrong.append(f"{host}: {(a['err'].strip().splitlines() or ['probe_pairs ended with status ' + str(a['status'])])[-1]}")
        else:
            said[host] = json.loads(a["out"])
    figures["pairs"] |= said
    tell("\n" + pairs.text(pairs.rows(said)))
    return wrong + pairs.findings(said)
