"""The live page of a running cluster (scripts/run --live). Its socket is opened here, outside the network of the cluster, and
inherited by the server inside."""
import os
import signal
import socket
import subprocess
import time

from tactus.launch import privileges
from tactus.launch.cluster import die_with_parent
from tactus.paths import BIN, SCRIPTS, remedy, tactus_command
from tactus.refusal import Refusal
from tactus.terminal import report_run

PAGE = SCRIPTS / "live" / "page" / "dist"
ADDRESS = "live_server: open "  # scripts/live/live_server_main.cpp, which never prints the token that it inherits
TIMEOUT_S = 10
RESTART_DELAY_S = 1  # minimum time between two starts of the server


class Page:
    def __init__(self, port):
        """Raises Refusal when the port is in use, or the page was not built."""
        for path in (BIN / "live_server", PAGE / "main.js"):
            if not path.is_file():
                raise Refusal(f"--live: {path} does not exist; {remedy('live_server and scripts/live/bundle')}")
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self.socket.bind(("127.0.0.1", port))
            self.socket.listen(16)
        except OSError as error:
            self.socket.close()
            raise Refusal(f"--live {port}: cannot listen on this port ({error.strerror}); choose another, or omit the "
                          "number") from None
        self.token = os.urandom(16).hex()
        self.process = None
        self.out = None
        self.started = 0.0

    def start(self, out):
        """Starts the server inside the cluster that writes to `out`; prints the address of the page."""
        self.out = out
        self.launch()
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end and self.process.poll() is None:
            with open(self.log(), encoding="utf-8", errors="replace") as file:
                if ADDRESS in file.read():
                    report_run(f"the live page: http://127.0.0.1:{self.socket.getsockname()[1]}/?token={self.token}")
                    return
            time.sleep(0.05)
        report_run(f"the live page does not start; the run continues without it; see {self.log()}")

    def log(self):
        return self.out / "logs" / "live_server.log"

    def launch(self):
        self.started = time.monotonic()
        words = [*tactus_command("attach"), str(self.out), *privileges.least([BIN / "live_server", "--page", PAGE, "--listen-fd", self.socket.fileno()])]
        with open(os.open(self.log(), os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600), "a", encoding="utf-8") as log:
            self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
                                            env={**os.environ, "TACTUS_LIVE_TOKEN": self.token},
                                            pass_fds=(self.socket.fileno(),), preexec_fn=die_with_parent)

    def restart_if_ended(self):
        """Restarts a server that died; the address of the page stays the same."""
        if self.process is not None and self.process.poll() is not None and time.monotonic() > self.started + RESTART_DELAY_S:
            self.launch()

    def stop(self):
        if self.process is not None and self.process.poll() is None:
            try:
                os.killpg(self.process.pid, signal.SIGTERM)
                self.process.wait(2)
            except ProcessLookupError:
                self.process.wait()
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()
        self.socket.close()
