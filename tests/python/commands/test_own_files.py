"""Tests that files and folders of other users, links and named pipes are not used."""
import contextlib
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus import own_files
from tactus.cluster import cluster_file
from tactus.refusal import Refusal
from tactus.study import journal, study_file, trial_table
from tactus.sweep import adopted

as_another_user = mock.patch("os.geteuid", return_value=os.geteuid() + 1)


class OwnFiles(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)

    def test_a_regular_file_of_this_user_is_read_up_to_its_limit(self):
        path = self.folder / "a"
        path.write_bytes(b"text\xff")
        self.assertEqual("text\udcff", own_files.read_own(path, 5))
        with self.assertRaisesRegex(OSError, "longer than 4 bytes"):
            own_files.read_own(path, 4)

    def test_an_output_that_cannot_be_written_or_is_an_input_is_refused_before_the_work(self):
        given = self.folder / "run.lcmlog"
        given.write_bytes(b"log")
        (self.folder / "link").symlink_to(given)
        refused = lambda path: self.assertRaisesRegex(Refusal, "^--json .*; name (a file in a writable folder|another file)$", own_files.require_writable, "--json", str(path), [str(given)])
        for path in (self.folder, self.folder / "none" / "a.json", given / "a.json", given, self.folder / "link", f"{self.folder}/"):
            refused(path)
        refused("")
        for path in (None, str(self.folder / "a.json"), "/dev/stdout"):
            own_files.require_writable("--json", path, [str(given)])
        self.assertFalse((self.folder / "a.json").exists())

    def test_an_output_replaces_no_result_in_a_folder_that_is_an_input(self):
        for name, replaces in (("run.lcmlog", True), ("haptic.csv", True), ("presented_audio.csv", True), ("summary.json", True), ("audio.wav", True), ("metrics.csv", False), ("metrics.json", False)):
            (self.folder / name).write_bytes(b"")
            for given, refused in ((self.folder, replaces), (pathlib.Path("/"), False)):
                with self.assertRaisesRegex(Refusal, "is the input itself") if refused else contextlib.nullcontext():
                    own_files.require_writable("--json", str(self.folder / name), [str(given)])

    def test_a_link_a_pipe_and_a_file_of_another_user_are_refused_without_waiting(self):
        (self.folder / "file").write_text("", encoding="utf-8")
        (self.folder / "link").symlink_to(self.folder / "file")
        os.mkfifo(self.folder / "pipe")
        for name in ("link", "pipe", "."):
            self.assertRaises(OSError, own_files.open_own, self.folder / name)
        with as_another_user, self.assertRaisesRegex(OSError, "not a regular file of this user"):
            own_files.open_own(self.folder / "file")

    def test_a_pipe_or_a_device_is_refused_as_input_without_waiting(self):
        os.mkfifo(self.folder / "pipe")
        (self.folder / "link").symlink_to("/dev/zero")
        for path in (self.folder / "pipe", self.folder / "link", "/dev/zero", self.folder):
            with self.assertRaisesRegex(OSError, "is not a regular file"):
                own_files.read_regular(path, 10)
        (self.folder / "file").write_bytes(b"x" * 20)
        with as_another_user:
            self.assertEqual(b"x" * 11, own_files.read_regular(self.folder / "file", 10))

    def test_tables_studies_clusters_and_journals_that_are_pipes_are_one_sentence(self):
        for name, read in (("t.csv", trial_table.read), ("s.xml", study_file.read), ("c.xml", lambda path: cluster_file.read(str(path))),
                           ("t.csv.xz", adopted.read), (journal.NAME, lambda path: journal.read(path.parent))):
            os.mkfifo(self.folder / name)
            with self.assertRaisesRegex(Refusal, "cannot be read"):
                read(self.folder / name)

    def test_a_private_folder_is_closed_to_others_and_not_of_another_user_or_a_link(self):
        made = own_files.make_private_folder(self.folder / "a" / "b")
        self.assertEqual([0o700, 0o700], [path.stat().st_mode & 0o777 for path in (made, made.parent)])
        self.assertTrue(own_files.is_private_folder(made))
        made.chmod(0o755)
        self.assertFalse(own_files.is_private_folder(made))
        own_files.make_private_folder(made)
        self.assertEqual(0o700, made.stat().st_mode & 0o777)
        (self.folder / "link").symlink_to(made)
        self.assertFalse(own_files.is_private_folder(self.folder / "link"))
        with self.assertRaisesRegex(Refusal, "is not a folder"):
            own_files.make_private_folder(self.folder / "link")
        with as_another_user:
            self.assertFalse(own_files.is_private_folder(made))
            with self.assertRaisesRegex(Refusal, "belongs to the user"):
                own_files.make_private_folder(made)

    def test_a_private_file_replaces_a_file_or_link_of_the_same_name(self):
        (self.folder / "target").write_text("kept", encoding="utf-8")
        (self.folder / "log").symlink_to(self.folder / "target")
        with own_files.open_private(self.folder / "log") as file:
            file.write("new")
        self.assertEqual(("kept", "new"), ((self.folder / "target").read_text(encoding="utf-8"), (self.folder / "log").read_text(encoding="utf-8")))
        self.assertEqual(0o600, (self.folder / "log").lstat().st_mode & 0o777)

    def test_only_a_process_of_this_user_is_its_own(self):
        self.assertTrue(own_files.is_own_process(os.getpid()))
        for pid in ("none", -1, 2**30, "../1"):
            self.assertFalse(own_files.is_own_process(pid))
        with as_another_user:
            self.assertFalse(own_files.is_own_process(os.getpid()))


if __name__ == "__main__":
    unittest.main()
