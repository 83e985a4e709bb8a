"""A release of Debian in a folder, and commands in it.

Mounts are made in a mount namespace of each command, so they end with it: removing the folder cannot reach this machine's /dev or /proc.
"""
import os
import pathlib
import shlex
import shutil
import subprocess

import machine

# Runs in a new mount and process namespace (unshare(1)): mounts, then the command in the folder $1.
ENTER = """set -e
root=$1; shift
mount --make-rprivate /
mount -t proc proc "$root/proc"
mount --rbind /sys "$root/sys"
mount --rbind /dev "$root/dev"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
mount -t tmpfs -o mode=755 tmpfs "$root/run"
exec chroot "$root" "$@"
"""
UNSHARE = ("unshare", "--mount", "--pid", "--fork", "--kill-child")


class Chroot:
    """The release in the folder `root`. Commands write to the open file `log`."""

    def __init__(self, root, log):
        self.root, self.log = pathlib.Path(root), log

    def exists(self):
        return (self.root / "etc/debian_version").exists()

    def make(self, release, mirror, security):
        """Fetches the release. Needs minutes and the mirror. Raises Refusal."""
        self.root.mkdir(parents=True, exist_ok=True)
        if any(self.root.iterdir()):
            raise machine.Refusal(f"{self.root} is not empty and holds no Debian; name a new folder with --keep")
        words = ["debootstrap", "--variant=minbase", release, str(self.root), mirror]
        if self.logged([*UNSHARE, *words]) != 0:
            raise machine.Refusal(f"debootstrap cannot fetch {release}; see the end of {self.log.name}")
        self.configure(release, mirror, security)

    def configure(self, release, mirror, security):
        """Writes the package sources, proxies, names and certificates of this machine, and a policy that starts no service."""
        etc = self.root / "etc"
        (etc / "apt/sources.list").unlink(missing_ok=True)
        (etc / "apt/sources.list.d/debian.sources").write_text(machine.sources(release, mirror, security), encoding="utf-8")
        (etc / "apt/apt.conf.d/80machine").write_text(machine.apt_settings(machine.output_of("apt-config", "dump")), encoding="utf-8")
        for name in ("resolv.conf", "hosts"):
            shutil.copy(f"/etc/{name}", etc / name)
        policy = self.root / "usr/sbin/policy-rc.d"
        policy.write_text("#!/bin/sh\nexit 101\n", encoding="utf-8")  # 101: forbidden (invoke-rc.d(8))
        policy.chmod(0o755)
        if self.run("apt-get update -qq && apt-get install -y -qq --no-install-recommends ca-certificates") != 0:
            raise machine.Refusal(f"apt-get fails in {self.root}; see the end of {self.log.name}")
        machine.copy_certificates(self.root)
        self.run("update-ca-certificates")

    def run(self, script, folder="/", variables=None):
        """The exit status of a shell script in the chroot."""
        environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive",
                       **{name: os.environ[name] for name in machine.VARIABLES if name in os.environ}, **(variables or {})}
        words = [*UNSHARE, "bash", "-c", ENTER, "enter", str(self.root), "/usr/bin/env", "-i", *(f"{name}={value}" for name, value in environment.items()),
                 "bash", "-c", f"cd {shlex.quote(folder)} && {{ {script}\n}}"]
        return self.logged(words)

    def logged(self, words):
        self.log.flush()
        return subprocess.run(words, stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT, check=False).returncode
