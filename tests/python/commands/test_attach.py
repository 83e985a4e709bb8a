"""Tests that tactus attach enters only clusters of its own user, also when another user forges a folder in the temporary folder."""
import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"
sys.path.insert(0, str(SCRIPTS))
from tactus.commands import attach
from tactus.launch import cluster_folder
from tactus.refusal import Refusal


class Attach(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.tmp = pathlib.Path(kept.name)
        for what in (mock.patch.object(tempfile, "tempdir", str(self.tmp)), mock.patch.dict(os.environ, {"TMPDIR": str(self.tmp)})):
            what.start()
            self.addCleanup(what.stop)

    def cluster(self, holder=None, **fields):
        """A running cluster, as scripts/run makes it; this process holds its lock."""
        folder = cluster_folder.make(self.tmp)
        lock = cluster_folder.lock(folder)
        self.addCleanup(lock.close)
        cluster_folder.write_address(folder, holder or os.getpid(), ["--net", "--pid"], 5, "udpm://239.255.76.67:7667?ttl=0", 7667, self.tmp / "out")
        if fields:
            entries = dict(entry.split("=", 1) for entry in (folder / "address").read_text(encoding="utf-8").split("\0") if entry)
            (folder / "address").write_text("".join(f"{k}={v}\0" for k, v in {**entries, **fields}.items()), encoding="utf-8")
        out = self.tmp / "out"
        out.mkdir(exist_ok=True)
        (out / "cluster").unlink(missing_ok=True)
        (out / "cluster").symlink_to(folder)
        return folder, out

    def refusal(self, call, *words):
        with self.assertRaises(Refusal) as caught:
            call(*words)
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_the_own_cluster_is_found_by_its_output_and_as_the_newest(self):
        folder, out = self.cluster()
        for found in (attach.cluster_of(out), attach.newest()):
            self.assertEqual((folder, str(os.getpid())), (found[0], found[1]["holder"]))
        words = attach.entering(attach.newest()[1])
        self.assertIn(f"--net=/proc/{os.getpid()}/ns/net", words)

    def test_a_cluster_whose_output_has_a_hostile_name_is_found_with_this_name(self):
        folder, _ = self.cluster()
        out = "/out/a b\n\u2028port=1\udcff=$(x)"
        cluster_folder.write_address(folder, os.getpid(), [], 5, "udpm://239.255.76.67:7667?ttl=0", 7667, out)
        self.assertEqual((out, "7667"), tuple(cluster_folder.address(folder)[key] for key in ("out", "port")))

    def test_a_cluster_of_another_user_is_refused_also_for_root(self):
        folder, out = self.cluster()
        with mock.patch("os.geteuid", return_value=os.geteuid() + 1):
            for said in (self.refusal(attach.cluster_of, out), self.refusal(attach.newest)):
                self.assertIn(f"{folder} belongs to the user", said)
                self.assertIn("run tactus attach as that user", said)

    def test_a_folder_of_another_user_with_the_name_of_an_own_one_is_refused(self):
        folder, out = self.cluster()
        other = os.geteuid() + 1
        forged = folder.with_name(cluster_folder.PREFIX.format(user=other) + "forged")
        folder.rename(forged)
        (out / "cluster").unlink()
        (out / "cluster").symlink_to(forged)
        with mock.patch("os.geteuid", return_value=other):
            self.assertIn("belongs to the user", self.refusal(attach.cluster_of, out))
            self.assertIn("belongs to the user", self.refusal(attach.newest))

    def test_a_folder_that_others_can_write_a_linked_address_and_a_forged_process_are_refused(self):
        folder, out = self.cluster()
        folder.chmod(0o770)
        self.assertIn("no cluster is running", self.refusal(attach.cluster_of, out))
        folder.chmod(0o700)
        (folder / "address").rename(folder / "elsewhere")
        (folder / "address").symlink_to(folder / "elsewhere")
        self.assertIn("no cluster is running", self.refusal(attach.newest))
        self.assertIn("no cluster is running", self.refusal(attach.cluster_of, self.cluster(holder=2**30)[1]))
        self.assertIn("no cluster is running", self.refusal(attach.cluster_of, self.cluster(namespaces="net,user,mnt")[1]))

    def test_an_incomplete_or_endless_address_is_no_cluster(self):
        for text in ("", "holder=1\0", "x" * 10**6):
            folder, out = self.cluster()
            (folder / "address").write_text(text, encoding="utf-8")
            self.assertIn("no cluster is running", self.refusal(attach.cluster_of, out))

    def refused(self, *words):
        """(status, text) of a command that must not replace this process."""
        with mock.patch("tactus.commands.prepare.replace_process", side_effect=AssertionError("the command was started")):
            with contextlib.redirect_stderr(io.StringIO()) as said:
                return attach.main(list(words)), said.getvalue()

    def test_a_cluster_that_has_ended_is_refused_with_one_sentence_of_tactus(self):
        # The supervisor has ended, and its parent has not read its status: its user id, folder and lock are still there.
        holder = subprocess.Popen(["true"])
        self.addCleanup(holder.wait)
        os.waitid(os.P_PID, holder.pid, os.WEXITED | os.WNOWAIT)
        _, out = self.cluster(holder=holder.pid)
        for words in ((str(out), "true"), ("true",)):
            status, text = self.refused(*words)
            self.assertEqual((1, f"attach: the cluster that writes to {out} has ended; start one with tactus run --out {out}\n"), (status, text))
        again = subprocess.run([sys.executable, "-c", "import sys; from tactus.commands import attach; sys.exit(attach.main(sys.argv[1:]))", str(out), "true"],
                               env={**os.environ, "PYTHONPATH": str(SCRIPTS)}, capture_output=True, text=True, check=False)
        self.assertEqual((1, "", 1), (again.returncode, again.stdout, again.stderr.count("\n")))
        self.assertNotIn("nsenter", again.stderr)

    def test_a_supervisor_whose_namespaces_cannot_be_entered_gives_the_reason_in_one_sentence(self):
        holder = subprocess.Popen(["sh", "-c", "sleep 100 & wait"], start_new_session=True)
        self.addCleanup(holder.wait)
        self.addCleanup(os.killpg, holder.pid, 9)
        while not attach.processes_of(holder.pid):
            pass
        _, out = self.cluster(holder=holder.pid)
        with mock.patch.object(attach, "entering", return_value=["sh", "-c", "echo 'nsenter: setns failed: Operation not permitted' >&2; exit 1"]):
            status, text = self.refused(str(out), "true")
        self.assertEqual((1, 1), (status, text.count("\n")))
        self.assertIn("cannot be entered (setns failed: Operation not permitted)", text)

    def test_a_cluster_whose_namespaces_can_be_entered_is_not_refused(self):
        _, out = self.cluster()
        for words in ([], ["sh", "-c", "exit 0"]):
            with mock.patch.object(attach, "entering", return_value=words):
                attach.check_entry(attach.cluster_of(out)[1])


if __name__ == "__main__":
    unittest.main()
