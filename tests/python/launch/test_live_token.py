"""Tests that the token of the live page is not printed where other users may read it."""
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import live
from tactus.paths import BIN

TOKEN = "0123456789abcdef0123456789abcdef"


@unittest.skipUnless((BIN / "live_server").exists(), "live_server is not built")
class Token(unittest.TestCase):
    def first_line(self, *words, **environment):
        """The first line of a live_server that shows a log of one event."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file in ("index.html", "main.js", "icon.svg", "main.css"):
                (folder / file).write_text("x", encoding="utf-8")
            (folder / "run.lcmlog").write_bytes(struct.pack(">IqqII", 0xEDA1DA01, 0, 1, 1, 8) + b"X" + bytes(8))
            process = subprocess.Popen([str(BIN / "live_server"), str(folder / "run.lcmlog"), "--page", str(folder), *words], stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True, env={**os.environ, **environment})
            try:
                line = process.stdout.readline()
                inside = pathlib.Path(f"/proc/{process.pid}/cmdline").read_text(encoding="utf-8")
            finally:
                process.send_signal(signal.SIGTERM)
                rest = process.communicate()[0]
            self.assertEqual("", rest)
            self.assertNotIn(TOKEN, inside if not words else "")
            return line

    def test_an_inherited_token_is_never_printed(self):
        line = self.first_line(TACTUS_LIVE_TOKEN=TOKEN)
        self.assertTrue(line.startswith(live.ADDRESS + "http://127.0.0.1:"), line)
        self.assertNotIn(TOKEN, line)
        self.assertNotIn("token=", line)

    def test_a_token_that_the_server_makes_is_printed_for_the_user(self):
        line = self.first_line()
        self.assertRegex(line, r"live_server: open http://127\.0\.0\.1:\d+/\?token=[0-9a-f]{32}\n")


if __name__ == "__main__":
    unittest.main()
