"""LCM event logs of tests: reading, writing, and recording in virtual time."""
import os
import pathlib
import struct
import subprocess

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or REPOSITORY / "build" / "dev" / "bin")
SYNC_WORD = 0xEDA1DA01


def read_log(path):
    data, at = path.read_bytes(), 0
    while at < len(data):
        _, _, stamp, name_bytes, size = struct.unpack(">IqqII", data[at:at + 28])
        yield stamp, data[at + 28:at + 28 + name_bytes], data[at + 28 + name_bytes:at + 28 + name_bytes + size]
        at += 28 + name_bytes + size


def write_log(path, events):
    with open(path, "wb") as file:
        for number, (stamp, channel, data) in enumerate(events):
            file.write(struct.pack(">IqqII", SYNC_WORD, number, stamp, len(channel), len(data)) + channel + data)


def make_run(folder, scene, seconds):
    words = [str(REPOSITORY / "scripts" / "run"), "--virtual-time", "--seconds", str(seconds), "--out", str(folder), scene]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env={**os.environ, "TACTUS_BIN": str(BIN)})
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return list(read_log(folder / "run.lcmlog"))
