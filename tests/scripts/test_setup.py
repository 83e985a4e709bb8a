"""Tests of scripts/setup with an apt-get, a dpkg and a systemctl that only record: a run installs no server, and no service is enabled."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
# Installed packages are the lines of $STATE; sshd brings a service, as in Debian.
DPKG_QUERY = """#!/bin/sh
for word; do format=$word; case $word in -f=*) break ;; esac; done
case $format in
  *Status-Status}\\ *Package*) sed 's/^/installed /' "$STATE" ;;
  *) shift 2; printf '%s\\n' "$@" | grep -Fxf "$STATE" | sed 's/$/ installed/' ;;
esac
"""
DPKG = """#!/bin/sh
shift
for name; do
  case $name in openssh-server) printf '/lib/systemd/system/ssh.service\\n/usr/lib/systemd/system/ssh.socket\\n/lib/systemd/system/ssh@.service\\n/etc/init.d/ssh\\n' ;; esac
done
"""
APT = """#!/bin/sh
case "$*" in
  *--simulate*) exit 0 ;;
  *indextargets*) [ ! -e "$LISTS" ] || echo main; exit 0 ;;
  *update*) echo update >>"$RECORD"; touch "$LISTS"; exit 0 ;;
esac
echo "apt-get offline=$SYSTEMD_OFFLINE" >>"$RECORD"
seen=no
for word; do
  case $word in install) seen=yes ;; -*) ;; *) [ $seen = no ] || { echo "$word" >>"$RECORD"; echo "$word" >>"$STATE"; } ;; esac
