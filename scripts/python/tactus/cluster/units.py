"""The command line of tactus units.

  tactus units install [--root DIR] [--only KIND,KIND,...] [--prefix DIR] [--out DIR] [--units-only]
                        [--group ADDRESS] [--port N] [--ttl N] [--run-id N] [--scene FILE] [--host NAME]

Writes systemd units for a permanent installation and copies the programs of the build. Enables and starts nothing, but
prints the commands for it.

  --only        comma-separated list of sim, haptic, audio, visual, thermal, sync, recorder, relay, path; default: all but relay and path
  --root        root of the target system (default /)
  --prefix      folder for the programs (default /opt/tactus)
  --out         output folder of the nodes (default /var/lib/tactus)
  --units-only  copies no programs, because they are already in PREFIX
  --group, --port, --ttl, --run-id, --scene   as for the nodes; written to /etc/tactus/tactus.env. An existing file is kept;
                edit it in that case
  --host        name of this host, if it is not the host of the recorder; its sync_node is then called sync_node_NAME

units/README.md describes the units.
"""
import argparse
import ipaddress
import pathlib
import re
import shutil
import sys

from tactus import terminal
from tactus.refusal import Refusal, sentence_of

UNITS = pathlib.Path(__file__).with_name("units")
KINDS = ("sync", "recorder", "haptic", "audio", "visual", "thermal", "sim", "relay", "path")
OPTIONAL = ("relay", "path")  # unless requested with --only
TEMPLATES = ("haptic", "visual")  # for further tools and walls
SYSTEM, ETC = "etc/systemd/system", "etc/tactus"


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus units --help")


def parsed(words):
    parser = Parser(add_help=False, allow_abbrev=False, prog="units")
    commands = parser.add_subparsers(dest="command", required=True, parser_class=Parser)
    c = commands.add_parser("install", add_help=False, allow_abbrev=False)
    c.add_argument("--root", default="/")
    c.add_argument("--only", default=",".join(k for k in KINDS if k not in OPTIONAL))
    c.add_argument("--prefix", default="/opt/tactus")
    c.add_argument("--out", default="/var/lib/tactus")
    c.add_argument("--units-only", action="store_true")
    c.add_argument("--group", default="239.255.76.67")  # as in lcmtypes/channels.h
    c.add_argument("--port", type=int, default=7667)
    c.add_argument("--ttl", type=int, default=0)
    c.add_argument("--run-id", type=int, default=1)
    c.add_argument("--scene")
    c.add_argument("--host")
    a = parser.parse_args(words)
    a.only = a.only.split(",")
    for kind in a.only:
        if kind not in KINDS:
            raise Refusal(f"--only: there is not a unit of \"{kind[:40]}\"; there are {', '.join(KINDS)}")
    for option in ("prefix", "out", "scene"):
        path = getattr(a, option)
        if path is not None and not re.fullmatch(r"/[A-Za-z0-9._/+-]+", path):
            raise Refusal(f"--{option} {path[:80]}: give an absolute path of letters, digits and ._/+-")
    a.scene = a.scene or f"{a.prefix}/share/scenes/dark_room.sdf"
    for option, value, low, high in (("--port", a.port, 1, 65534), ("--ttl", a.ttl, 0, 255), ("--run-id", a.run_id, 1, 2**63 - 1)):
        if not low <= value <= high:
            raise Refusal(f"{option} {value}: give a number from {low} to {high}")
    try:
        if not ipaddress.IPv4Address(a.group).is_multicast:
            raise ValueError
    except ValueError:
        raise Refusal(f"--group {a.group[:40]}: is not a multicast group; use one from 224.0.0.0 to 239.255.255.255") from None
    if a.host is not None and not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9-]{0,31}", a.host):
        raise Refusal(f"--host {a.host[:40]}: give a name of letters, digits and hyphens")
    return a


def sections(text):
    """{section: text} of a unit or of common.conf."""
    found, name = {"": []}, ""
    for line in text.splitlines():
        if re.fullmatch(r"\[\w+\]", line):
            name = line
            found[name] = []
        else:
            found[name].append(line)
    return {name: "\n".join(lines).strip() for name, lines in found.items()}


