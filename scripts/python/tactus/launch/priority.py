"""Real-time priority: whether this system grants it, and the effect of its absence."""
import os
import subprocess

from tactus.paths import packages_remedy
from tactus.refusal import Refusal

HIGHEST = 70  # of audio_node; all others are lower


def expectation(choice):
    """One sentence for the user. Raises Refusal when priority is required and refused."""
    if choice == "off":
        return "real-time priority is off: beside a busy renderer a 1 ms loop wakes up to 3 ms late (p99)"
    if is_granted():
        return "real-time priority: audio 70, haptic 60, sim 50, sync_node and recorder 40; visual nodes normal"
    if choice == "require":
        raise Refusal(f"haptic_node: --realtime require, but {refusal_reason()}; {packages_remedy('--realtime')} and log in again, or "
                      "use --realtime try")
    return (f"no real-time priority ({refusal_reason()}): the run works, but beside a busy renderer a 1 ms loop wakes up to 3 ms "
            "late (p99); tactus setup --realtime allows it")


def is_granted():
    return subprocess.run(["chrt", "-f", str(HIGHEST), "true"], capture_output=True, check=False).returncode == 0


def refusal_reason():
    return "the system refuses it to root here" if os.geteuid() == 0 else "ulimit -r is below 70"
