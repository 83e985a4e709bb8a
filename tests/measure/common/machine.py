"""Properties of this machine that affect timing figures."""
import os


def load():
    """Load averages over 1, 5 and 15 minutes."""
    return [round(x, 2) for x in os.getloadavg()]


def state():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        processor = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), "unknown")
    return {"processor": processor, "cores": os.cpu_count(), "load": load()}


def sentence():
    return f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
