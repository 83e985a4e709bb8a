"""Tests of answers of hostile hosts, and of words that a program would read as options or as shell."""
import io
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import agent, agent_folders, answers, checkup, cluster_file, exchange, host_connection, main
from tactus.refusal import Refusal

HOST = cluster_file.Host("sound", "local", "sound", "", "", "")
STATES = {"run": {"run_id": 5, "build": "ab12", "services": "/tmp/x", "holder": 7, "here": ["sim_node"], "began": 1.5, "namespaces": []}, "load": 0.5, "cores": 2,
          "nodes": {"sim_node": {"up": True, "pid": 3, "deaths": 0, "lost": "", "taken_down": False, "last": "", "begun": True}}}


class Exchange(unittest.TestCase):
    def exchange(self, script, patience_s=20.0, largest=1000, data=b"", to=None):
        process = subprocess.Popen(["sh", "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0)
        try:
            return exchange.exchange(process, data, patience_s, largest, to)
        finally:
            self.assertIsNotNone(process.poll(), "the process still runs")

    def test_an_answer_and_the_end_of_the_errors_are_returned(self):
        self.assertEqual((b"ab", "e\n"), self.exchange("echo e >&2; cat", data=b"ab"))
        self.assertEqual(exchange.LARGEST_ERROR_BYTES, len(self.exchange("head -c 300000 /dev/zero >&2")[1]))
        self.assertEqual((b"x" * 10**6, ""), self.exchange("cat", data=b"x" * 10**6, largest=10**6))

    def test_a_process_that_reads_nothing_is_no_error(self):
        self.assertEqual((b"", ""), self.exchange("exec <&-; exit 0", data=b"x" * 10**6))

    def test_an_endless_answer_is_cut_and_its_process_killed(self):
        with tempfile.TemporaryFile() as to:
            for into in (None, to):
                self.assertRaises(exchange.TooLong, self.exchange, "cat /dev/zero", largest=100_000, to=into)
            self.assertLessEqual(os.fstat(to.fileno()).st_size, 100_000)

    def test_a_silent_process_is_killed_in_time(self):
        begin = time.monotonic()
        self.assertRaises(exchange.TooSlow, self.exchange, "exec sleep 60", 0.05)
        self.assertLess(time.monotonic() - begin, 30)


class Answers(unittest.TestCase):
    def checked(self, what, answer):
        out = answer if isinstance(answer, bytes) else json.dumps(answer).encode()
        return host_connection.HostConnection(HOST).checked(what, out)

    def refused(self, what, answer):
        with self.assertRaises(host_connection.Failed) as caught:
            self.checked(what, answer)
        self.assertNotIn("\n", str(caught.exception))
        self.assertTrue(str(caught.exception).startswith("sound: "))
        self.assertLess(len(str(caught.exception)), 1200)

    def test_valid_answers_are_accepted(self):
        self.assertEqual(STATES, self.checked("node_states", STATES))
        self.assertEqual({"prepared": False}, self.checked("prepare", {"prepared": False}))
        self.assertEqual({}, self.checked("ping", {}))

    def test_each_changed_member_of_an_answer_is_refused(self):
        for value in (None, "x", [], {"a": {}}, True, "\n" * 3000, float("nan")):
            for name in ("load", "nodes", "run"):
                if not (name == "load" and value is True):  # a whole number for JSON
                    self.refused("node_states", {**STATES, name: value})
        for name in STATES["run"]:
            self.refused("node_states", {**STATES, "run": {**STATES["run"], name: {}}})
        self.refused("node_states", {**STATES, "run": {**STATES["run"], "build": "../../evil"}})
        for answer in ([], "x", 5, None, b"", b"motd\n{}", b"[" * 100_000, {"refusal": "a\nb" * 3000}):
            self.refused("node_states", answer)

    def test_random_answers_are_accepted_or_refused_with_a_sentence(self):
        chance = random.Random(2)

        def value(depth):
            kinds = [lambda: None, lambda: chance.random(), lambda: "x", lambda: True, lambda: [value(depth + 1)],
                     lambda: {chance.choice(["run", "nodes", "load", "up", "lines", "x"]): value(depth + 1) for _ in range(3)}]
            return chance.choice(kinds[:4] if depth > 3 else kinds)()
        for _ in range(2000):
            what = chance.choice(list(answers.FORMS))
            try:
                self.checked(what, value(0))
            except host_connection.Failed as error:
                self.assertNotIn("\n", str(error))

    def test_figures_of_programs_are_checked(self):
        for text in ("", "[]", '{"lines": [{"what": 5}]}', '{"lines": {}}'):
            self.assertRaises(ValueError, answers.read, text, answers.DOCTOR)
        self.assertEqual({"nodes": {}}, answers.read('{"nodes": {}}', answers.WATCH))


class Words(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)

    def test_a_host_name_is_never_an_option_of_ssh_or_ip(self):
        for reach in ("ssh", "namespace", "local"):
            connection = host_connection.HostConnection(cluster_file.Host("x", reach, "-oProxyCommand=id", "", "", ""))
            with self.assertRaisesRegex(host_connection.Unreachable, "begins with -"):
                connection.command_line(["true"])
        with mock.patch.dict(os.environ, {"XDG_RUNTIME_DIR": str(self.folder)}):
            words = host_connection.HostConnection(cluster_file.Host("x", "ssh", "desk", "", "", "")).command_line(["echo", "a b"])
        self.assertEqual(["--", "desk", "echo 'a b'"], words[-3:])

    def test_a_cluster_file_with_a_host_name_that_begins_with_a_hyphen_is_refused_with_its_line(self):
        path = self.folder / "c.xml"
        path.write_text('<cluster name="c">\n<host name="-Fx" reach="ssh"/>\n</cluster>', encoding="utf-8")
        with self.assertRaisesRegex(Refusal, r"c\.xml:2: "):
            cluster_file.read(str(path))

    def test_the_doctor_runs_in_a_build_folder_with_any_name(self):
        build = self.folder / "it's $(touch sprung); \"b\" c"
        (build / "share" / "scripts").mkdir(parents=True)
        script = build / "share" / "scripts" / "tactus"
        script.write_text('#!/bin/sh\necho table\nwhile [ "$1" != --json ]; do shift; done; echo "{}" >"$2"\n', encoding="utf-8")
        script.chmod(0o755)
        operator = types.SimpleNamespace(cluster=types.SimpleNamespace(bus=types.SimpleNamespace(port=7667)))
        words = [word.replace("@BUILD@", str(build)) for word in checkup.doctor_command(operator)]
        done = subprocess.run(words, capture_output=True, text=True, check=False, cwd=self.folder)
        self.assertEqual((0, "{}\n", "table\n"), (done.returncode, done.stdout, done.stderr))
        self.assertFalse((self.folder / "sprung").exists())

    def test_a_cluster_file_of_another_user_in_the_current_folder_is_not_used(self):
        (self.folder / "cluster.xml").write_text("<cluster/>", encoding="utf-8")
        options = types.SimpleNamespace(file=None)
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        with mock.patch.dict(os.environ):
            os.environ.pop("TACTUS_CLUSTER", None)
            self.assertEqual("cluster.xml", main.cluster_file_name(options))
            with mock.patch("os.geteuid", return_value=os.geteuid() + 1), mock.patch.object(main.own_files, "owner", return_value=4242):
                with self.assertRaisesRegex(Refusal, "can run any program"):
                    main.cluster_file_name(options)


class Agent(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.request = {"folder": str(self.folder), "cluster": "c", "build": "ab"}

    def test_a_folder_of_another_user_is_refused(self):
        with mock.patch("os.geteuid", return_value=os.geteuid() + 1):
            with self.assertRaisesRegex(Refusal, "belongs to the user"):
                agent_folders.tactus_folder(self.request)
        self.folder.chmod(0o777)
        with self.assertRaisesRegex(Refusal, "every user can write"):
            agent_folders.tactus_folder(self.request)

    def test_a_damaged_or_forged_record_is_no_run(self):
        home = self.folder / "clusters" / "c"
        home.mkdir(parents=True)
        for text in ("", "[]", "{}", '{"services": "/tmp", "run_id": 1}', json.dumps(STATES["run"]), "x" * (2 << 20)):
            (home / "run.json").write_text(text, encoding="utf-8")
            self.assertEqual({}, agent_folders.run_record(self.request))
            self.assertLessEqual(agent_folders.builds_in_use(self.request), {"ab12"})

    def test_a_supervisor_that_has_ended_is_not_entered(self):
        holder = subprocess.Popen(["true"])
        self.addCleanup(holder.wait)
        os.waitid(os.P_PID, holder.pid, os.WEXITED | os.WNOWAIT)
        for pid in (holder.pid, 2**30):
            with self.assertRaisesRegex(Refusal, "the supervisor of the cluster has ended"):
                agent_folders.entering({"namespaces": ["--net"], "holder": pid})
        self.assertEqual(f"--net=/proc/{os.getpid()}/ns/net", agent_folders.entering({"namespaces": ["--net"], "holder": os.getpid()})[1])

    def test_a_program_that_does_not_end_is_one_sentence(self):
        with self.assertRaisesRegex(Refusal, "sleep: does not end within 0.05 s"):
            agent.run_bus_program({**self.request, "words": ["/bin/sleep", "60"], "patience": 0.05})

    def test_received_files_are_unpacked_as_those_of_a_hostile_host(self):
        for data in (b"", b"no archive", b"\x1f\x8b" + bytes(50)):
            with mock.patch.object(sys, "stdin", types.SimpleNamespace(buffer=io.BytesIO(data))):
                with self.assertRaisesRegex(Refusal, "cannot unpack the received files"):
                    agent.receive({**self.request, "into": "files"})
        self.assertEqual([], list(self.folder.rglob("*.new")))


if __name__ == "__main__":
    unittest.main()
