"""Properties of this machine that a chroot needs: the mirror of packages, proxies and certificates. No host name stands in the project."""
import re
import shutil
import subprocess

# Settings of apt that a proxy or a mirror needs. The names of hosts in them stay on this machine.
APT_SETTINGS = re.compile(r'^Acquire::(?:(?:http|https)::(?:Proxy|Proxy-Auto-Detect|Timeout)|Retries|Check-Valid-Until|Check-Date) "[^"]+";$', re.I)
# Variables that programs need to reach the network.
VARIABLES = ("http_proxy", "https_proxy", "no_proxy", "HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY", "NODE_EXTRA_CA_CERTS", "SSL_CERT_FILE", "NPM_CONFIG_REGISTRY")


class Refusal(Exception):
    """One sentence: the fault and the remedy."""


def output_of(*words):
    """The output of a program; empty when it fails or does not exist."""
    try:
        return subprocess.run(words, capture_output=True, text=True, check=False).stdout
    except OSError:
        return ""


def mirrors(indextargets):
    """(mirror, mirror of security updates or None) from the lines "URI ORIGIN RELEASE" of the package lists of this machine.

    Raises Refusal when there is none of Debian."""
    rows = [line.split() for line in indextargets.splitlines()]
    debian = [row for row in rows if len(row) == 3 and row[1] == "Debian"]
    security = next((uri for uri, _, release in debian if release.endswith("-security")), None)
    for uri, _, release in debian:
        if not release.endswith(("-security", "-updates", "-backports")):
            return uri.rstrip("/"), security and security.rstrip("/")
    raise Refusal("the package lists of this machine name no mirror of Debian; run apt-get update first, or name one with --mirror")


def machine_mirrors():
    return mirrors(output_of("apt-get", "indextargets", "--format", "$(REPO_URI) $(ORIGIN) $(RELEASE)", "Created-By: Packages"))


def sources(release, mirror, security):
    """The text of an apt source file (sources.list(5), the deb822 style) for a release."""
    parts = [("deb", mirror, f"{release} {release}-updates")]
    if security:
        parts.append(("deb", security, f"{release}-security"))
    return "\n".join(f"Types: {kind}\nURIs: {uri}\nSuites: {suites}\nComponents: main\n" for kind, uri, suites in parts)


def apt_settings(dump):
    """Those lines of `apt-config dump` that a proxy or a mirror needs, as a file for apt.conf.d."""
    return "".join(f"{line}\n" for line in dump.splitlines() if APT_SETTINGS.match(line))


def copy_certificates(root):
    """Copies the certificates that an administrator added to this machine; update-ca-certificates reads them there."""
    target = root / "usr/local/share/ca-certificates"
    target.mkdir(parents=True, exist_ok=True)
    shutil.copytree("/usr/local/share/ca-certificates", target, dirs_exist_ok=True)
