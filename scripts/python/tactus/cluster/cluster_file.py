"""The cluster file: hosts, and placement and options of the nodes. Validated completely before anything starts."""
import dataclasses
import pathlib
import shlex

from tactus import own_xml
from tactus.cluster import sites
from tactus.launch import arguments, hands, scene, walls
from tactus.refusal import Refusal

SCHEMA = pathlib.Path(__file__).with_name("cluster.xsd")
SHIPPED = pathlib.Path(__file__).with_name("clusters")
MAX_HOSTS = 250  # the addresses of a /24 network
RECORDER, SYNC, WORLD = "recorder", "sync_node", "sim_node"
NEEDED = (WORLD, RECORDER)
RUN_OPTIONS = ("seed", "realtime", "degrade", "policy", "aligner", "base", "budget", "soa", "split_mb", "split_minutes", "keep", "max_mb", "tags")


@dataclasses.dataclass(frozen=True)
class Host:
    name: str
    reach: str    # local, ssh or namespace
    address: str  # for ssh: as on its command line; for a namespace: its name
    folder: str   # for builds and results; "": in the home directory
    build: str    # folder of its own build; "": this build is installed
    site: str     # multicast reaches all hosts of a site; "": the unnamed site


@dataclasses.dataclass(frozen=True)
class NodePlacement:
    """Placement and options of a node."""
    host: str
    realtime: str     # "": that of the run
    cpus: str         # of taskset; "": any
    nice: int
    options: tuple    # arguments of the node
    environment: tuple  # (name, value)


@dataclasses.dataclass(frozen=True)
class Bus:
    group: str
    port: int
    ttl: int


@dataclasses.dataclass(frozen=True)
class Cluster:
    name: str
    path: pathlib.Path
    bus: Bus
    hosts: dict  # {name: Host}, in the order of the file
    nodes: dict  # {process: NodePlacement}, sync_nodes among them
    plan: object  # arguments.Plan, with the same checks as scripts/run
    relays: object  # sites.Relays; None: one site

    def nodes_on(self, host):
        return [name for name, placed in self.nodes.items() if placed.host == host]

    def is_private(self):
        """True when all nodes run on this machine with ttl 0; they then get a private network, if possible."""
        return len(self.hosts) == 1 and self.bus.ttl == 0 and all(h.reach == "local" for h in self.hosts.values())

    def sync_node_of(self, host):
        return sync_name(host, self.nodes[RECORDER].host)


def sync_name(host, first):
    """Name of the sync_node of a host; each host has one, and process names are unique."""
    return SYNC if host == first else f"{SYNC}_{host}"


def find(text):
    """Path of a file, or of the shipped file of this name."""
    path = pathlib.Path(text)
    if not path.is_file() and path.name == text:
        for name in (text, text + ".xml"):
            if (SHIPPED / name).is_file():
                return SHIPPED / name
    return path


def read(text, out="."):
    """The Cluster of a file, or of the shipped file of this name. Raises Refusal with the line."""
    from lxml import etree  # imported only when a file is read
    path = find(text)
    root, _ = own_xml.root_of(path, text, "a cluster file", sorted(p.stem for p in SHIPPED.glob("*.xml")))
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    if not schema.validate(root):
        first = schema.error_log[0]
        raise Refusal(f"{text}:{first.line}: {plain(first.message)}")
    return ClusterReader(text, path, root, out).cluster()


def plain(message):
    """The message of libxml2 without schema jargon."""
    for word in ("[facet 'pattern'] ", "[facet 'enumeration'] ", "[facet 'maxInclusive'] ", "[facet 'minInclusive'] "):
        message = message.replace(word, "")
    return message.rstrip(".")


