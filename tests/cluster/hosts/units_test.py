#!/usr/bin/python3
"""Tests of the systemd units that `tactus units` writes, under a systemd that boots in namespaces on a temporary copy of this system.
Every modality presents, each unit is confined as it specifies, and killed nodes restart. Exits 77 where namespaces do not allow it."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or ROOT / "build" / "dev" / "bin").absolute()
SYSTEMD = "/lib/systemd/systemd"
KINDS = ("sync", "recorder", "haptic", "haptic@lamp", "audio", "visual", "thermal", "sim", "path")
PRIORITIES = {"sync": 40, "recorder": 40, "haptic": 60, "haptic@lamp": 60, "audio": 45, "visual": 0, "thermal": 0, "sim": 50}
TIMEOUT_S = 180  # liveness: other tests run beside it
EXIT_SKIPPED = 77
# Includes only the targets of the system's own units: this system runs only the units of Tactus.
BOOT = r"""
set -e
cd "$1"
mount --make-rprivate /
mount -t tmpfs tmpfs disk
mkdir disk/up disk/work
mount -t overlay overlay -o lowerdir=/,upperdir=disk/up,workdir=disk/work merged
mount -t proc proc merged/proc
mount --bind merged/proc/sys merged/proc/sys
mount -o remount,bind,ro merged/proc/sys
mount -t sysfs sysfs merged/sys
mount -t cgroup2 cgroup2 merged/sys/fs/cgroup
mount --rbind /dev merged/dev
mount -t tmpfs tmpfs merged/run
mount -t tmpfs tmpfs merged/tmp
cd merged
units=usr/lib/systemd/system
mkdir kept
cp -P $units/*.target $units/*.slice kept/
rm -rf $units etc/systemd/system usr/lib/systemd/system-generators usr/lib/systemd/system-environment-generators
mv kept $units
cp -r ../root/. .
for u in $2; do
  mkdir -p etc/systemd/system/tactus-$u.service.d
  printf '[Service]\nStandardOutput=append:/run/said-%%N\nStandardError=inherit\n' > etc/systemd/system/tactus-$u.service.d/said.conf
done
ln -s /etc/systemd/system/tactus.target etc/systemd/system/default.target
chroot . systemd-sysusers tactus.conf
chroot . systemd-tmpfiles --create /etc/tmpfiles.d/tactus.conf
for u in $2; do chroot . systemctl --quiet enable tactus-$u; done
ip link set lo up
ip route add 224.0.0.0/4 dev lo
exec env -i container=other PATH="$PATH" chroot . /lib/systemd/systemd --system --log-target=null
"""


class System:
    """Boots a system; its end ends all its processes."""

    def __init__(self, folder, cgroups):
        self.folder = folder
        for name in ("disk", "merged", "root"):
            (folder / name).mkdir()
        run(ROOT / "scripts" / "tactus", "units", "install", "--root", folder / "root", "--only", ",".join(k for k in KINDS if "@" not in k))
        run(ROOT / "scripts" / "tactus", "private-path", "make", "--hosts", "one,two", "--server", "192.0.2.1", "--out", folder / "keys")
        shutil.copytree(folder / "keys" / "one", folder / "root/etc/tactus/path")
        (folder / "boot").write_text(BOOT, encoding="ascii")
        self.cgroup = cgroups / f"tactus-units-{os.getpid()}"
        self.cgroup.mkdir()
        self.log = open(folder / "log", "w", encoding="utf-8")
        self.holder = subprocess.Popen(
            ["sh", "-c", 'echo $$ > "$0"/cgroup.procs && exec "$@"', self.cgroup, "unshare", "--pid", "--fork", "--kill-child", "--mount", "--uts",
             "--ipc", "--net", "--cgroup", "bash", folder / "boot", folder, " ".join(KINDS)],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log, env=dict(os.environ, PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin"))

    def pid(self):
        children = pathlib.Path(f"/proc/{self.holder.pid}/task/{self.holder.pid}/children")
        found = children.read_text(encoding="ascii").split()
        return int(found[0]) if found else None

    def inside(self, *words, check=True):
        words = ["nsenter", "-t", str(self.pid()), "--pid", "--mount", "--uts", "--ipc", "--net", "--cgroup", "--root", "--wd", *map(str, words)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if check and done.returncode != 0:
            raise AssertionError(f"{words[11:]}: {done.stderr.strip()}")
        return done.stdout

    def is_up(self):
        assert self.holder.poll() is None, "the system ended: " + (self.folder / "log").read_text(encoding="utf-8")[-500:]
        return self.pid() is not None and self.inside("systemctl", "is-active", "tactus.target", check=False).strip() == "active"

    def of(self, kind, key):
        return self.inside("systemctl", "show", "--property", key, "--value", f"tactus-{kind}").strip()

    def output(self, kind):
        return self.inside("cat", f"/run/said-tactus-{kind}", check=False)

    def close(self):
        self.holder.kill()
        self.holder.wait()
        (self.cgroup / "cgroup.kill").write_text("1", encoding="ascii")
        wait_until(lambda: "populated 0" in (self.cgroup / "cgroup.events").read_text(encoding="ascii"), "all processes of the system end")
        for path in sorted((p for p in self.cgroup.rglob("*") if p.is_dir()), reverse=True):
            path.rmdir()
        self.cgroup.rmdir()
        self.log.close()


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, env=dict(os.environ, TACTUS_BIN=str(BIN)))
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return done.stdout


def wait_until(holds, what):
    end = time.monotonic() + TIMEOUT_S
    while not holds():
        assert time.monotonic() < end, f"not within {TIMEOUT_S} s: {what}"
        time.sleep(0.1)


def cgroups():
    """A cgroup folder in which systemd can have a tree of its own; None if there is none."""
    for line in pathlib.Path("/proc/mounts").read_text(encoding="utf-8").splitlines():
        _, place, kind, options, *_ = line.split()
        if kind == "cgroup2" and "rw" in options.split(",") and os.access(place, os.W_OK):
            return pathlib.Path(place)
    return None


def check(system):
    wait_until(system.is_up, "systemd starts tactus.target")
    wait_until(lambda: "the world begins" in system.output("sim"), "the world begins: " + system.output("sim"))
    wait_until(lambda: "Initialization Sequence Completed" in system.output("path"), "the private path begins: " + system.output("path"))
    time.sleep(3)
    for kind in KINDS:
        assert system.of(kind, "ActiveState") == "active" and system.of(kind, "NRestarts") == "0", f"{kind}: {system.of(kind, 'Result')}: {system.output(kind)}"
        pid = system.of(kind, "MainPID")
        status = dict(line.split(":\t", 1) for line in system.inside("cat", f"/proc/{pid}/status").splitlines() if ":\t" in line)
        assert (status["NoNewPrivs"], status["Seccomp"]) == ("1", "2"), kind
        if kind == "path":
            continue
        assert int(status["CapEff"], 16) == int(status["CapBnd"], 16) == 0 and not status["Uid"].startswith("0\t"), kind
        priority = int(re.search(r"priority: (\d+)", system.inside("chrt", "-p", pid)).group(1))
        print(f"{kind}: priority {priority}, user {status['Uid'].split()[0]}, system calls filtered, no capability")
        assert priority == PRIORITIES[kind], f"{kind}: priority {priority} of {PRIORITIES[kind]}"
    rules = system.inside("/usr/sbin/nft", "list", "ruleset")
    assert "tactus0" in rules and "7667" in rules, rules
    pid = system.of("sim", "MainPID")
    for path, may in (("/usr/it", False), ("/etc/it", False), ("/var/it", False), ("/home/it", False), ("/var/lib/tactus/it", True)):
        made = system.inside("nsenter", "-t", pid, "--mount", "--root", "sh", "-c", f"touch {path} && echo made", check=False)  # root neither
        assert (made.strip() == "made") == may, path
    system.inside("kill", "-9", pid)
    wait_until(lambda: system.of("sim", "ActiveState") == "active" and system.of("sim", "NRestarts") == "1" and system.of("sim", "MainPID") != pid,
               "the supervisor restarts the simulation")
    wait_until(lambda: all_present(presented_counts(system)), "every modality presents in the new world, after visual_node has compiled its shaders")
    system.inside("systemctl", "stop", "tactus.target")
    wait_until(lambda: all(system.of(kind, "ActiveState") in ("inactive", "failed") for kind in KINDS), "all end")
    for kind in KINDS:
        assert (system.of(kind, "ActiveState"), system.of(kind, "Result")) == ("inactive", "success"), f"{kind}: {system.of(kind, 'Result')}: {system.output(kind)}"


def presented_counts(system):
    """{modality: number of presented events} in the log of the units' recorder."""
    out = system.folder / "out"
    out.mkdir(exist_ok=True)
    for name in system.inside("ls", "/var/lib/tactus").split():
        if name.endswith(".lcmlog"):
            with open(out / name, "wb") as file:
                subprocess.run(["nsenter", "-t", str(system.pid()), "--mount", "--root", "cat", f"/var/lib/tactus/{name}"], stdout=file, check=True)
    subprocess.run([BIN / "summarise", out, "--out", out / "summary.json"], capture_output=True, check=False)
    contacts = json.loads((out / "summary.json").read_text(encoding="utf-8"))["contacts"]
    return {sense: of["presented"] for sense, of in contacts["by_modality"].items()}


def all_present(presented):
    return all(presented.get(sense, 0) > 0 for sense in ("haptic", "audio", "visual", "thermal"))


def main():
    place = cgroups()
    needed = ("unshare", "nsenter", "openvpn", "nft", "openssl", "systemctl")
    if os.geteuid() != 0 or place is None or not os.path.exists(SYSTEMD) or not os.path.exists("/dev/net/tun") or \
            not all(shutil.which(p, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin") for p in needed):
        print("skipped: a private systemd needs root, cgroup2, /dev/net/tun, and the packages of scripts/packages.txt")
        return EXIT_SKIPPED
    with tempfile.TemporaryDirectory(prefix="tactus-units-") as folder:
        probe = "mkdir l u w m && mount -t tmpfs tmpfs u && mkdir u/u u/w && mount -t overlay overlay -o lowerdir=/,upperdir=u/u,workdir=u/w m"
        if subprocess.run(["unshare", "--mount", "--net", "--pid", "--fork", "--cgroup", "sh", "-c", probe], cwd=folder, capture_output=True, check=False).returncode:
            print("skipped: this system does not allow namespaces with an overlay of its files")
            return EXIT_SKIPPED
        inside = pathlib.Path(folder) / "system"
        inside.mkdir()
        system = System(inside, place)
        try:
            check(system)
            presented = presented_counts(system)
            print("presented:", presented)
            assert all_present(presented), presented
        finally:
            system.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
