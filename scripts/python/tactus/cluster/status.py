"""One table of all hosts: the state of each node from its supervisor and from the bus."""
from tactus.cluster import answers
from tactus.cluster.cluster_file import RECORDER

COLUMNS = ("host", "node", "process", "on the bus", "rate Hz", "missed", "input age ms", "rendered", "restarts", "note")


def query(operator):
    """({host: state or error}, output of watch --json from the first host that answers)."""
    states = operator.states(patience_s=3)  # a later answer counts as not reached
    first = operator.cluster.nodes[RECORDER].host
    bus = {}
    for host in sorted(states, key=lambda h: h != first):
        s = states[host]
        if isinstance(s, Exception) or not s["run"]:
            continue
        c = operator.cluster
        operator.identity = s["run"]["build"]
        words = ["@BUILD@/bin/watch", "--once", "--json", "--run-id", str(s["run"]["run_id"]), "--group", c.bus.group, "--port", str(c.bus.port)]
        try:
            result = operator.request(host, "run_bus_program", words=words, patience_s=5, patience=4)
            bus = {"host": host, **answers.read(result["out"], answers.WATCH)} if result["out"] else {"host": host}
            break
        except Exception:  # pylint: disable=broad-except  # try the next host
            continue
    return states, bus


def rows(cluster, states, bus):
    """Dictionaries of COLUMNS, in the order of the file; host is empty for a node that no host runs."""
    published = bus.get("nodes", {})
    found = []
    seen = set()
    for host, s in states.items():
        if isinstance(s, Exception):
            found.append({"host": host, "node": "", "process": "NOT REACHED", "note": str(s).partition(": ")[2]})
            continue
        for name, node in s["nodes"].items():
            seen.add(name)
            found.append(row(host, name, node, published.get(name)))
        if not s["run"]:
            found.append({"host": host, "node": "", "process": "nothing runs", "note": "tactus cluster up"})
    unreachable = [h for h, s in states.items() if isinstance(s, Exception)]
    for name, placed in cluster.nodes.items():
        if name not in seen:
            of_node = published.get(name)
            found.append(row(placed.host if placed.host in unreachable else "", name, None, of_node))
    return found


def row(host, name, node, published):
    process = "not seen" if node is None else "LEFT DOWN" if node["lost"] else "taken down" if node["taken_down"] else "up" if node["up"] else "starting"
    r = {"host": host, "node": name, "process": process, "restarts": "" if node is None else node["deaths"]}
    if published:
        r |= {"on the bus": published["state"], "rate Hz": published["rate_hz"], "missed": published["missed_ticks"], "input age ms": published["input_age_ms"],
              "rendered": published["contacts_rendered"], "note": published["note"]}
    if node and (node["lost"] or not node["up"]):
        r["note"] = node["lost"] or node["last"]
    return r


def text(found, width=160):
    """Lines of the table."""
    shown = [[cell(r.get(c)) for c in COLUMNS] for r in found]
    widths = [max(len(c), *(len(r[i]) for r in shown)) if shown else len(c) for i, c in enumerate(COLUMNS)]
    line = lambda cells: "  ".join(v.ljust(w) for v, w in zip(cells, widths)).rstrip()[:width]
    return "\n".join([line(COLUMNS), *map(line, shown)])


def cell(value):
    return "" if value is None else f"{value:.1f}" if isinstance(value, float) else str(value)


def all_running(cluster, states, bus):
    """True when every node of the file runs and publishes."""
    up = {n for s in states.values() if not isinstance(s, Exception) for n, node in s["nodes"].items() if node["up"]}
    published = bus.get("nodes", {})
    return all(n in up and published.get(n, {}).get("state") == "running" for n in cluster.nodes)
