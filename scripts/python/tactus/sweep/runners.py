"""Runners of the chunks of a sweep: processes on this machine, or a Slurm cluster. No name of the user is parsed by a shell or as a pattern."""
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


def keep_on(processor):
    """For Popen: the child and its children run on this processor only. Where that is not allowed, they run on any."""
    with contextlib.suppress(OSError):
        os.sched_setaffinity(0, {processor})


def die_with_parent():
    """For Popen: the child gets SIGTERM when this process ends for any reason."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


@contextlib.contextmanager
def interrupts_held():
    """Within it Ctrl-C and SIGTERM wait, so that a process that was started is also known."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield before
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Parallel:
    """Plays chunks on this machine, each in its own process, from the first poll() on. A failed chunk does not stop the others.

    Each process keeps to one of the processors that this process may use, the one with the fewest jobs: the processes of a game wait for each other, so a
    second processor would help none, and a move costs caches."""

    def __init__(self, folder, chunks, jobs):
        self.waiting = list(chunks)
        self.processors = sorted(os.sched_getaffinity(0))
        self.jobs, self.words = jobs, [*JOB, str(folder.path.absolute())]
        self.running, self.place = [], {}  # jobs; the processor of each
        self.errors = folder.path / "errors.txt"
        self.errors.write_bytes(b"")

    def fill(self):
        """Starts waiting chunks until `jobs` run."""
        while self.waiting and len(self.running) < self.jobs:
            words = [*self.words, str(self.waiting.pop(0))]
            used = [self.place[job.pid] for job in self.running]
            processor = min(self.processors, key=used.count)
            with open(self.errors, "ab") as errors, interrupts_held() as mask:
                def prepare(mask=mask, processor=processor):
                    die_with_parent()
                    keep_on(processor)
                    signal.pthread_sigmask(signal.SIG_SETMASK, mask)
                # A new session, so that Ctrl-C reaches only the sweep, which ends its jobs.
                self.running.append(subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors, start_new_session=True,
                                                     preexec_fn=prepare))
                self.place[self.running[-1].pid] = processor

    @property
    def workers(self):
        """Chunks that are played at the same time, each with the speed of one processor at most."""
        return min(self.jobs, len(self.processors))

    def poll(self):
        """Starts the next chunks. True when all are finished."""
        self.running = [job for job in self.running if job.poll() is None]
        self.fill()
        return not self.running

    def said(self):
        return (self.errors.read_text(encoding="utf-8", errors="replace").strip().splitlines() or ["no message"])[-1]

    def end(self):
        self.waiting = []
        for number in (signal.SIGTERM, signal.SIGKILL):
            for job in self.running:
                with contextlib.suppress(ProcessLookupError):  # its programs are in its session
                    os.killpg(job.pid, number)
            with contextlib.suppress(subprocess.TimeoutExpired):
                for job in self.running:
                    job.wait(10)
                return


class Slurm:
    """Plays chunks as an array job, with TACTUS_BIN and PATH of this process. DIR and the repository must have the same paths on its nodes."""

    def __init__(self, folder, chunks, partition, size):
        for program in ("sbatch", "squeue", "scancel"):
            needed(program, "slurm-wlm")
        self.folder = folder
        self.place = folder.path.absolute()
        listed = self.place / "array.txt"
        listed.write_text("\n".join(map(str, chunks)) + "\n", encoding="utf-8")
        last = min(size, len(chunks)) - 1
        # The output pattern is relative to --chdir, because a folder may hold % and \\ (sbatch(1), filename pattern).
        words = ["sbatch", "--parsable", f"--array=0-{last}", "--ntasks=1", "--cpus-per-task=1", f"--job-name=sweep-{folder.study.name}", "--export=ALL",
                 f"--chdir={self.place}", "--output=slurm-%a.txt", *([f"--partition={partition}"] if partition else [])]
        done = subprocess.run(words, input=self.script(listed), capture_output=True, text=True, errors="surrogateescape", check=False)
        if done.returncode != 0:
            raise Refusal(f"sbatch refused the jobs: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
        self.job = done.stdout.strip().split(";")[0]
        self.over, self.workers = False, last + 1  # workers: tasks that run, or all until the first is seen to run

    def script(self, listed):
        """The batch script, which sbatch reads from stdin."""
        return "#!/bin/sh\nexec " + shlex.join([*JOB, str(self.place), "--of-array", str(listed)]) + "\n"

    def poll(self):
        """True when no task of the array is pending or running."""
        done = subprocess.run(["squeue", "--noheader", "--jobs", self.job, "--states=all", "--format=%T"], capture_output=True, text=True, check=False)
        gone = done.returncode != 0 and "Invalid job id" in done.stderr  # Slurm has removed the finished job
        states = done.stdout.split()
        self.workers = states.count("RUNNING") or self.workers
        self.over = gone or done.returncode == 0 and all(state in SETTLED for state in states)
        return self.over

    def said(self):
        said = [line for file in sorted(self.folder.path.glob("slurm-*.txt")) for line in file.read_text(encoding="utf-8", errors="replace").splitlines()]
        return (said or ["no message"])[-1]

    def end(self):
        if not self.over:
            subprocess.run(["scancel", self.job], capture_output=True, check=False)
