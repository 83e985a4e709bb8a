"""Files of each host of a private path: start script, configuration of OpenVPN with keys, and firewall rules that keep the bus
inside the path."""
import os
import pathlib
import subprocess
import tempfile

AUTHORITY = "authority"  # the folder of the signing key; no host needs it
DEVICE = "tactus0"
SUBNET = "10.76.67"      # of the path; 76.67 as in the LCM group 239.255.76.67
MAX_HOSTS = 250
MULTICAST = "224.0.0.0/4"
START = """\
#!/bin/sh
# Starts the private path of the bus on {name}, as root: rules, device and route, then openvpn(8). Rules, device and route stay
# when openvpn ends: the bus is then interrupted and never leaves unencrypted; it continues when openvpn runs again.
# `start prepare` makes rules, device and route, and exits.
set -e
PATH=$PATH:/usr/sbin:/sbin
cd "$(dirname "$0")"
nft -f tactus.nft
ip link show dev {device} >/dev/null 2>&1 || ip tuntap add dev {device} mode tap
ip addr replace {address}/24 dev {device}
ip link set {device} up
ip route replace {multicast} dev {device}
[ "${{1-}}" != prepare ] || exit 0
# Above the priority of normal processes, below real-time priority.
exec nice -n -10 openvpn --config tactus.conf "$@"
"""
# A lost host is detected within 5 s and dialled again each second, because the bus cannot use delayed data.
COMMON = """\
dev {device}
dev-type tap
ifconfig-noexec
proto udp4
# OpenVPN splits a datagram of 1500 bytes, because IP fragments would not be authenticated individually.
fragment 1400 mtu
mssfix 1400 mtu
tls-version-min 1.3
data-ciphers AES-256-GCM:CHACHA20-POLY1305
auth SHA256
# The buffer sizes of the nodes (sync/bus/udp_port.cpp).
sndbuf 4194304
rcvbuf 4194304
persist-tun
persist-key
user nobody
group nogroup
verb 1
mute 10
mute-replay-warnings
"""
LISTENS = """\
# {name}, which listens on the private path of the bus. Keep it secret: the key is in it.
mode server
tls-server
lport {listen}
client-to-client
keepalive 1 5
remote-cert-tls client
dh none
"""
DIALS = """\
# {name}, which dials {first} on the private path of the bus. Keep it secret: the key is in it.
client
nobind
remote {server} {listen}
ping 1
ping-restart 5
connect-retry 1 1
explicit-exit-notify 1
remote-cert-tls server
verify-x509-name {first} name
"""
# The programs of LCM receive datagrams to any address of the host, and send along the current route.
RULES = """\
# Keeps the bus on the private path and on this host, also when the path is down; nothing is routed into the path.
table inet tactus
delete table inet tactus
table inet tactus {{
  chain input {{
    type filter hook input priority filter
    iifname != {{ "lo", "{device}" }} udp dport {{ {port}, {next} }} counter drop
  }}
  chain output {{
    type filter hook output priority filter
    oifname != {{ "lo", "{device}" }} udp dport {{ {port}, {next} }} counter drop
  }}
  chain forward {{
    type filter hook forward priority filter
    iifname "{device}" counter drop
    oifname "{device}" counter drop
  }}
}}
"""
EXTENSIONS = {"ca": "basicConstraints=critical,CA:TRUE\nkeyUsage=critical,keyCertSign",
              "server": "basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\nextendedKeyUsage=serverAuth",
              "client": "basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\nextendedKeyUsage=clientAuth"}


def write(folder, a):
    """Writes all files of a path into a new folder that only its owner can read. Raises subprocess.CalledProcessError, OSError."""
    keys = Keys(a.days)
    for number, name in enumerate(a.hosts, 1):
        first = number == 1
        values = {"name": name, "first": a.hosts[0], "server": a.server, "listen": a.listen, "device": DEVICE, "multicast": MULTICAST,
                  "address": f"{SUBNET}.{number}"}
        key, certificate = keys.make_signed_key(name, "server" if first else "client")
        text = (LISTENS if first else DIALS).format(**values) + COMMON.format(**values)
        for element, content in (("ca", keys.certificate), ("cert", certificate), ("key", key), ("tls-crypt", keys.shared_key)):
            text += f"<{element}>\n{content.strip()}\n</{element}>\n"
        write_private(folder / name / "tactus.conf", text)
        write_private(folder / name / "tactus.nft", rules(DEVICE, a.port))
        write_private(folder / name / "start", START.format(**values), 0o700)
    write_private(folder / AUTHORITY / "ca.key", keys.key)
    write_private(folder / AUTHORITY / "ca.crt", keys.certificate)


def rules(device, port):
    return RULES.format(device=device, port=port, next=port + 1)


def write_private(path, text, mode=0o600):
    path.parent.parent.mkdir(mode=0o700, exist_ok=True)
    path.parent.mkdir(mode=0o700, exist_ok=True)
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "w", encoding="ascii") as file:
        file.write(text)


class Keys:
    """A certificate authority that signs the keys of the hosts."""

    def __init__(self, days):
        self.days = days
        self.key = new_key()
        self.certificate = self.sign("Tactus private path", self.key, "ca")
        self.shared_key = "-----BEGIN OpenVPN Static key V1-----\n" + "\n".join(os.urandom(16).hex() for _ in range(16)) + \
            "\n-----END OpenVPN Static key V1-----\n"

    def make_signed_key(self, name, use):
        """(key, certificate)."""
        key = new_key()
        return key, self.sign(name, key, use)

    def sign(self, name, key, use):
        with tempfile.TemporaryDirectory() as folder:  # readable only by its owner
            at = pathlib.Path(folder)
            files = {"own.key": key, "ca.key": self.key, "extensions": EXTENSIONS[use], **({} if use == "ca" else {"ca.crt": self.certificate})}
            for file, text in files.items():
                write_private(at / "keys" / file, text)
            openssl("req", "-new", "-key", at / "keys" / "own.key", "-subj", f"/CN={name}", "-out", at / "request")
            signer = ["-signkey", at / "keys" / "ca.key"] if use == "ca" else ["-CA", at / "keys" / "ca.crt", "-CAkey", at / "keys" / "ca.key"]
            return openssl("x509", "-req", "-in", at / "request", *signer, "-days", str(self.days), "-set_serial", "0x" + os.urandom(16).hex(),
                           "-sha256", "-extfile", at / "keys" / "extensions")


def new_key():
    return openssl("genpkey", "-algorithm", "EC", "-pkeyopt", "ec_paramgen_curve:P-256")


def openssl(*words):
    return subprocess.run(["openssl", *map(str, words)], capture_output=True, text=True, check=True).stdout


def guide(out, a):
    """Instructions for the user."""
    return (f"{len(a.hosts)} hosts; {a.hosts[0]} listens at {a.server}, UDP port {a.listen}. Copy to each its folder of {out}, over a\n"
            f"confidential channel, and keep {out / AUTHORITY} away from all of them. As root on each:\n\n"
            f"  {a.hosts[0]}/start              # until Ctrl-C, or\n"
            f"  cp -rT {a.hosts[0]} /etc/tactus/path && tactus units install --only path && systemctl enable --now tactus-path\n\n"
            f"Start the nodes with --ttl 1 --port {a.port}.")
