"""tactus cluster doctor: checks every host, then every pair of hosts."""
import random

from tactus.cluster import answers, deployment, pairs
from tactus.cluster.host_connection import Failed, Unreachable
from tactus.refusal import Refusal
from tactus.terminal import report

PORT_OFFSET = 2  # offset to the ports after the two of the bus, so that probes do not disturb the run
HOST_S, WAKE_S = 60, 2
NEEDED = ("multicast route", "multicast loopback", "receive buffers", "real-time priority")  # on every host; other weak points are remarks


def run(operator, seconds):
    """(figures for --json, errors, one sentence each). Prints the tables."""
    operator.files = deployment.parts()
    operator.identity = deployment.identity(operator.files)
    host_info = request_with_retry(operator, "inspect_host", list(operator.connections), patience_s=15)
    errors = [str(a) for a in host_info.values() if isinstance(a, Exception)]
    hosts = [h for h, a in host_info.items() if not isinstance(a, Exception)]
    if not hosts:
        raise Refusal(errors[0])
    operator.reject_mixed_builds(host_info, hosts, {})
    operator.install(host_info, hosts)
    report(f"{'host':14} {'reached in':>10}  cores  load  priority  weak or missing")
    figures = {"hosts": {}, "pairs": {}, "wrong": errors, "remarks": []}
    replies = request_with_retry(operator, "run_bus_program", hosts, patience_s=HOST_S + 5, patience=HOST_S, words=doctor_command(operator))
    states = request_with_retry(operator, "node_states", hosts)
    for host in hosts:
        errors += check_host(operator, host, host_info[host], replies[host], states[host], figures)
    for site in dict.fromkeys(operator.cluster.hosts[h].site for h in hosts):
        of_site = [h for h in hosts if operator.cluster.hosts[h].site == site]
        if len(of_site) > 1:
            errors += check_pairs(operator, of_site, seconds, figures)
    for sentence in figures["remarks"]:
        report(f"remark: {sentence}")
    return figures, errors


def request_with_retry(operator, what, hosts, **request):
    """operator.request_all, repeated once for unreachable hosts, because a faulty cable also breaks connections."""
    replies = operator.request_all(what, hosts, **request)
    not_reached = unreachable(replies)
    return replies | operator.request_all(what, not_reached, **request) if not_reached else replies


def unreachable(replies):
    return [h for h, a in replies.items() if isinstance(a, Unreachable)]


def doctor_command(operator):
    """Command line of `tactus doctor` on a host. Its figures go to stdout by a descriptor, not by a file in a folder of all users; the folder of
    the build is an argument of the shell, not a part of its program."""
    return ["sh", "-c", 'exec "$0" "$@" --json /dev/fd/3 3>&1 >&2', "@BUILD@/share/scripts/tactus", "doctor", "--seconds", str(WAKE_S),
            "--port", str(operator.cluster.bus.port), "--out", "/tmp"]


def check_host(operator, host, host_info, answer, state, figures):
    if isinstance(answer, Exception):
        return [str(answer)]
    try:
        report_of_doctor = answers.read(answer["out"], answers.DOCTOR)
    except ValueError:
        return [f"{host}: tactus doctor failed ({(answer['err'].strip().splitlines() or ['no output'])[-1]}); run it on this host"]
    not_good = [line for line in report_of_doctor["lines"] if line["verdict"] != "good" and line["what"] not in irrelevant_checks(operator, host)]
    late = []
    try:
        round_trip_s = operator.connections[host].measure_round_trip_s()
    except (Unreachable, Failed) as error:
        round_trip_s, late = None, [f"{error}, but was reached a moment before; check cable, switch or wireless link of this host"]
    load = state["load"] if not isinstance(state, Exception) else None
    figures["hosts"][host] = {**report_of_doctor, "reached_s": round_trip_s, "machine": host_info["machine"], "cores": host_info["cores"], "load": load}
    priority = next((line["verdict"] for line in report_of_doctor["lines"] if line["what"] == "real-time priority"), "?")
    report(f"{host:14} {number_text(round_trip_s, 1000, 7, 0)} ms  {host_info['cores']:5d} {number_text(load, 1, 5, 1)}  {priority:8}  {', '.join(line['what'] for line in not_good) or '-'}")
    sentence = lambda line: f"{host}: {line['found']}" + (f"; {line['remedy']}" if line["remedy"] else "")
    bad = [line for line in not_good if line["verdict"] == "missing" or line["what"] in NEEDED]
    figures["remarks"] += [sentence(line) for line in not_good if line not in bad]
    return late + [sentence(line) for line in bad]


def number_text(value, factor, width, digits):
    return "-".rjust(width) if value is None else f"{value * factor:{width}.{digits}f}"


def irrelevant_checks(operator, host):
    """Checks that are irrelevant for the nodes of a host."""
    nodes = operator.cluster.nodes_on(host)
    lines = {"private network", "other clocks"}  # the pairs below measure the clocks
    if not any(n.startswith("audio_node") for n in nodes):
        lines.add("sound card")
    if not any(n.startswith("visual_node") for n in nodes):
        lines.add("pictures (EGL)")
    return lines


def check_pairs(operator, hosts, seconds, figures):
    bus = operator.cluster.bus
    words = lambda h, round_: ["@BUILD@/bin/probe_pairs", "--host", h, "--expect", ",".join(hosts), "--round", str(round_), "--seconds", f"{seconds:g}", "--group", bus.group,
                       "--port", str(bus.port + PORT_OFFSET), "--ttl", str(bus.ttl)]
    for _ in range(2):  # repeated for all hosts when one is missing, because probes belong to one round
        round_ = random.getrandbits(60)
        replies = operator.request_all("run_bus_program", hosts, patience_s=seconds + 20, patience=seconds + 15, words=lambda h: words(h, round_))
        if not unreachable(replies):
            break
    errors, results = [], {}
    for host, a in replies.items():
        if isinstance(a, Exception):
            errors.append(str(a))
        elif a["status"] != 0:
            errors.append(f"{host}: {(a['err'].strip().splitlines() or ['probe_pairs ended with status ' + str(a['status'])])[-1]}")
        else:
            try:
                results[host] = answers.read(a["out"], answers.PAIRS)
            except ValueError as error:
                errors.append(f"{host}: the answer of probe_pairs is not valid ({error}); check this host")
    figures["pairs"] |= results
    report("\n" + pairs.text(pairs.rows(results)))
    return errors + pairs.findings(results)
