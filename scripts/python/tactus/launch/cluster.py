"""The running cluster: command lines of its processes, start and stop order, supervision."""
import contextlib
import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import time

from tactus.launch import arguments, cluster_folder, privileges, services, walls
from tactus.launch.arguments import SENSES
from tactus.paths import BIN, tactus_command
from tactus.refusal import Interrupted, Refusal
from tactus.terminal import report_error, report_run

INSIDE = pathlib.Path(__file__).resolve().parent / "inside"
# The simulation stops first, so that all modalities present its last events; the recorder last, so that the log is complete.
# Grace time in s before the next group is stopped; a node that still closes its video has already published everything.
WORLDS = ("sim_node", "replay")
STOP_ORDER = ((WORLDS, 0.3), (SENSES, 0.3), (("sync_node",), 0.3), (("recorder",), 10.0))
SCATTER_M = "0.08"  # design: keeps the balls of the dark room apart from each other and from other bodies
LAST_PRESENTATION_S = 0.2  # sound comes 20 ms after its event, and each report is repeated 20 ms later
PATIENCE_S = 15  # for a node that ends, since its video last grew: a busy machine closes a video slowly
CHECK_S, READ_SCENE_S = 60, 600
WAITS = "sim_node: "  # sim_node/run.cpp
AWAIT = "--await"  # option of sim_node: a process that has its scene before the world begins
PROGRESS_S = 10
WORLD_BEGINS = {"sim_node": "sim_node: the world begins", "replay": "replay: begins"}  # sim_node/run.cpp, sync/tools/replay_main.cpp


def common(plan, run_id):
    """Arguments common to all nodes."""
    return ["--port", str(plan.port), "--run-id", str(run_id), "--seed", str(plan.seed), "--realtime", plan.realtime, "--out", str(plan.out)]


def commands(plan, run_id, git):
    """{name: command line} of every process of the plan."""
    own = {
        "recorder": ["--scene", str(plan.scene), "--seconds", f"{plan.seconds:g}", "--git", git, *plan.recorder],
        "haptic_node": device_arguments(plan, ""),
        # A run is silent by default; with --listen the node searches for the sound card.
        "audio_node": [] if plan.listen or names_sound_card(plan) else ["--audio-device", "virtual"],
        "visual_node": ["--window"] if plan.window else [],
        "sim_node": [str(plan.scene), *scene_folders(plan), *(word for name in plan.nodes() if name != "sim_node" for word in (AWAIT, name))],
        # The seed sets the positions of the balls, so no player can rely on fixed ones.
        arguments.PLAYER: [str(plan.scene), *scene_folders(plan), "--device", arguments.PLAYER, "--scatter-along", SCATTER_M, "--scatter-aside", SCATTER_M,
                           *(["--player", plan.player, "--checks", "skip"] if plan.player not in ("", arguments.PLAYERS[0]) else [])],
        "replay": [*plan.replay, *(word for name in plan.nodes() if name != "replay" for word in ("--live", name))],
    }
    own["sync_node"] = list(plan.playout)
    for name, tool in plan.hands.items():
        own[name] = ["--name", name, "--tool", tool, *device_arguments(plan, tool)]
    for name, wall in plan.walls.items():
        own[name] = [*own.get(name, []), *(["--name", name] if name != plan.program(name) else []), "--set", f"room={plan.room}", "--set", f"wall={wall}"]
    if plan.shaders:
        for name in {walls.FIRST, *plan.walls}:
            own[name] = [*own.get(name, []), "--set", f"shader_folder={plan.shaders}"]
    if plan.degrade:
        for name in (*plan.senses(), *plan.players(), "sync_node", "sim_node"):
            own[name] = [*own.get(name, []), "--degrade", str(plan.degrade)]
    return {name: [str(plan.programs.get(plan.program(name), BIN / plan.program(name))), *own.get(name, []), *common(plan, run_id),
                   *(word for s in plan.settings.get(name, []) for word in ("--set", s))] for name in plan.nodes()}


