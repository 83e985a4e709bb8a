"""The command line of every node of a cluster, in words that each host completes: @BUILD@, @FILES@ and @OUT@ are its own folders."""

from tactus.cluster.cluster_file import SYNC
from tactus.cluster.sites import RELAY
from tactus.launch import cluster as one_machine


def of_nodes(cluster, run_id, git, there):
    """{node: words}. there: {path here: path on the hosts}, of shipment.of_run."""
    plan = cluster.plan
    paths = {str(one_machine.BIN): "@BUILD@/bin", str(plan.out): "@OUT@", **there}
    made = one_machine.commands(plan, run_id, git)
    for name in cluster.nodes:
        if cluster.relays and name in cluster.relays.by_name:
            made[name] = [str(one_machine.BIN / RELAY), *cluster.relays.words(name), *one_machine.common(plan, run_id)]
        elif name not in made:  # the other hosts' sync_nodes
            made[name] = [*made[SYNC], "--name", name]
    return {name: around(placed, [translated(word, paths) for word in made[name]] + bus_words(cluster, name, placed))
            for name, placed in cluster.nodes.items()}


def translated(word, paths):
    """Whole paths only: the longest that the word is, or that is a folder of it."""
    head, equals, tail = word.rpartition("=") if word.startswith(("room=", "shader_folder=")) else ("", "", word)
    for path in sorted(paths, key=len, reverse=True):
        if tail == path or tail.startswith(path + "/"):
            return head + equals + paths[path] + tail[len(path):]
    return word


def bus_words(cluster, name, placed):
    words = ["--group", cluster.bus.group, "--ttl", str(cluster.bus.ttl)]
    if placed.realtime:
        words += ["--realtime", placed.realtime]
    return words + list(placed.options)


def around(placed, words):
    """What is before the program: which processors, how nice, what is in its environment. Programs keep their place in the words:
    the first is looked for by nobody."""
    if placed.realtime:
        at = words.index("--realtime")  # of the run; the node's own comes last
        words = words[:at] + words[at + 2:]
    before = []
    if placed.environment:
        before += ["env", *(f"{name}={value}" for name, value in placed.environment)]
    if placed.cpus:
        before += ["taskset", "-c", placed.cpus]
    if placed.nice:
        before += ["nice", "-n", str(placed.nice)]
    return before + words
