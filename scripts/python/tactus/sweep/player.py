"""Client of bin/play_games, a process that plays games of a scene one after the other."""
import json
import subprocess
import tempfile

from tactus.paths import BIN, remedy
from tactus.refusal import Refusal

PROGRAM = BIN / "play_games"


class Player:
    """Context manager that starts and ends the process. Raises Refusal."""

    def __init__(self, scene):
        self.scene = scene

    def __enter__(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="games-")
        try:
            self.process = subprocess.Popen([str(PROGRAM), str(self.scene), "--out", self.scratch.name], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                            stderr=subprocess.PIPE, text=True, errors="replace")
        except OSError as error:
            self.scratch.cleanup()
            raise Refusal(f"{PROGRAM}: cannot be run ({error.strerror}); {remedy()}") from None
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.stdin.close()
            self.process.wait()
        self.scratch.cleanup()

    def play(self, request):
        """Plays one game and returns its result; scripts/virtual_time/README.md describes request and result. Raises Refusal if the process has ended."""
        try:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()
            line = self.process.stdout.readline()
            if not line:
                raise BrokenPipeError
        except BrokenPipeError:
            self.process.kill()
            said = (self.process.communicate()[1].strip().splitlines() or ["no message"])[-1]
            raise Refusal(f"play_games ended before game {request['game']}: {said}") from None
        return json.loads(line)