done
"""
# The package lists of a system without libsdformat-dev and a-browser; with HAS_ALL=1, of one with them. Without lists, nothing is known.
APT_CACHE = """#!/bin/sh
[ -e "$LISTS" ] || exit 100
for word; do name=$word; done
case $name in libsdformat-dev | a-browser) [ "$HAS_ALL" = 1 ] || exit 100 ;; esac
"""
RECORDER = """#!/bin/sh
echo "${0##*/} $*" >>"$RECORD"
"""
AS_ROOT = """#!/bin/sh
while case $1 in -*) true ;; *) false ;; esac; do shift; done
exec "$@"
"""
# Programs that listen on a network, display servers, browsers, and tools that only speed up or test a build.
UNWANTED = {"openssh-server", "slurm-wlm", "openvpn", "nftables", "chromium", "xvfb", "xdotool", "ccache", "mold", "catch2", "libbenchmark-dev", "nodejs", "npm",
            "python3-statsmodels", "parallel", "mkdocs", "mkdocs-material"}


class Setup(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.top = pathlib.Path(kept.name)
        self.state, self.record = self.top / "state", self.top / "record"
        self.state.write_text("bash\n", encoding="utf-8")
        (self.top / "bin").mkdir()
        for name, text in (("dpkg-query", DPKG_QUERY), ("dpkg", DPKG), ("apt-get", APT), ("apt-cache", APT_CACHE), ("systemctl", RECORDER), ("update-rc.d", RECORDER), ("sudo", AS_ROOT)):
            path = self.top / "bin" / name
            path.write_text(text, encoding="utf-8")
            path.chmod(0o755)

    def setup(self, *words, status=0, has_all="1", scripts=SCRIPTS):
        """(lines that the programs recorded, output). has_all: "0" for a system whose package lists have no libsdformat-dev."""
        self.record.write_text("", encoding="utf-8")
        done = subprocess.run([scripts / "setup", *words], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                              env={**os.environ, "PATH": f"{self.top / 'bin'}:{os.environ['PATH']}", "STATE": str(self.state), "RECORD": str(self.record),
                                   "LISTS": str(self.top / "lists"), "HAS_ALL": has_all})
        self.assertEqual(status, done.returncode, done.stderr)
        return self.record.read_text(encoding="utf-8").splitlines(), done.stdout + done.stderr

    def test_a_run_installs_no_server_and_no_tool_that_it_does_not_need(self):
        lines, _ = self.setup("--packages")
        self.assertIn("runit", lines)
        self.assertIn("cmake", lines)
        self.assertEqual(set(), UNWANTED & set(lines))
        self.assertEqual([], self.setup("--packages")[0])  # nothing is missing now

    def test_a_group_brings_the_groups_that_it_includes(self):
        self.assertLessEqual({"python3-lxml", "python3-numpy"}, set(self.setup("--packages", "study")[0]))
        lines, _ = self.setup("--packages", "test")
        self.assertLessEqual({"slurm-wlm", "openssh-server", "catch2", "cmake", "openvpn"}, set(lines))

    def test_a_package_that_this_system_lacks_is_left_out_and_named(self):
        lines, said = self.setup("--packages", "test", has_all="0")
        self.assertIn("catch2", lines)
        self.assertNotIn("libsdformat-dev", lines)
        self.assertIn("left out, because this system has no such package: libsdformat-dev\n", said)
        lines, said = self.setup("--packages", "test", has_all="0")
        self.assertEqual([], lines)
        self.assertIn("libsdformat-dev", said)
        self.assertIn("packages for test: all ", self.setup("--check", "test", has_all="0")[1])

    def test_a_program_that_exists_replaces_its_package_and_a_package_that_is_nowhere_is_left_out(self):
        scripts = self.top / "scripts"
        scripts.mkdir()
        for name in ("setup", "prologue.sh", "removed_variables.txt"):
            shutil.copy(SCRIPTS / name, scripts)
        (scripts / "packages.txt").write_text("[build]\nbash\n\n[run]\na-browser | /no/such/browser ?\na-shell | /bin/sh ?\nan-editor | /no/such/editor  # written\n", encoding="utf-8")
        lines, said = self.setup("--packages", has_all="0", scripts=scripts)
        self.assertIn("an-editor", lines)
        self.assertEqual(set(), {"a-browser", "a-shell"} & set(lines))
        self.assertIn("left out, because this system has no such package: a-browser\n", said)
        lines, said = self.setup("--packages", scripts=scripts)
        self.assertIn("a-browser", lines)
        self.assertNotIn("no such package", said)

    def test_the_package_lists_are_fetched_before_a_package_counts_as_absent(self):
        lines, said = self.setup("--packages", "test")
        self.assertIn("libsdformat-dev", lines)
        self.assertEqual(1, lines.count("update"))
        self.assertNotIn("no such package", said)

    def test_no_service_is_started_or_enabled(self):
        lines, said = self.setup("--packages", "lab")
        self.assertIn("apt-get offline=1", lines)
        self.assertIn("systemctl --quiet disable --now ssh.service ssh.socket", lines)
        self.assertIn("update-rc.d ssh disable", lines)
        self.assertIn("these services stay disabled: ssh.service ssh.socket", said)

    def test_a_service_that_was_there_before_is_left_alone(self):
        self.state.write_text("bash\nopenssh-server\n", encoding="utf-8")
        lines, _ = self.setup("--packages", "lab")
        self.assertEqual([], [line for line in lines if line.startswith(("systemctl", "update-rc.d"))])

    def test_the_check_lists_every_group_and_an_unknown_one_is_refused(self):
        _, said = self.setup("--check", status=1)
        for group in ("build", "run", "fonts", "live", "report", "study", "cluster", "lab", "private-path", "docs", "clang", "portability", "peers", "test"):
            self.assertIn(f"packages for {group}: missing ", said)
        for name in ("servers", "", "build run", "$(touch sprung)"):
            self.assertIn("there is no group", self.setup(name, status=1)[1])

    def test_every_package_is_in_one_line_with_its_group(self):
        groups, named = [], set()
        for line in (SCRIPTS / "packages.txt").read_text(encoding="utf-8").splitlines():
            words = line.split("#")[0].split()
            if words and words[0].startswith("["):
                included = line.split("]")[0].partition(": ")[2].split()
                self.assertLessEqual(set(included), set(groups), line)
                groups.append(words[0].strip("[:]"))
            elif words:
                self.assertTrue(groups, line)
                self.assertTrue(len(words) == 1 or words[1:] == ["?"] or words[1] == "|" and (len(words) == 3 or words[3:] == ["?"]), line)
                self.assertNotIn((groups[-1], words[0]), named)
                named.add((groups[-1], words[0]))


if __name__ == "__main__":
    unittest.main()
