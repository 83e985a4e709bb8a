"""The command line of tactus private-path.

  tactus private-path make --hosts A,B,C --server ADDRESS --out DIR [--listen PORT] [--port N] [--days N]
  tactus private-path macsec --hosts A,B,C --device NAME [--port N]

make    Makes keys and one folder for each host, with the script `start`. The first host listens at ADDRESS (UDP, --listen,
        default 1194); the others connect to it. A virtual Ethernet (OpenVPN, device tactus0) then connects the hosts, encrypted and
        authenticated. Multicast uses it, and the bus uses nothing else.
macsec  Prints the commands of iproute2 that encrypt one Ethernet in the kernel instead, with new keys for each host.

  --hosts   names of letters, digits and hyphens
  --server  address or name at which the other hosts reach the first host
  --out     a new folder
  --port    port of the bus, as for the nodes (default 7667; the bus also uses the next port)
  --device  network device of the shared Ethernet, e.g. eth0
  --days    validity of the keys in days (default 825)

docs/between_sites.md explains the start and the protection.
"""
import argparse
import ipaddress
import os
import pathlib
import re
import shutil
import subprocess
import sys

from tactus import terminal
from tactus.cluster import macsec, path_files
from tactus.paths import packages_remedy
from tactus.refusal import Refusal, sentence_of

NAME = re.compile(r"[A-Za-z0-9]([A-Za-z0-9-]{0,30}[A-Za-z0-9])?")
DNS_NAME = re.compile(r"(?=.{1,253}$)[A-Za-z0-9]([A-Za-z0-9.-]*[A-Za-z0-9])?")
DAYS = 825  # as for certificates of easy-rsa


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus private-path --help")


def parsed(words):
    parser = Parser(add_help=False, allow_abbrev=False, prog="private_path")
    commands = parser.add_subparsers(dest="command", required=True, parser_class=Parser)
    make_words = commands.add_parser("make", add_help=False, allow_abbrev=False)
    for option in ("--hosts", "--server", "--out"):
        make_words.add_argument(option, required=True)
    make_words.add_argument("--listen", type=int, default=1194)  # IANA port of openvpn
    make_words.add_argument("--days", type=int, default=DAYS)
    macsec_words = commands.add_parser("macsec", add_help=False, allow_abbrev=False)
    for option in ("--hosts", "--device"):
        macsec_words.add_argument(option, required=True)
    for words_of in (make_words, macsec_words):
        words_of.add_argument("--port", type=int, default=7667)  # as in lcmtypes/channels.h
    a = parser.parse_args(words)
    a.hosts = host_names(a.hosts)
    for option, highest in (("listen", 65535), ("port", 65534), ("days", 36500)):
        if not 1 <= getattr(a, option, 1) <= highest:
            raise Refusal(f"--{option} {getattr(a, option)}: give a number from 1 to {highest}")
    if a.command == "make":
        a.server = server_address(a.server)
    elif not re.fullmatch(r"[A-Za-z0-9_.][A-Za-z0-9_.-]{0,14}", a.device):
        raise Refusal(f"--device {a.device}: is not a network device; list them with ip link")
    return a


def host_names(text):
    names = text.split(",")
    if not 2 <= len(names) <= path_files.MAX_HOSTS:
        raise Refusal(f"--hosts {text[:60]}: a path joins 2 to {path_files.MAX_HOSTS} hosts; separate their names by commas")
    for name in names:
        if not NAME.fullmatch(name):
            raise Refusal(f"--hosts: \"{name[:60]}\" is not a valid host name; use letters, digits and hyphens, at most 32")
        if name == path_files.AUTHORITY:
            raise Refusal(f"--hosts: {name} is the folder of the signing key; rename the host")
    if len(set(names)) != len(names):
        raise Refusal(f"--hosts {text[:60]}: a host is named twice; remove one")
    return names


def server_address(text):
    try:
        address = ipaddress.ip_address(text)
    except ValueError:
        if DNS_NAME.fullmatch(text) and not re.fullmatch(r"[0-9.]+", text):
            return text
        raise Refusal(f"--server {text[:60]}: is neither an address nor a name; give the one at which the other hosts reach the first host") from None
    if address.version != 4 or address.is_multicast or address.is_unspecified:
        raise Refusal(f"--server {text}: is not an IPv4 address of a host; give the one at which the other hosts reach the first host")
    return text


def make(a):
    if not shutil.which("openssl"):
        raise Refusal(f"openssl is not installed; {packages_remedy('private-path')}")
    out = pathlib.Path(a.out)
    if out.exists() or out.is_symlink():
        raise Refusal(f"--out {out}: already exists, and its keys may be in use; name a new folder")
    fresh = out.with_name(f".{out.name}.{os.getpid()}")  # renamed when complete
    try:
        path_files.write(fresh, a)
        fresh.rename(out)
    except subprocess.CalledProcessError as error:
        raise Refusal(f"openssl {error.cmd[1]}: {(error.stderr.strip() or 'failed').splitlines()[-1]}") from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    terminal.report(path_files.guide(out, a))


def main(words):
    terminal.prepare()
    if not words or {"-h", "--help"} & set(words):
        terminal.report(__doc__.split("\n", 2)[2].strip("\n"), None if words else sys.stderr)
        return 0 if words else 1
    try:
        a = parsed(words)
        if a.command == "make":
            make(a)
        else:
            terminal.report(macsec.commands(a.hosts, a.device, a.port))
        return 0
    except Refusal as refusal:
        error_text = str(refusal)
    except OSError as error:
        error_text = sentence_of(error)
    terminal.report_refusal(f"private_path: {error_text}")
    return 1
