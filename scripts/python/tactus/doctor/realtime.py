"""Checks real-time priority and locked memory, and measures wake-up latency."""
import ctypes
import os
import resource
import sys
import threading
import time

from tactus.doctor.line import GOOD, WEAK, Line

RATE_Hz = 1000           # of the haptic servo loop, the fastest loop with sleep
PRIORITY = 60            # of haptic_node
# Design: a twentieth and a half of the period of the servo loop; above the first its ticks jitter, above the second it misses ticks.
GOOD_us, WEAK_us = 50, 500
LIBC = ctypes.CDLL(None, use_errno=True)


class Timespec(ctypes.Structure):
    _fields_ = [("tv_sec", ctypes.c_long), ("tv_nsec", ctypes.c_long)]


def fifo_refusal(priority=PRIORITY):
    """None when SCHED_FIFO is allowed, else the reason. Tried in a thread, so that this process keeps its priority."""
    why = []

    def attempt():
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
        except OSError as error:
            why.append(error.strerror)

    thread = threading.Thread(target=attempt)
    thread.start()
    thread.join()
    return why[0] if why else None


def priority():
    why = fifo_refusal()
    limit = resource.getrlimit(getattr(resource, "RLIMIT_RTPRIO", 14))[0]
    if not why:
        return Line("real-time priority", GOOD, f"SCHED_FIFO {PRIORITY} is allowed", figures={"rtprio": limit})
    return Line("real-time priority", WEAK, f"SCHED_FIFO {PRIORITY} is refused ({why}): other work delays every loop",
                f"add the line \"{os.environ.get('USER', 'you')} - rtprio 90\" to /etc/security/limits.d/tactus.conf, then log in again",
                {"rtprio": limit})


def memory():
    soft = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0]
    free = soft == resource.RLIM_INFINITY or os.geteuid() == 0
    text = "unlimited" if soft == resource.RLIM_INFINITY else f"{soft / 2**20:.0f} MB"
    if free:
        return Line("locked memory", GOOD, f"may be locked ({text})", figures={"memlock": soft})
    return Line("locked memory", WEAK, f"may not be locked ({text}): a swapped-out page stops a loop for milliseconds",
                f"add the line \"{os.environ.get('USER', 'you')} - memlock unlimited\" to /etc/security/limits.d/tactus.conf, then log in again",
                {"memlock": soft})


def share(path="/proc/sys/kernel/sched_rt_runtime_us"):
    with open(path, encoding="ascii") as file:
        runtime = int(file.read())
    if runtime < 0 or runtime >= 900_000:
        text = "no limit" if runtime < 0 else f"{runtime / 10_000:.0f} % of a core"
        return Line("share of real-time work", GOOD, text, figures={"runtime_us": runtime})
    return Line("share of real-time work", WEAK, f"{runtime / 10_000:.0f} % of a core: loops that need more are stopped for the rest of "
                "each second", "sysctl kernel.sched_rt_runtime_us=950000", {"runtime_us": runtime})


def lateness_us(seconds, fifo, progress):
    """Wake-up latency of each tick of a 1 kHz loop, us. Calls progress(share done) every half second."""
    late, clock = [], time.CLOCK_MONOTONIC

    def loop():
        LIBC.prctl(29, 1000, 0, 0, 0)  # PR_SET_TIMERSLACK, ns, as in the loops of the nodes
        if fifo:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        period = 1_000_000_000 // RATE_Hz
        due = time.clock_gettime_ns(clock)
        until = Timespec()
        for _ in range(int(seconds * RATE_Hz)):
            due += period
            until.tv_sec, until.tv_nsec = divmod(due, 1_000_000_000)
            LIBC.clock_nanosleep(clock, 1, ctypes.byref(until), None)  # TIMER_ABSTIME
            late.append((time.clock_gettime_ns(clock) - due) / 1000)

    thread = threading.Thread(target=loop, daemon=True)  # Ctrl-C does not wait for it
    switch = sys.getswitchinterval()
    sys.setswitchinterval(1e-4)
    try:
        thread.start()
        while thread.is_alive():
            thread.join(0.5)
            progress(len(late) / (seconds * RATE_Hz))
    finally:
        sys.setswitchinterval(switch)
    return late


def wakeups(seconds, fifo, progress):
    late = sorted(lateness_us(seconds, fifo, progress))
    at = {name: late[min(len(late) - 1, int(share * len(late)))] for name, share in (("p50", 0.5), ("p99", 0.99), ("max", 1))}
    text = f"{at['p50']:.0f} us late in the median, p99 {at['p99']:.0f}, maximum {at['max']:.0f} (over {seconds:g} s)"
    figures = {"seconds": seconds, **{k: round(v, 1) for k, v in at.items()}, "ticks": len(late)}
    what = "waking with priority" if fifo else "waking without priority"
    if at["p99"] <= (GOOD_us if fifo else WEAK_us) and at["max"] <= 10 * WEAK_us:
        return Line(what, GOOD, text, figures=figures)
    return Line(what, WEAK, text, "end other programs, set the CPU governor to performance, and in a virtual machine use dedicated "
                "cores" if fifo else "run with real-time priority", figures)
