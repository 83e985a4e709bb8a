"""Runners of the chunks of a sweep: GNU parallel on this machine, or a Slurm cluster."""
import contextlib
import ctypes
import os
import shlex
import shutil
import signal
import subprocess

from tactus.paths import tactus_module
from tactus.refusal import Refusal

JOB = tactus_module("sweep.job")
SETTLED = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "BOOT_FAIL", "DEADLINE", "PREEMPTED")


def needed(program, package):
    if not shutil.which(program):
        raise Refusal(f"{program} is not installed; run apt install {package}")


def die_with_parent():
    """For Popen: the child gets SIGTERM when this process ends for any reason."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


class Parallel:
    """Plays chunks on the cores of this machine. A failed chunk does not stop the others."""

    def __init__(self, folder, chunks, jobs):
        needed("parallel", "parallel")
        words = ["parallel", "--will-cite", "--jobs", str(jobs), *JOB, str(folder.path.absolute()), "{}", ":::", *map(str, chunks)]
        self.errors = open(folder.path / "errors.txt", "w+", encoding="utf-8")
        self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.errors, start_new_session=True,
                                        preexec_fn=die_with_parent)

    def poll(self):
        """True when all chunks are finished."""
        return self.process.poll() is not None

    def said(self):
        self.errors.seek(0)
        return (self.errors.read().strip().splitlines() or ["no message"])[-1]

    def end(self):
        with contextlib.suppress(ProcessLookupError):  # on the second SIGTERM parallel also ends running jobs
            for _ in range(2):
                if self.process.poll() is None:
                    self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


class Slurm:
    """Plays chunks as an array job, with TACTUS_BIN and PATH of this process. DIR and the repository must have the same paths on its nodes."""

    def __init__(self, folder, chunks, partition, size):
        for program in ("sbatch", "squeue", "scancel"):
            needed(program, "slurm-wlm")
        self.folder = folder
        listed = folder.path.absolute() / "array.txt"
        listed.write_text("\n".join(map(str, chunks)) + "\n", encoding="utf-8")
        last = min(size, len(chunks)) - 1
        words = ["sbatch", "--parsable", f"--array=0-{last}", "--ntasks=1", "--cpus-per-task=1", f"--job-name=sweep-{folder.study.name}",
                 f"--output={folder.path.absolute()}/slurm-%a.txt", *([f"--partition={partition}"] if partition else []),
                 "--wrap", "exec " + shlex.join([*JOB, str(folder.path.absolute()), "--of-array", str(listed)])]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Refusal(f"sbatch refused the jobs: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
        self.job = done.stdout.strip().split(";")[0]
        self.over = False

    def poll(self):
        """True when no task of the array is pending or running."""
        done = subprocess.run(["squeue", "--noheader", "--jobs", self.job, "--states=all", "--format=%T"], capture_output=True, text=True, check=False)
        gone = done.returncode != 0 and "Invalid job id" in done.stderr  # Slurm has removed the finished job
        self.over = gone or done.returncode == 0 and all(state in SETTLED for state in done.stdout.split())
        return self.over

    def said(self):
        said = [line for file in sorted(self.folder.path.glob("slurm-*.txt")) for line in file.read_text(errors="replace").splitlines()]
        return (said or ["no message"])[-1]

    def end(self):
        if not self.over:
            subprocess.run(["scancel", self.job], capture_output=True, check=False)