def scene_folders(plan):
    """The option of every program that reads the scene."""
    return [word for folder in plan.scene_folders for word in ("--scene-folder", str(folder))]


def device_arguments(plan, tool):
    return ["--device", plan.devices[tool]] if tool in plan.devices else []


def names_sound_card(plan):
    return any(s.startswith("device=") for s in plan.settings.get("audio_node", []))


def check(words, stop, kept=privileges.KEPT):
    """Runs every node with --check and the rights that it has in the run. Raises Refusal with the message of the first that fails."""
    started = {}
    try:
        for name, command in words.items():
            at = command.index("--out")
            # A new session, so that only this process receives Ctrl-C.
            started[name] = subprocess.Popen(privileges.least(command[:at] + command[at + 2:] + ["--check"], kept), stdin=subprocess.DEVNULL,
                                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
                                             start_new_session=True, preexec_fn=die_with_parent)
        output = {name: check_output(name, process, stop) for name, process in started.items()}
    finally:
        for process in started.values():
            if process.poll() is None:
                process.kill()
                process.wait()
            process.stderr.close()
    for name, process in started.items():
        if process.returncode != 0:
            raise Refusal(output[name].split("\n")[-1] or f"{name}: fails its checks with status {process.returncode}")
    if output.get("sim_node"):
        report_error(output["sim_node"])  # warnings of the scene


def check_output(name, process, stop):
    """Output of the check after it has ended. Raises Interrupted when the user stops the run."""
    now = begin = time.monotonic()
    timeout_s, next_report = READ_SCENE_S if name == "sim_node" else CHECK_S, begin + PROGRESS_S
    while now < begin + timeout_s:
        try:
            output = process.communicate(timeout=0.1)[1].strip()
            if stop.requested:
                raise Interrupted
            return output
        except subprocess.TimeoutExpired:
            now = time.monotonic()
        if stop.requested:
            raise Interrupted
        if name == "sim_node" and now > next_report:
            report_run(f"sim_node is still reading the scene ({now - begin:.0f} s)")
            next_report += PROGRESS_S
    process.kill()
    return process.communicate()[1].strip() + f"\n{name}: does not finish its checks in {timeout_s} s"


