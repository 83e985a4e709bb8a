"""Finds faults between hosts from the results of probe_pairs on each host. Pure functions."""

GROUP_ROUTE = "ip route add 224.0.0.0/4 dev INTERFACE"
MAX_LOSS = 0.01            # of single datagrams: contact events are repeated for 50 ms, states are not
MAX_ROUND_TRIP_US = 20_000  # round trip p99: more than a frame at 60 Hz; sound and picture would both wait for it
MAX_UNCERTAINTY_US = 1000  # design: a tenth of the smallest asynchrony that a person can distinguish
BUFFER_BYTES = 4 << 20     # the size that sync/bus/udp_port.cpp requests
COLUMNS = ("from", "to", "received", "lost", "of bursts", "round trip p50/us", "p99/us", "clock/s", "+-/us", "ttl")


def findings(results):
    """One sentence for each fault, in the order of checks. results: {host: JSON of probe_pairs}."""
    found = []
    for host, a in results.items():
        if a["refused"]:
            found.append(f"{host}: its network refused {a['refused']} datagrams; check its interface (ip -s link)")
        if a["buffer_bytes"] < BUFFER_BYTES:
            found.append(f"{host}: the kernel keeps {a['buffer_bytes'] // 1024} kB of received data for a process, not {BUFFER_BYTES // 1024} kB; "
                         f"sysctl net.core.rmem_max={BUFFER_BYTES}")
        if a["other_doctors"]:
            found.append(f"{host}: receives {a['other_doctors']} datagrams of another doctor; run only one doctor at a time")
    for host, a in results.items():
        others = [o for o in a["others"] if o in results]
        silent = [o for o in others if not a["others"][o]["received"]]
        if others and silent == others and len(others) > 1:
            found.append(f"{host}: receives nothing from the other hosts; {causes(host, results, None)}")
            continue
        for other in silent:
            found.append(f"{host}: receives nothing from {other}; {causes(host, results, other)}")
        for other in others:
            o = a["others"][other]
            if not o["received"]:
                continue
            if o["lost"] > MAX_LOSS:
                found.append(f"{host}: loses {100 * o['lost']:.1f} % of the datagrams of {other}; check cable, switch and wireless link between them")
            burst = results[other]["burst"]
            if burst and o["of_bursts"] < burst * (1 - max(MAX_LOSS, 1.5 * o["lost"])):
                found.append(f"{host}: {burst - o['of_bursts']} of {burst} datagrams of bursts of {other} are lost, but single datagrams are not; a buffer on "
                             f"the path is too small: sysctl net.core.rmem_max={BUFFER_BYTES} on {host}, or the switch")
            if o["answered"] and o["round_trip_us"]["p99"] > MAX_ROUND_TRIP_US:
                found.append(f"{host}: answers of {other} take up to {o['round_trip_us']['p99'] / 1000:.0f} ms (p99), which delays sound and picture or makes them late; use a faster network")
            if o["answered"] and o["uncertainty_us"] > MAX_UNCERTAINTY_US:
                found.append(f"{host}: the uncertainty of the clock of {other} is {o['uncertainty_us'] / 1000:.1f} ms; use a faster network between them")
            if not o["answered"] and o["received"] and results[other]["others"].get(host, {}).get("received"):
                found.append(f"{host}: {other} receives its datagrams, but the answers are lost; allow UDP of these ports both ways in the firewall")
    return found


def causes(host, results, other):
    """Possible causes why host receives nothing from other (None: from all), and the remedy."""
    own = results[host]
    if any(a["ttl"] == 0 for name, a in results.items() if name == other or other is None):
        return "ttl is 0, so no message leaves a host; set <bus ttl=\"1\"/>"
    if other is not None and results[other]["others"].get(host, {}).get("received"):
        return (f"{other} receives from {host}: a firewall on {host} drops datagrams, or the switch drops group members (IGMP snooping without a querier)")
    if other is not None and any(o.get("received") for name, o in own["others"].items() if name != other):
        return f"other hosts are connected: check the route of {other} ({GROUP_ROUTE}), its firewall, and whether both are in one network"
    return f"check its route ({GROUP_ROUTE}), its firewall, and whether the switch forwards multicast"


def rows(results):
    """A dictionary of COLUMNS for each pair and direction: from sends, to receives."""
    found = []
    for to, a in results.items():
        for origin, o in a["others"].items():
            row = {"from": origin, "to": to, "received": "yes" if o["received"] else "NO"}
            if o["received"]:
                row |= {"lost": f"{100 * o['lost']:.1f} %", "of bursts": f"{o['of_bursts']}/{results[origin]['burst'] if origin in results else '?'}", "ttl": o["ttl"]}
            if o["answered"]:
                row |= {"round trip p50/us": f"{o['round_trip_us']['p50']:.0f}", "p99/us": f"{o['round_trip_us']['p99']:.0f}",
                        "clock/s": f"{o['offset_us'] / 1e6:+.6f}", "+-/us": f"{o['uncertainty_us']:.0f}"}
            found.append(row)
    return found


def text(found):
    shown = [[str(r.get(c, "")) for c in COLUMNS] for r in found]
    widths = [max(len(c), *(len(r[i]) for r in shown)) if shown else len(c) for i, c in enumerate(COLUMNS)]
    return "\n".join("  ".join(v.ljust(w) for v, w in zip(cells, widths)).rstrip() for cells in [COLUMNS, *shown])