def service_text(name):
    """The text of a service with the common lines; its own lines come after them and override."""
    common = sections((UNITS / "common.conf").read_text(encoding="ascii").replace(f" {name}", ""))  # no unit is ordered after itself
    own = sections((UNITS / name).read_text(encoding="ascii"))
    parts = [own.pop("")] + [f"{name}\n{common[name]}\n{own.get(name, '')}".strip() for name in ("[Unit]", "[Service]", "[Install]")]
    return "\n\n".join(part for part in parts if part) + "\n"


def fill_placeholders(text, a):
    values = {"PREFIX": a.prefix, "OUT": a.out, "GROUP": a.group, "PORT": a.port, "TTL": a.ttl, "RUN_ID": a.run_id, "SCENE": a.scene,
              "SYNC_OPTIONS": f"--name sync_node_{a.host}" if a.host else ""}
    return re.sub(r"@([A-Z_]+)@", lambda m: str(values[m[1]]), text)


def files(a):
    """{path relative to the root: text} of all written files."""
    read = lambda name: fill_placeholders((UNITS / name).read_text(encoding="ascii"), a)
    found = {f"{SYSTEM}/tactus.target": read("tactus.target")}
    for kind in a.only:
        for name in (f"tactus-{kind}.service", *([f"tactus-{kind}@.service"] if kind in TEMPLATES else [])):
            found[f"{SYSTEM}/{name}"] = fill_placeholders(service_text(name), a)
    return found | {f"{ETC}/tactus.env": read("tactus.env"), "etc/sysusers.d/tactus.conf": read("sysusers.conf"),
                    "etc/tmpfiles.d/tactus.conf": read("tmpfiles.conf")}


def install(a):
    root = pathlib.Path(a.root)
    if not root.is_dir():
        raise Refusal(f"--root {root}: is not a folder; create it first")
    # An existing file may have been edited by the user.
    kept = (root / ETC / "tactus.env").exists()
    texts = {path: text for path, text in files(a).items() if not (kept and path.endswith("tactus.env"))}
    if not a.units_only:
        copy_programs(root / a.prefix.lstrip("/"))
    for path, text in texts.items():
        into = root / path
        into.parent.mkdir(parents=True, exist_ok=True)
        fresh = into.with_name(f".{into.name}.new")
        fresh.write_text(text, encoding="ascii")
        fresh.chmod(0o644)
        fresh.rename(into)
    units = [f"tactus-{kind}" for kind in a.only]
    where = "" if root == pathlib.Path("/") else " (in that system)"
    terminal.report((f"{root / ETC / 'tactus.env'} already existed and was kept\n" if kept else "") +
                  f"units of {', '.join(a.only)} are in {root / SYSTEM}; nothing is enabled. As root{where}:\n\n"
                  "  systemd-sysusers && systemd-tmpfiles --create && systemctl daemon-reload\n"
                  f"  systemctl enable {' '.join(units)} tactus.target && systemctl start tactus.target")


def copy_programs(prefix):
    """Copies the programs of the build without debug information. A running program keeps its old file."""
    from tactus.cluster import deployment
    for there, here in deployment.parts().items():
        into = prefix / there
        into.parent.mkdir(parents=True, exist_ok=True)
        fresh = into.with_name(f".{into.name}.new")
        fresh.write_bytes(deployment.stripped(here))
        shutil.copymode(here, fresh)
        fresh.rename(into)
    shutil.copy(UNITS / "README.md", prefix / "share" / "units.md")


def main(words):
    terminal.prepare()
    if not words or {"-h", "--help"} & set(words):
        terminal.report(__doc__.split("\n", 2)[2].strip("\n"), None if words else sys.stderr)
        return 0 if words else 1
    try:
        install(parsed(words))
        return 0
    except Refusal as refusal:
        error_text = str(refusal)
    except OSError as error:
        error_text = sentence_of(error)
    terminal.report_refusal(f"units: {error_text}")
    return 1
