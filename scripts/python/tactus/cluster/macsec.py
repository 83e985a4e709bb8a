"""Commands of iproute2 for an Ethernet that the kernel encrypts (MACsec, IEEE 802.1AE)."""
import os

from tactus.cluster import path_files

DEVICE = "macsec0"
SUBNET = "10.76.68"  # differs from that of path_files.py
KEY_BYTES = 32       # of GCM-AES-256


def commands(hosts, device, port):
    """The commands for each host, with new keys, which never are arguments of a program. The user inserts the hardware addresses of the other
    hosts."""
    keys = {name: os.urandom(KEY_BYTES).hex() for name in hosts}
    lines = [f"# MACsec on the Ethernet of {', '.join(hosts)}; run each part as root on its host, from a file with mode 0600 that you delete afterwards:",
             "# the text holds the keys, and a shell would keep typed lines in its history.",
             f"# MAC_OF_HOST: output of `cat /sys/class/net/{device}/address` on this host. Static keys are valid for 2^32 sent frames",
             "# of each host (a month at 1,500 a second); MKA of wpa_supplicant renews keys automatically."]
    for number, name in enumerate(hosts, 1):
        # `ip -batch -` reads the keys from the script. As arguments they would be visible to every user of the host.
        lines += ["", f"# on {name}",
                  f"ip link add link {device} {DEVICE} type macsec cipher gcm-aes-256 encrypt on validate strict replay on window 64",
                  "ip -batch - << 'KEYS'", f"macsec add {DEVICE} tx sa 0 pn 1 on key {number:032x} {keys[name]}"]
        for other_number, other in enumerate(hosts, 1):
            if other != name:
                who = f"port 1 address MAC_OF_{other}"
                lines += [f"macsec add {DEVICE} rx {who}", f"macsec add {DEVICE} rx {who} sa 0 pn 1 on key {other_number:032x} {keys[other]}"]
        lines += ["KEYS", f"ip addr add {SUBNET}.{number}/24 dev {DEVICE} && ip link set {DEVICE} up",
                  f"ip route replace {path_files.MULTICAST} dev {DEVICE}",
                  "nft -f - << 'RULES'", path_files.rules(DEVICE, port) + "RULES"]
    return "\n".join(lines)
