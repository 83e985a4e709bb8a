"""Sites without multicast between them: in each site one host runs a relay with a line to every other relay."""
import dataclasses
import ipaddress
import pathlib

SHIPPED = pathlib.Path(__file__).with_name("relays")
RELAY = "relay"


@dataclasses.dataclass(frozen=True)
class Relay:
    host: str
    at: str    # its address, for other relays
    kbit: int  # capacity of the line to it, kbit/s; 0: unlimited


@dataclasses.dataclass(frozen=True)
class Relays:
    rules: pathlib.Path
    port: int
    by_name: dict  # {process: Relay}

    def words(self, process):
        """Arguments of a relay after the common ones. The path of the rules is local."""
        own = self.by_name[process]
        to = [f"{r.at}:{self.port}" + (f",{r.kbit}" if r.kbit else "") for r in self.by_name.values() if r != own]
        return ["--name", process, "--listen", f"{own.at}:{self.port}", *(w for line in to for w in ("--to", line)), "--rules", str(self.rules)]


def relay_name(host):
    return f"{RELAY}_{host}"


def read(reading, hosts):
    """Relays of the file, or None. reading: cluster_file.ClusterReader."""
    e = reading.only_child("relays")
    sites = {host.site for host in hosts.values()}
    if e is None:
        if len(sites) > 1:
            first = next(h for h in reading.root.findall("host") if h.get("site"))
            reading.refuse(first, f"there are hosts of {len(sites)} sites and no relays between them; add <relays rules=\"wide\"> with a <relay host= at=/> for each "
                           "site, or remove site= when multicast reaches all hosts")
        return None
    found, covered = {}, {}
    for r in e.findall("relay"):
        host, at = r.get("host"), r.get("at")
        if host not in hosts:
            reading.refuse(r, f"there is no host \"{host}\"; there are {', '.join(hosts)}")
        site = hosts[host].site
        if site in covered:
            reading.refuse(r, f"the site of {host} already has a relay, on {covered[site]}; remove one")
        if not is_address(at):
            reading.refuse(r, f"at=\"{at}\" is not an IPv4 address; give the one at which other relays reach {host}, for example 192.0.2.7")
        covered[site] = host
        found[relay_name(host)] = Relay(host, at, int(r.get("kbit", "0")))
    for name, host in hosts.items():
        if host.site not in covered:
            reading.refuse(e, f"no host of the site of {name} has a relay; add <relay host=\"{name}\" at=\"...\"/>")
    if len(found) < 2:
        reading.refuse(e, "there is one site, which needs no relay; set site= of the other hosts, or remove <relays>")
    return Relays(find_rules(reading, e), int(e.get("port", "7700")), found)


def is_address(text):
    try:
        return not ipaddress.IPv4Address(text).is_multicast
    except ValueError:
        return False


def find_rules(reading, e):
    """Path of the rules: a file relative to the cluster file, or a shipped file by its name."""
    text = e.get("rules", "wide")
    local, shipped = reading.path.parent / text, SHIPPED / f"{text}.xml"
    if local.is_file():
        return local.resolve()
    if pathlib.Path(text).name == text and shipped.is_file():
        return shipped
    known = ", ".join(sorted(p.stem for p in SHIPPED.glob("*.xml")))
    reading.refuse(e, f"rules=\"{text}\" is not a file; give a file, or one of {known}")
