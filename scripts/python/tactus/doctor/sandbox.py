"""Checks the measures of the kernel that confine parsers of foreign files (sync/sandbox/README.md)."""
import ctypes
import errno
import os

from tactus.doctor.line import GOOD, WEAK, Line

CREATE_RULESET = 444  # landlock_create_ruleset, the same number on all architectures
LIBC = ctypes.CDLL(None, use_errno=True)


def landlock_version():
    """Version of the kernel's Landlock; 0: it has none, or it is not among the security modules of its command line."""
    return max(0, LIBC.syscall(CREATE_RULESET, None, 0, 1))


def has_seccomp():
    """True when the kernel has filters of system calls: it looks for the filter, which is missing here, only if it has them."""
    return LIBC.prctl(22, 2, None, 0, 0) != 0 and ctypes.get_errno() == errno.EFAULT  # PR_SET_SECCOMP, SECCOMP_MODE_FILTER


def confinement(landlock=landlock_version, seccomp=has_seccomp):
    version, filters = landlock(), seccomp()
    figures = {"landlock": version, "seccomp": filters}
    lacks = [name for name, there in (("Landlock", version >= 1), ("seccomp filters", filters)) if not there]
    if not lacks:
        return Line("confinement of parsers", GOOD, f"Landlock {version} and seccomp filters", figures=figures)
    risks = [risk for risk, there in (("read other files of the user", version >= 1), ("use the network", filters)) if not there]
    return Line("confinement of parsers", WEAK, f"Linux {os.uname().release} has no {' and no '.join(lacks)}: a hostile scene, picture or sound "
                f"could {' and '.join(risks)}", "boot Linux 5.13 or later with both (lsm=landlock), or open only files from sources that you trust",
                figures)