def die_with_parent():
    """For Popen: the kernel kills the child when this process dies for any reason."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGKILL)


class Cluster:
    def __init__(self, plan, network, words, run_id, kept=privileges.KEPT):
        """words: {process: command line}; kept: the capabilities that the nodes of root keep."""
        self.plan, self.network, self.run_id, self.kept = plan, network, run_id, kept
        self.folder = cluster_folder.make(plan.out)
        self.in_use = None
        self.holder = self.table = self.page = None
        try:
            self.in_use = cluster_folder.lock(self.folder)
            logs = plan.out / "logs"
            logs.mkdir(mode=0o700, exist_ok=True)
            here = pathlib.Path.cwd()
            self.services = {name: services.Service(self.folder, name, command, logs / f"{name}.log", here)
                             for name, command in words.items()}
        except OSError as error:
            self.clean()
            raise Refusal(f"supervision: cannot prepare the run in {self.folder} ({error.strerror}); free space there, or set "
                          "TMPDIR to another folder") from None

    def start(self):
        """Starts the supervisor, recorder and sync_node, the modalities, then the simulation. Raises Refusal."""
        words = [*self.network.unshare, str(INSIDE), str(self.folder),
                 "private" if self.network.private else "host", *self.kept]
        if not self.network.unshare:
            # Without a process namespace, SIGHUP makes runsvdir end all of its services.
            words = ["setpriv", "--pdeathsig", "HUP", *words]
        with open(self.plan.out / "logs" / "supervisor.log", "w", encoding="utf-8") as log:
            self.holder = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
                                           preexec_fn=die_with_parent if self.network.unshare else None)
        for group in (("recorder", "sync_node"), (*self.plan.senses(), *self.plan.players()), (self.plan.world,)):
            members = [self.services[name] for name in group if name in self.services]
            for service in members:
                if not service.start():
                    raise Refusal(f"{service.name}: the supervisor does not start it; see {self.plan.out}/logs/supervisor.log")
                if not (self.folder / "address").exists():  # supervisor and network exist, so tactus attach works
                    self.write_address()
            if group != (self.plan.world,):  # loading the scene is awaited elsewhere
                services.wait_until(lambda: all(s.has_output() for s in members), 5.0)

    def write_address(self):
        """Writes the file by which tactus attach finds the cluster."""
        cluster_folder.write_address(self.folder, self.holder.pid, self.network.unshare, self.run_id, f"udpm://239.255.76.67:{self.plan.port}?ttl=0",
                                     self.plan.port, self.plan.out)
        link = self.plan.out / "cluster"
        link.unlink(missing_ok=True)
        link.symlink_to(self.folder)

    def show_table(self):
        """Starts the live table, printed once a second until the end."""
        words = [*tactus_command("attach"), str(self.plan.out), *privileges.least([BIN / "watch"], self.kept)]
        self.table = subprocess.Popen(words, stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=die_with_parent)

    def end_table(self):
        if self.table is not None:
            kill_group(self.table)
            self.table = None

    def expects_world(self):
        """False without a simulation, or after it was left down."""
        return self.plan.world in self.services and not self.services[self.plan.world].lost()

    def world_has_begun(self):
        world = self.plan.world
        return world in self.services and self.services[world].log_contains(WORLD_BEGINS[world])

    def waits_for(self):
        """"waits for NODE (REASON)" when the simulation has loaded its scene and another process has not; "" otherwise."""
        line = self.services[self.plan.world].last_output_line()
        return line.removeprefix(WAITS) if line.startswith(WAITS + "waits for") else ""

    def alive(self):
        return self.holder is not None and self.holder.poll() is None

    def lost(self):
        """{node: why} of the nodes that could not be kept running."""
        return {name: s.lost() for name, s in self.services.items() if s.lost()}

    def taken_down(self):
        """The nodes that the user stopped with sv. Call it before stop()."""
        return [name for name, s in self.services.items() if s.is_stopped_by_user()] if self.alive() else []

    def stop(self, delay_s=0.0):
        """Stops all processes in order. Returns the names of those that had to be killed. delay_s: longest intended delay of the
        last presentations."""
        self.end_table()
        with contextlib.suppress(OSError):  # full disk: the only effect is that exits count as deaths
            (self.folder / "stopping").touch()
        if not self.alive():
            return []
        for names, grace_s in STOP_ORDER:
            names = (*self.plan.senses(), *self.plan.players()) if names == SENSES else names
            services.request_end([self.services[name] for name in names if name in self.services], grace_s)
            if names == WORLDS:
                time.sleep(LAST_PRESENTATION_S + delay_s)
        killed = services.end_or_kill(self.services.values(), PATIENCE_S, lambda: video_sizes(self.plan.out))
        self.end_supervisor()
        return killed

    def end_supervisor(self):
        for pid in children(self.holder.pid) if self.network.unshare else [self.holder.pid]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGHUP)
        try:
            self.holder.wait(5)
        except subprocess.TimeoutExpired:
            self.holder.kill()
            self.holder.wait()

    def clean(self):
        """Removes the temporary files of the running cluster."""
        with contextlib.suppress(OSError):
            (self.plan.out / "cluster").unlink(missing_ok=True)
        shutil.rmtree(self.folder, ignore_errors=True)
        if self.in_use:
            self.in_use.close()


def video_sizes(folder):
    """The sizes of the videos of a run, in bytes, by name."""
    with contextlib.suppress(OSError):  # a video is removed meanwhile
        return {file.name: file.stat().st_size for file in folder.glob("*.mp4")}
    return {}


def children(pid):
    try:
        return [int(p) for p in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()]
    except OSError:
        return []


def kill_group(process):
    try:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait(2)
    except ProcessLookupError:
        process.wait()
    except subprocess.TimeoutExpired:  # it blocks on a stopped terminal
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
