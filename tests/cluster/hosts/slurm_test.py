"""Tests of a sweep as a job array on a Slurm cluster of one node: slurmctld and slurmd of Debian, in namespaces of their own."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.study import trial_table

EXIT_SKIPPED = 77
NODE, ADDRESS = "one", "10.88.0.1"  # an interface name and an address that no other program uses
NAMESPACES = ["unshare", "--net", "--uts", "--pid", "--fork", "--kill-child", "--mount-proc"]
TIMEOUT_S = 180  # liveness: other tests run beside it
CONFIGURATION = """ClusterName=one
SlurmctldHost={node}({address})
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName={node} NodeAddr={address} CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={node} Default=YES MaxTime=INFINITE State=UP
"""
STUDY = f"""<?xml version="1.0" encoding="UTF-8"?>
<study name="short" version="1" scene="{ROOT}/sim_node/scenes/dark_room_game.sdf" task="game" seed="3">
  <conditions>
    <nothing/><remove modality="audio"/><factor modality="visual" operator="delay" levels="50ms 300ms"/>
  </conditions>
  <procedure kind="constant" repetitions="1"/>
  <response kind="performance"/>
  <stimulus by="participant" limit="1s"/>
</study>
"""


def output_of(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False)


class SweepOnSlurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        socket.sethostname(NODE)
        for words in ("link set lo up", "link add here type veth peer name there", f"addr add {ADDRESS}/24 dev here", "link set here up", "link set there up"):
            subprocess.run(["ip", *words.split()], check=True)
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-slurm-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        for name in ("state", "spool"):
            (cls.folder / name).mkdir()
        (cls.folder / "slurm.conf").write_text(CONFIGURATION.format(node=NODE, address=ADDRESS, folder=cls.folder, cores=os.cpu_count()), encoding="ascii")
        os.environ["SLURM_CONF"] = str(cls.folder / "slurm.conf")
        for words in (["slurmctld", "-D", "-c"], ["slurmd", "-D", "-c", "-N", NODE]):
            daemon = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            cls.addClassCleanup(daemon.wait)
            cls.addClassCleanup(daemon.terminate)
        cls.until(cls, lambda: "idle" in output_of("sinfo", "--noheader", "--format=%T").stdout, "the node is idle")
        cls.study = cls.folder / "short.xml"
        cls.study.write_text(STUDY, encoding="utf-8")

    def until(self, condition, what):
        end = time.monotonic() + TIMEOUT_S
        while not condition():
            if time.monotonic() > end:
                logs = "".join(path.read_text(errors="replace")[-1500:] for path in self.folder.glob("*.log"))
                raise AssertionError(f"{what}: not within {TIMEOUT_S} s\n{logs}")
            time.sleep(0.1)

    def words(self, *words):
        return [str(ROOT / "scripts" / "tactus"), "study", "sweep", *map(str, words)]

    def sweep(self, *words):
        done = output_of(*self.words(*words))
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        return done.stdout

    def jobs(self):
        return output_of("squeue", "--noheader", "--format=%i").stdout.split()

    def test_it_plays_the_same_games_as_parallel(self):
        self.sweep(self.study, "--games", 3, "--jobs", 2, "--out", self.folder / "parallel")
        output = self.sweep(self.study, "--games", 3, "--slurm", "--partition", "all", "--array-size", 3, "--out", self.folder / "slurm")
        self.assertIn("12 of 12 games", output)
        self.assertEqual((self.folder / "parallel" / "games.csv").read_bytes(), (self.folder / "slurm" / "games.csv").read_bytes())
        self.assertEqual({0}, {row["missed"] for row in trial_table.read(self.folder / "slurm" / "games.csv")})

    def test_the_killed_client_resumes_without_lost_or_repeated_games(self):
        out = self.folder / "killed"
        chunks = lambda: sum(path.stat().st_size for path in (out / "chunks").glob("*.csv")) if (out / "chunks").is_dir() else 0
        process = subprocess.Popen(self.words(self.study, "--games", 6, "--slurm", "--array-size", 2, "--out", out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.until(lambda: chunks() > 0, "a game is played")
        process.send_signal(signal.SIGKILL)
        process.wait()
        for job in self.jobs():
            output_of("scancel", job)
        self.until(lambda: not self.jobs(), "the jobs have ended")
        self.sweep("--resume", "--slurm", "--out", out)
        rows = trial_table.read(out / "games.csv")
        self.assertEqual(list(range(1, 25)), [row["trial"] for row in rows])

    def test_an_interrupt_cancels_its_jobs(self):
        out = self.folder / "ended"
        process = subprocess.Popen(self.words(self.study, "--games", 200, "--slurm", "--array-size", 2, "--out", out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.until(self.jobs, "jobs wait or run")
        process.send_signal(signal.SIGTERM)
        self.assertNotEqual(0, process.wait(TIMEOUT_S))
        self.until(lambda: not self.jobs(), "no job waits or runs")

    def test_a_missing_partition_is_refused_in_one_sentence(self):
        done = output_of(*self.words(self.study, "--games", 1, "--slurm", "--partition", "none", "--out", self.folder / "refused"))
        self.assertEqual((1, 1), (done.returncode, len(done.stderr.strip().splitlines())), done.stderr)
        self.assertIn("sbatch refused", done.stderr)


if __name__ == "__main__":
    if sys.argv[1:2] != ["inside"]:
        if os.getuid() or subprocess.run([*NAMESPACES, "true"], capture_output=True, check=False).returncode:
            print("this test needs root and namespaces for a private Slurm cluster")
            sys.exit(EXIT_SKIPPED)
        sys.exit(subprocess.run([*NAMESPACES, sys.executable, __file__, "inside"], check=False).returncode)
    unittest.main(argv=sys.argv[:1])
