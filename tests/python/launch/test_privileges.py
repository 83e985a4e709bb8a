"""Tests of the rights of nodes, as the kernel states them in /proc/PID/status of a child."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import cluster, cluster_folder, main, privileges, services
from tactus.refusal import Refusal

STATUS = ["cat", "/proc/self/status"]
ANY_USER = 65534  # the user without files: passwd of Debian


def rights(status):
    """{name: set of capability numbers}, and NoNewPrivs, of the text of /proc/PID/status."""
    fields = dict(line.split(":\t", 1) for line in status.splitlines() if ":\t" in line)
    sets = {name: {bit for bit in range(64) if int(fields[name], 16) >> bit & 1} for name in ("CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb")}
    return sets, fields["NoNewPrivs"]


def numbers(names):
    return {privileges.NUMBERS[name] for name in names}


class Rights(unittest.TestCase):
    def status_of(self, *words):
        return rights(subprocess.run(words, capture_output=True, text=True, check=True).stdout)

    def check(self, sets, no_new, kept):
        self.assertEqual("1", no_new)
        self.assertEqual((set(), set()), (sets["CapInh"], sets["CapAmb"]))
        for name in ("CapPrm", "CapEff"):
            self.assertLessEqual(sets[name], numbers(kept), name)

    def test_a_child_keeps_only_priority_and_locked_memory(self):
        sets, no_new = self.status_of(*privileges.least(STATUS))
        self.check(sets, no_new, privileges.KEPT)
        if os.geteuid() == 0:
            self.assertLessEqual(sets["CapBnd"], numbers(privileges.KEPT))

    def test_a_child_that_may_read_all_files_keeps_only_this_in_addition(self):
        kept = (*privileges.KEPT, privileges.READ_ALL)
        self.check(*self.status_of(*privileges.least(STATUS, kept)), kept)

    def test_a_program_that_a_child_starts_gains_nothing(self):
        self.check(*self.status_of(*privileges.least(["sh", "-c", "exec cat /proc/self/status"])), privileges.KEPT)

    @unittest.skipIf(os.geteuid() != 0, "only root can become another user")
    def test_an_ordinary_user_has_none_also_in_the_user_namespace_of_a_private_network(self):
        as_user = ["setpriv", "--reuid", str(ANY_USER), "--regid", str(ANY_USER), "--clear-groups"]
        # setpriv of util-linux 2.41 refuses to limit what programs of root gain, if it is not root.
        self.assertEqual(set(), self.status_of(*as_user, *privileges.words(bounding=False), *STATUS)[0]["CapEff"])
        space = ["unshare", "--user", "--map-current-user", "--keep-caps"]
        if subprocess.run([*as_user, *space, "true"], capture_output=True, check=False).returncode:
            self.skipTest("this system allows no user namespace")
        self.assertNotEqual(set(), self.status_of(*as_user, *space, *STATUS)[0]["CapEff"])  # without the drop
        sets, no_new = self.status_of(*as_user, *space, *privileges.words(), *STATUS)
        self.assertEqual((set(), "1"), (sets["CapEff"], no_new))

    def test_a_node_under_the_supervisor_has_only_these_rights(self):
        """The real first process of a cluster, with the real service folder and a node that writes its own status."""
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name)
            folder = cluster_folder.make(out)
            service = services.Service(folder, "sim_node", ["sh", "-c", f"cat /proc/self/status >{out}/new && mv {out}/new {out}/status; sleep 60"], out / "log", out)
            holder = subprocess.Popen([str(cluster.INSIDE), str(folder), "host", *privileges.KEPT], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
            try:
                self.assertTrue(service.start())
                self.assertTrue(services.wait_until((out / "status").exists, 20))
                self.check(*rights((out / "status").read_text(encoding="utf-8")), privileges.KEPT)
                supervisor = pathlib.Path(f"/proc/{holder.pid}/status").read_text(encoding="utf-8")
                self.check(*rights(supervisor), privileges.KEPT)
            finally:
                services.end_or_kill([service], 0.1)
                holder.send_signal(signal.SIGHUP)  # ends also its runsv processes, which SIGTERM leaves behind
                holder.wait()
                # Ended supervisors may still be writing into it.
                services.wait_until(lambda: shutil.rmtree(folder, ignore_errors=True) or not folder.exists(), 20)
                self.assertFalse(folder.exists())


class Needed(unittest.TestCase):
    @unittest.skipIf(os.geteuid() != 0, "the files of another user need root")
    def test_root_reads_the_files_of_another_user_only_when_the_run_needs_them(self):
        with tempfile.TemporaryDirectory() as name:
            home = pathlib.Path(name) / "home"
            home.mkdir(mode=0o700)
            (home / "scene.sdf").write_text("", encoding="utf-8")
            with mock.patch.object(privileges, "has_receive_buffer", return_value=True):
                self.assertEqual(privileges.KEPT, privileges.needed([home, home / "scene.sdf", "/no/such"]))
                os.chown(home, ANY_USER, ANY_USER)
                self.assertEqual((*privileges.KEPT, privileges.READ_ALL), privileges.needed([home / "scene.sdf"]))
                self.assertIn("also read all files", privileges.description(privileges.needed([home / "scene.sdf"])))

    def test_the_receive_buffer_needs_no_right_when_the_kernel_allows_it(self):
        with tempfile.NamedTemporaryFile("w") as limit, mock.patch.object(privileges, "LIMIT", pathlib.Path(limit.name)), \
                mock.patch.object(privileges, "readable", return_value=True), mock.patch("os.geteuid", return_value=0):
            for text, more in (("212992\n", (privileges.RECEIVE_BUFFER,)), ("4194304\n", ())):
                pathlib.Path(limit.name).write_text(text, encoding="ascii")
                self.assertEqual((*privileges.KEPT, *more), privileges.needed([]))

    def test_an_ordinary_user_reads_nothing_about_rights(self):
        with mock.patch("os.geteuid", return_value=1000):
            self.assertEqual(("", privileges.KEPT), (privileges.description(privileges.KEPT), privileges.needed(["/no/such"])))


class Output(unittest.TestCase):
    def refused(self, mode, uid, euid):
        with mock.patch("os.geteuid", return_value=euid):
            try:
                main.refuse_foreign_folder("out", os.stat_result((mode, 0, 0, 1, uid, uid, 0, 0, 0, 0)))
            except Refusal as refusal:
                return str(refusal)
        return ""

    def test_results_are_not_written_into_a_shared_folder_or_as_root_into_that_of_another_user(self):
        self.assertIn("every user can write there", self.refused(0o41777, 0, 1000))
        self.assertIn("belongs to the user", self.refused(0o40755, 1000, 0))
        for mode, uid, euid in ((0o40755, 0, 0), (0o40755, 1000, 1000), (0o42775, 7, 1000)):
            self.assertEqual("", self.refused(mode, uid, euid))


if __name__ == "__main__":
    unittest.main()
