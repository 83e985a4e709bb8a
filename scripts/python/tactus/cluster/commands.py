"""Command lines of the nodes of a cluster, with placeholders @BUILD@, @FILES@ and @OUT@ for the folders of each host."""
import dataclasses

from tactus.cluster.cluster_file import SYNC
from tactus.cluster.sites import RELAY
from tactus.launch import cluster as one_machine


def node_commands(cluster, run_id, git, there):
    """{node: command line}. there: {path here: path on the hosts}, of deployment.run_files."""
    # A folder from which the scene names no file is not sent.
    plan = dataclasses.replace(cluster.plan, scene_folders=[folder for folder in cluster.plan.scene_folders if str(folder) in there])
    paths = {str(one_machine.BIN): "@BUILD@/bin", str(plan.out): "@OUT@", **there}
    made = one_machine.commands(plan, run_id, git)
    if plan.world in made:
        made[plan.world] = without_absent(made[plan.world], cluster.nodes)
    for name in cluster.nodes:
        if cluster.relays and name in cluster.relays.by_name:
            made[name] = [str(one_machine.BIN / RELAY), *cluster.relays.words(name), *one_machine.common(plan, run_id)]
        elif name not in made:  # sync_node of another host
            made[name] = [*made[SYNC], "--name", name]
    return {name: with_scheduling(placed, [translate_paths(word, paths) for word in made[name]] + bus_arguments(cluster, name, placed))
            for name, placed in cluster.nodes.items()}


def without_absent(words, nodes):
    """The command line of the simulation, which does not wait for a process that no host runs."""
    skipped = {i for i, word in enumerate(words) if word == one_machine.AWAIT and words[i + 1] not in nodes}
    return [word for i, word in enumerate(words) if i not in skipped and i - 1 not in skipped]


def translate_paths(word, paths):
    """Replaces the longest path that equals the word or is a parent folder of it."""
    head, equals, tail = word.rpartition("=") if word.startswith(("room=", "shader_folder=")) else ("", "", word)
    for path in sorted(paths, key=len, reverse=True):
        if tail == path or tail.startswith(path + "/"):
            return head + equals + paths[path] + tail[len(path):]
    return word


def bus_arguments(cluster, name, placed):
    words = ["--group", cluster.bus.group, "--ttl", str(cluster.bus.ttl)]
    if placed.realtime:
        words += ["--realtime", placed.realtime]
    return words + list(placed.options)


def with_scheduling(placed, words):
    """Prepends env, taskset and nice to a command line, as the cluster file specifies, and removes the realtime choice of the
    run when the node has its own."""
    if placed.realtime:
        at = words.index("--realtime")  # of the run; that of the node comes last
        words = words[:at] + words[at + 2:]
    before = []
    if placed.environment:
        before += ["env", *(f"{name}={value}" for name, value in placed.environment)]
    if placed.cpus:
        before += ["taskset", "-c", placed.cpus]
    if placed.nice:
        before += ["nice", "-n", str(placed.nice)]
    return before + words
