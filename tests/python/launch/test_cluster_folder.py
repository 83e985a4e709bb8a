"""Tests of the temporary folders of clusters: files of other users beside them are not used and do not stop a run."""
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import cluster_folder


class Folders(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.tmp = pathlib.Path(kept.name)
        changed = mock.patch.object(tempfile, "tempdir", str(self.tmp))
        changed.start()
        self.addCleanup(changed.stop)

    def named(self, name):
        return self.tmp / (cluster_folder.PREFIX.format(user=os.geteuid()) + name)

    def test_a_folder_is_private_and_its_name_is_random(self):
        made = [cluster_folder.make(self.tmp) for _ in range(8)]
        self.assertEqual({0o700}, {folder.stat().st_mode & 0o777 for folder in made})
        self.assertEqual(8, len({folder.name for folder in made}))

    def test_a_folder_runs_while_its_lock_is_held_and_is_removed_afterwards(self):
        kept, left = cluster_folder.make(self.tmp), cluster_folder.make(self.tmp)
        lock = cluster_folder.lock(kept)
        cluster_folder.lock(left).close()
        self.assertEqual([kept], cluster_folder.running())
        cluster_folder.remove_leftovers()
        self.assertEqual((True, False), (kept.exists(), left.exists()))
        lock.close()
        cluster_folder.remove_leftovers()
        self.assertFalse(kept.exists())

    def test_a_named_pipe_a_link_and_a_file_never_block_and_are_left_alone(self):
        self.named("pipe").mkdir(mode=0o700)
        os.mkfifo(self.named("pipe") / "in_use")
        self.named("link").mkdir(mode=0o700)
        (self.named("link") / "in_use").symlink_to("/etc/hostname")
        os.mkfifo(self.named("itself"))
        target = cluster_folder.make(self.tmp)
        cluster_folder.lock(target).close()
        self.named("folder-link").symlink_to(target)
        self.named("open").mkdir(mode=0o777)
        self.named("open").chmod(0o777)
        (self.named("open") / "in_use").touch()
        cluster_folder.remove_leftovers()  # the old program waited for a writer of the pipe
        self.assertEqual([], cluster_folder.running())
        self.assertTrue((self.named("pipe") / "in_use").is_fifo())
        self.assertTrue((self.named("open") / "in_use").exists())

    def test_a_folder_of_another_user_is_never_opened(self):
        forged = cluster_folder.make(self.tmp)
        cluster_folder.lock(forged).close()
        other = os.geteuid() + 1
        forged = forged.rename(self.tmp / (cluster_folder.PREFIX.format(user=other) + "x"))
        with mock.patch("os.geteuid", return_value=other), mock.patch("os.open", side_effect=AssertionError("opened")):
            cluster_folder.remove_leftovers()
            self.assertEqual([], cluster_folder.running())
            self.assertIsNone(cluster_folder.address(forged))
        self.assertTrue(forged.exists())


if __name__ == "__main__":
    unittest.main()