class ClusterReader:
    """Checks of a tree that the schema has validated."""

    def __init__(self, text, path, root, out):
        self.text, self.path, self.root, self.out = text, path.resolve(), root, out

    def refuse(self, element, sentence):
        raise Refusal(f"{self.text}:{element.sourceline}: {sentence}")

    def only_child(self, tag):
        found = self.root.findall(tag)
        if len(found) > 1:
            self.refuse(found[1], f"there is a second <{tag}>; remove one")
        return found[0] if found else None

    def cluster(self):
        hosts = {e.get("name"): self.host(e) for e in self.root.findall("host")}
        if not hosts:
            self.refuse(self.root, "there is no <host>; name at least one")
        if len(hosts) > MAX_HOSTS:
            self.refuse(self.root, f"there are {len(hosts)} hosts; at most {MAX_HOSTS} can share one bus; split them into sites with relays")
        placed, words = {}, []
        self.settings = {}  # {process: words of --set}
        known = (WORLD, RECORDER, *arguments.SENSES, *hands.processes(scene.tools(self.scene())))
        for element in self.root.findall("node"):
            name = element.get("name")
            if name not in known and not name.startswith(SYNC):
                self.refuse(element, f"there is no node \"{name}\"; there are {', '.join(known)}, and {SYNC}, which every host has in any case")
            placed[name] = self.placed(element, hosts)
            self.read_settings(element, name)
            if element.get("device") is not None:
                words += self.device(element)
        words += self.walls(placed, hosts)
        for name in NEEDED:
            if name not in placed:
                self.refuse(self.root, f"{name} is on no host; add <node name=\"{name}\" host=\"...\"/>")
        bus = self.bus(hosts)
        plan = self.plan(placed, words, bus)
        relays = sites.read(self, hosts)
        if relays and bus.port <= relays.port <= bus.port + 3:
            self.refuse(self.only_child("relays"), f"port=\"{relays.port}\" is a port of the bus; choose another")
        first = placed[RECORDER].host
        for e in self.root.findall("node"):
            if e.get("name").startswith(SYNC) and e.get("name") != sync_name(e.get("host"), first):
                self.refuse(e, f"the {SYNC} of {e.get('host')} is {sync_name(e.get('host'), first)}; use this name, or remove the node: every host has one")
        for host in hosts:
            placed[sync_name(host, first)] = placed.get(sync_name(host, first)) or NodePlacement(host, "", "", 0, (), ())
        placed |= {name: NodePlacement(relay.host, "", "", 0, (), ()) for name, relay in (relays.by_name if relays else {}).items()}
        return Cluster(self.root.get("name"), self.path, bus, hosts, placed, plan, relays)

    def host(self, e):
        reach, address = e.get("reach"), e.get("address", "")
        if reach == "local" and address:
            self.refuse(e, f"the host {e.get('name')} is local and has an address; remove one of them")
        if reach == "local" and next(h for h in self.root.findall("host") if h.get("reach") == "local") is not e:
            self.refuse(e, f"the host {e.get('name')} is a second local host, but only this machine is local; remove it, or use reach=\"namespace\"")
        for attribute in ("folder", "build"):
            if e.get(attribute) and not e.get(attribute).startswith(("/", "~/")):
                self.refuse(e, f"{attribute}=\"{e.get(attribute)}\" of the host {e.get('name')} is not absolute; begin it with / or ~/")
        # Namespaces share the disk of this machine, so each gets its own folder.
        folder = e.get("folder", f"~/.local/share/tactus/hosts/{e.get('name')}" if reach == "namespace" else "")
        return Host(e.get("name"), reach, address or e.get("name"), folder, e.get("build", ""), e.get("site", ""))

    def bus(self, hosts):
        e = self.only_child("bus")
        get = lambda name, default: default if e is None else e.get(name, default)
        bus = Bus(get("group", "239.255.76.67"), int(get("port", "7667")), int(get("ttl", "0")))  # as in lcmtypes/channels.h
        if any(int(part) > 255 for part in bus.group.split(".")):
            self.refuse(e, f"group=\"{bus.group}\" is not a multicast address; use one from 224.0.0.0 to 239.255.255.255")
        if len(hosts) > 1 and bus.ttl == 0:
            self.refuse(self.root if e is None else e, "there are several hosts, but with ttl 0 no message leaves a host; add "
                        "<bus ttl=\"1\"/> (this network only) if every machine on it may receive and disturb the run, or read docs/between_sites.md")
        return bus

    def placed(self, e, hosts):
        if e.get("host") not in hosts:
            self.refuse(e, f"there is no host \"{e.get('host')}\"; there are {', '.join(hosts)}")
        above = e.getparent() if e.tag == "wall" else None
        get = lambda name, default: e.get(name, default if above is None else above.get(name, default))
        environment = [*([] if above is None else above.findall("environment")), *e.findall("environment")]
        try:
            options = tuple(shlex.split(get("options", "")))
        except ValueError as error:
            self.refuse(e, f"options: {str(error).lower()}; close the quotation")
        return NodePlacement(e.get("host"), get("realtime", ""), get("cpus", ""), int(get("nice", "0")), options,
                      tuple((v.get("name"), v.get("value")) for v in environment))

    def read_settings(self, e, process):
        """Checks the names of settings; the node checks the values."""
        program = next((n for n in (hands.FIRST, walls.FIRST) if process.startswith(n)), process)
        for s in e.findall("set"):
            try:
                words = arguments.settings([f"{program}.{s.get('name')}={s.get('value')}"], {})[program]
            except Refusal as refusal:
                self.refuse(s, str(refusal))
            self.settings[process] = self.settings.get(process, []) + words

    def device(self, e):
        name = e.get("name")
        if name == hands.FIRST:
            return ["--device", e.get("device")]
        others = hands.processes(scene.tools(self.scene()))
        if name not in others:
            self.refuse(e, f"{name} has no device; only the hands do: {', '.join((hands.FIRST, *others))}")
        return ["--device", f"{others[name]}={e.get('device')}"]

    def walls(self, placed, hosts):
        e = self.only_child("walls")
        if e is None:
            return []
        if walls.FIRST in placed:
            self.refuse(e, f"{walls.FIRST} is placed as a node and by <walls>; remove one")
        try:
            room, names = walls.room(self.path.parent, e.get("room"))
        except ValueError as error:
            self.refuse(e, str(error))
        process_of = {wall: process for process, wall in walls.processes(names).items()}
        words = ["--room", room]
        for w in e.findall("wall"):
            if w.get("name") not in process_of:
                self.refuse(w, f"the room {e.get('room')} has no wall \"{w.get('name')}\"; it has {', '.join(names)}")
            process = process_of[w.get("name")]
            placed[process] = self.placed(w, hosts)
            self.read_settings(e, process)
            self.read_settings(w, process)  # comes last, so it overrides
        for wall in names:
            if process_of[wall] not in placed:
                self.refuse(e, f"the wall {wall} is on no host; add <wall name=\"{wall}\" host=\"...\"/>")
        return words

    def scene(self):
        run = self.only_child("run")
        return arguments.scene_file(self.path.parent, "dark_room.sdf" if run is None else run.get("scene", "dark_room.sdf"))

    def plan(self, placed, words, bus):
        """The plan of the equivalent command line of scripts/run on one machine."""
        run = self.only_child("run")
        get = lambda name: None if run is None else run.get(name)
        line = [str(self.scene()), "--port", str(bus.port), *words]
        for option in RUN_OPTIONS:
            if get(option) is not None:
                line += ["--" + option.replace("_", "-"), get(option)]
        if get("listen") in ("true", "1"):
            line.append("--listen")
        others = hands.processes(scene.tools(self.scene()))
        for process in others:  # further tools of the scene run with the first one unless placed
            if process not in placed and hands.FIRST in placed:
                placed[process] = dataclasses.replace(placed[hands.FIRST], options=())
        line += [word for name in arguments.SENSES if name not in placed for word in ("--without", name)]
        line += ["--out", str(self.out)]
        plan = arguments.parse(line, self.path.parent)
        plan.settings.update(self.settings)
        return plan
