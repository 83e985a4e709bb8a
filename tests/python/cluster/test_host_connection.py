"""Tests of access to hosts: which connections are shared and which are separate."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import cluster_file, host_connection
from tactus.paths import SCRIPTS


class Connections(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        before = os.environ.get("XDG_RUNTIME_DIR")
        os.environ["XDG_RUNTIME_DIR"] = self.folder.name
        self.addCleanup(lambda: os.environ.pop("XDG_RUNTIME_DIR") if before is None else os.environ.update(XDG_RUNTIME_DIR=before))

    def path(self, ssh_config):
        words = host_connection.HostConnection(cluster_file.Host("world", "ssh", "world", "", "", ""), ssh_config).command_line(["true"])
        return next(w for w in words if w.startswith("ControlPath="))

    def test_another_ssh_configuration_has_its_own_connection(self):
        self.assertEqual(self.path(None), self.path(None))
        self.assertEqual(self.path("/a/config"), self.path("/a/../a/config"))
        self.assertEqual(3, len({self.path(None), self.path("/a/config"), self.path("/b/config")}))

    def test_another_network_namespace_has_its_own_connection(self):
        inside = ["unshare", "--net", "--user", "--map-root-user"] if os.getuid() else ["unshare", "--net"]
        if subprocess.run([*inside, "true"], capture_output=True, check=False).returncode:
            self.skipTest("this system allows no private network")
        program = f"import sys; sys.path[:0] = {[str(SCRIPTS / 'python')]!r}; from tactus.cluster import host_connection; print(host_connection.control_folder(None))"
        said = subprocess.run([*inside, sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.strip()
        self.assertNotEqual(str(host_connection.control_folder(None)), said)

    def test_the_path_of_a_socket_is_short_enough_for_folders_of_every_length(self):
        home = os.environ.get("HOME")
        self.addCleanup(lambda: os.environ.update(HOME=home) if home else os.environ.pop("HOME"))
        for length in range(1, 70, 3):
            for variable in ("HOME", "XDG_RUNTIME_DIR"):
                with tempfile.TemporaryDirectory(dir="/tmp") as folder, self.subTest(variable=variable, length=length):
                    long = pathlib.Path(folder, "h" * length)
                    long.mkdir(mode=0o700)
                    os.environ.pop("XDG_RUNTIME_DIR", None)
                    os.environ[variable] = str(long)
                    # ssh replaces %C by 40 digits, and adds a dot and 16 letters while it connects; a socket's path has at most 107 bytes (unix(7)).
                    path = self.path(None).partition("=")[2].replace("%C", "c" * 40) + "." + "r" * 16
                    self.assertLessEqual(len(os.fsencode(path)), 107)

    def test_a_host_that_neither_answers_nor_closes_its_connection_is_unreachable_in_one_sentence(self):
        ssh = pathlib.Path(self.folder.name, "ssh")
        ssh.write_text("#!/bin/sh\nexec sleep 60\n", encoding="utf-8")
        ssh.chmod(0o755)
        host = host_connection.HostConnection(cluster_file.Host("world", "ssh", "world", "", "", ""))
        with mock.patch.dict(os.environ, PATH=f"{self.folder.name}:{os.environ['PATH']}"), mock.patch.object(host_connection, "CLOSE_S", 0.1), \
                self.assertRaisesRegex(host_connection.Unreachable, "^world: does not answer within 0.1 s$"):
            host.request("ping", patience_s=0.1)

    def requests_until_answer(self, what, failures, message):
        """(number of connections, answer or None) of a request when the first connections fail with a message of ssh."""
        ssh, count = pathlib.Path(self.folder.name, "ssh"), pathlib.Path(self.folder.name, "count")
        count.write_text("", encoding="utf-8")
        ssh.write_text(f"#!/bin/sh\necho >>{count}\n[ $(wc -l <{count}) -le {failures} ] && echo '{message}' >&2 && exit 255\n"
                       "cat >/dev/null\n", encoding="utf-8")
        ssh.chmod(0o755)
        host = host_connection.HostConnection(cluster_file.Host("world", "ssh", "world", "", "", ""))
        with mock.patch.dict(os.environ, PATH=f"{self.folder.name}:{os.environ['PATH']}"), mock.patch.object(host_connection.HostConnection, "checked", lambda _, what, out: what):
            try:
                answer = host.request(what)
            except host_connection.Unreachable:
                answer = None
        return len(count.read_text(encoding="utf-8")), answer

    def test_a_request_is_repeated_once_after_a_lost_connection_when_that_changes_nothing_more(self):
        self.assertEqual((2, "node_states"), self.requests_until_answer("node_states", 1, ""))
        self.assertEqual((2, "stop"), self.requests_until_answer("stop", 1, "Timeout, server world not responding."))
        self.assertEqual((2, None), self.requests_until_answer("node_states", 2, ""))
        self.assertEqual((1, None), self.requests_until_answer("send_command", 1, ""))
        self.assertEqual((1, None), self.requests_until_answer("node_states", 1, "ssh: connect to host world port 22: No route to host"))

    def test_only_the_owner_can_read_the_folder(self):
        self.assertEqual(0o700, host_connection.control_folder(None).stat().st_mode & 0o777)


if __name__ == "__main__":
    unittest.main()
