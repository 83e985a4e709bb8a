"""The sound server that the variable PULSE_SERVER names (PulseAudio, PipeWire)."""
import re
import socket

PORT = 4713       # of PulseAudio, pulse-client.conf(5)
PATIENCE_S = 1.0  # for a server on the network


def place(entry):
    """(family, address) of one entry of PULSE_SERVER: unix:PATH, PATH, tcp:HOST[:PORT], HOST[:PORT]; each may begin with {machine id}."""
    entry = re.sub(r"^\{[^}]*\}", "", entry)
    if entry.startswith(("unix:", "/")):
        return socket.AF_UNIX, entry.removeprefix("unix:")
    host, _, port = re.sub(r"^tcp[46]?:", "", entry).rpartition(":")
    if not port.isdigit() or not host:
        host, port = f"{host}:{port}" if host else port, PORT
    return socket.AF_INET, (host.strip("[]"), int(port))


def answers(entry):
    """True when the server accepts a connection."""
    family, address = place(entry)
    try:
        if family == socket.AF_UNIX:
            with socket.socket(family, socket.SOCK_STREAM) as s:
                s.settimeout(PATIENCE_S)
                s.connect(address)
        else:
            socket.create_connection(address, PATIENCE_S).close()
        return True
    except (OSError, OverflowError, UnicodeError):
        return False


def is_silent(variable):
    """True when PULSE_SERVER names servers and none of them answers."""
    entries = (variable or "").split()
    return bool(entries) and not any(map(answers, entries))
