"""The cluster of a study: the address of its live page is read from its log, also when it is printed late."""
import pathlib
import sys
import tempfile
import threading
import time
import types
import unittest
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import live_cluster


class TheLivePageOfAStudy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.cluster = live_cluster.LiveCluster.__new__(live_cluster.LiveCluster)
        self.cluster.log = pathlib.Path(folder.name) / "run1.log"
        self.cluster.log.write_text("run: single_taps.sdf, 86400 s\n", encoding="utf-8")
        self.returncode = None
        self.cluster.process = types.SimpleNamespace(poll=lambda: self.returncode)

    def say(self, text):
        with open(self.cluster.log, "a", encoding="utf-8") as log:
            log.write(text)

    def test_is_awaited_until_its_line_is_complete(self):
        def later():
            time.sleep(0.1)
            self.say("run: the live page: http://127.0.0.1:46")
            time.sleep(0.1)
            self.say("417/?token=3a8d\n")
        teller = threading.Thread(target=later)
        teller.start()
        self.addCleanup(teller.join)
        self.assertEqual(self.cluster.page(), "http://127.0.0.1:46417/?token=3a8d")

    def test_is_in_a_log_that_only_the_user_can_read(self):
        self.cluster.log.chmod(0o644)
        with mock.patch.object(live_cluster.subprocess, "Popen") as start:
            made = live_cluster.LiveCluster(self.cluster.log.with_suffix(""), ["--live"])
        self.assertEqual(self.cluster.log, made.log)
        self.assertEqual(0o600, made.log.stat().st_mode & 0o777)
        self.assertTrue(start.called)

    def test_is_none_if_the_run_reports_that_it_does_not_start(self):
        self.say(f"run: {live_cluster.NO_PAGE}; the run continues without it; see logs/live_server.log\n")
        self.assertIsNone(self.cluster.page())
        self.assertIn(live_cluster.NO_PAGE, (SCRIPTS / "python" / "tactus" / "launch" / "live.py").read_text(encoding="utf-8"))

    def test_is_not_awaited_after_the_run_has_ended(self):
        self.returncode = 1
        with self.assertRaisesRegex(Refusal, "the cluster has ended"):
            self.cluster.page()


if __name__ == "__main__":
    unittest.main()
