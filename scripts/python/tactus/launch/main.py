"""One run, after the build: checks, start, live table, stop, summary."""
import fcntl
import os
import stat
import time

from tactus import own_files, players, signals, terminal
from tactus.launch import arguments, cluster, cluster_folder, delays, equipment, hands, live, network, priority, privileges, virtual, walls
from tactus.launch.results import WORLD_STOPPED, git_commit, summarise
from tactus.paths import remedy
from tactus.refusal import Interrupted, Refusal, sentence_of
from tactus.terminal import report_run

INTERRUPTED = 130  # exit status of a shell after Ctrl-C
MAX_LOADING_S = 600
PROGRESS_S = 5


def watch_over(running, seconds, stop):
    """Returns after `seconds` of simulation, or when the user stops the run. Waits first until the scene is loaded, which takes
    minutes for a large scene, unless there is no simulation. Reports each node that is left down. Returns False when the
    simulation never began. Raises Refusal."""
    now = loading_since = time.monotonic()
    next_report = now + PROGRESS_S
    end = None
    reported = set()
    while not stop.requested and (end is None or now < end):
        now = time.monotonic()
        if end is None and (running.world_has_begun() or not running.expects_world()):
            end = now + seconds
            running.show_table()
        elif end is None and now > loading_since + MAX_LOADING_S:
            raise Refusal(f"sim_node: its world has not begun after {MAX_LOADING_S // 60} minutes; see "
                          f"{running.plan.out}/logs/sim_node.log")
        elif end is None and now > next_report:
            waits = running.waits_for()
            report_run(f"sim_node {waits} ({now - loading_since:.0f} s)" if waits else f"sim_node is still reading the scene ({now - loading_since:.0f} s)")
            next_report += PROGRESS_S
        if running.page is not None:
            running.page.restart_if_ended()
        if not running.alive():
            raise Refusal(f"supervisor: ended too early; see {running.plan.out}/logs/supervisor.log")
        for name, why in running.lost().items():
            if name not in reported:
                reported.add(name)
                report_run(f"{name}: {why}; the others continue ({running.services[name].last_output_line()})")
        time.sleep(0.1)
    if end is not None and now < end:
        stop.cut_short = f"ended by {stop.reason} after {seconds - (end - now):.1f} of {seconds:g} s"
    return end is not None


def claim_out(plan):
    """Makes and locks the results folder; returns the descriptor that holds the lock. Of two runs that start in the same
    second the later one takes the next name. Raises Refusal."""
    while True:
        try:
            plan.out.mkdir(parents=True, exist_ok=not plan.out_is_ours)
            claim = os.open(plan.out, os.O_RDONLY | os.O_DIRECTORY)
            refuse_foreign_folder(plan.out, os.fstat(claim))
        except FileExistsError:
            plan.out = plan.out.with_name(plan.out.name + "+")
            continue
        except OSError as error:
            raise Refusal(f"recorder: cannot create the folder {plan.out} ({error.strerror}); name another with --out") from None
        try:
            fcntl.flock(claim, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(claim)
            raise Refusal(f"recorder: another run is writing to --out {plan.out}; name another folder") from None
        except OSError:
            pass  # a file system without locks
        return claim


def refuse_foreign_folder(path, found):
    """Raises Refusal for a shared folder such as /tmp, and, for root, a folder of another user: links that others put there would be
    followed. found: os.stat_result of the folder."""
    if found.st_mode & stat.S_ISVTX and found.st_mode & stat.S_IWOTH:
        raise Refusal(f"recorder: --out {path}: every user can write there; name a folder of your own")
    if os.geteuid() == 0 and found.st_uid != 0:
        raise Refusal(f"recorder: --out {path}: belongs to the user {own_files.user_name(found.st_uid)}, and this run is of root; run as that user, or "
                      "name another folder")


def inputs(plan):
    """Files and folders that the nodes read."""
    window = [os.environ["XAUTHORITY"]] if plan.window and os.environ.get("XAUTHORITY") else []
    return [os.getcwd(), cluster.BIN, cluster.BIN / "sim_node", plan.scene.parent, plan.scene, *plan.scene_folders, *filter(None, [plan.degrade, plan.shaders]), *plan.replay[:1], *plan.programs.values(), *window]


def run(plan, watch=watch_over):
    """Executes one run; watch(running, seconds, stop) determines its duration. Returns the errors, one sentence each.
    Raises Refusal when the run does not start."""
    if ":" in plan.player and plan.checks != "skip":
        players.checked([players.Player(plan.player)], plan.checks, report_run)
    kept = privileges.needed(inputs(plan))
    if plan.virtual is not None:
        return virtual.run(plan, signals.Stop(), claim_out, kept)
    if plan.programs:  # programs of the user find the readers of foreign formats there (sync/sandbox/reader_child.cpp)
        os.environ["TACTUS_BIN"] = str(cluster.BIN)
    stop = signals.Stop()
    git = git_commit()
    run_id = time.time_ns()
    for name in [*dict.fromkeys(plan.program(n) for n in plan.nodes()), "watch", "summarise", "export_csv", "export_events"]:
        if not os.access(cluster.BIN / name, os.X_OK):
            raise Refusal(f"{name}: {cluster.BIN / name} is missing; {remedy()}")
    cluster.check(cluster.commands(plan, run_id, git), stop, kept)
    for name in arguments.unknown_modalities(plan):
        report_run(f"{name!r} is not a modality of this run; check the names in the profile and in --soa")
    expectation = priority.expectation(plan.realtime)
    net = network.choose(plan.network, plan.port)
    cluster_folder.remove_leftovers()
    page = live.Page(plan.live) if plan.live is not None else None
    claim = claim_out(plan)
    warnings = equipment.missing_equipment(plan)
    running = cluster.Cluster(plan, net, cluster.commands(plan, run_id, git), run_id, kept)
    report_run(f"{plan.scene.name}, {plan.seconds:g} s, seed {plan.seed}, network {net.description}, results in {plan.out}")
    report_run(expectation)
    for warning in (*filter(None, [privileges.description(kept)]), *warnings):
        report_run(warning)
    errors = []
    try:
        running.start()
        if page is not None:
            running.page = page
            page.start(plan.out)
        if not watch(running, plan.seconds, stop):
            errors.append("interrupted before the world began")
    except Refusal as refusal:
        errors.append(str(refusal))
    except OSError as error:
        errors.append(sentence_of(error))
    finally:
        if page is not None:
            page.stop()
        taken_down = running.taken_down()
        killed = running.stop(0.0 if stop.requested else delays.longest_s(plan))
        lost = running.lost()
        deaths = {name: reasons for name, s in running.services.items() if (reasons := s.death_reasons())}
        restarts = {name: len(reasons) for name, reasons in deaths.items()}
        last_lines = {name: running.services[name].last_output_line() for name in lost}
        running.clean()
    errors += [f"{name}: could not be kept running: {why} ({last_lines[name]}); see {plan.out}/logs/{name}.log"
              for name, why in lost.items()]
    errors += [f"{name}: did not end on request and was killed; see {plan.out}/logs/{name}.log" for name in killed]
    for name, count in restarts.items():
        if name not in lost:
            report_run(f"{name} died and was restarted {count} times" if count > 1 else f"{name} died once and was restarted")
    for name in taken_down:
        report_run(f"{name} was taken down and not started again")
    if stop.cut_short:
        report_run(stop.cut_short)
        warnings.append(stop.cut_short)
    warnings += lines_with(VIDEO_ENDS, running.services)
    errors += summarise(plan, git, {*lost, *taken_down}, restarts, warnings)
    report_run(f"results in {plan.out}")
    errors += incomplete_recording(plan.out, running.services["recorder"].last_line_with(REFUSED), deaths.get("recorder", []))
    errors += incomplete_sound(lines_with(SOUND_LOST, running.services))
    if "sim_node" in running.services:
        errors += stopped_world(plan.out, running.services["sim_node"].last_line_with([WORLD_STOPPED]))
    os.close(claim)
    return errors


REFUSED = ("the disk refuses the log", " lost because ")  # sync/tools/recorder/recorder.cpp
SOUND_LOST = ("the disk refuses the sound", "the disk is too slow for the sound")  # audio_node/devices/stream.cpp
VIDEO_ENDS = ("the video ends early",)  # visual_node/video/recording.cpp
MORE_SPACE = "free space, raise the limit of file sizes (ulimit -f), or name another folder with --out"


def stopped_world(out, said):
    """The error of a world whose state is not finite. said: its sentence, or ""; its restarts stop likewise."""
    return [f"{said}; see {out}/logs/sim_node.log"] if said else []


def incomplete_recording(out, refused, deaths):
    """The errors of the recorder, one sentence each, with the lost part. refused: the line of its output about refused messages, or ""; deaths: how it
    died, each time."""
    errors = []
    if deaths:
        times = "once" if len(deaths) == 1 else f"{len(deaths)} times"
        errors.append(f"recorder: died {times}, the last time by {deaths[-1]}; the messages of that time are not in {out}/run.lcmlog; see {out}/logs/recorder.log")
    disk = os.statvfs(out)
    if refused:
        errors.append(f"{refused}; {MORE_SPACE}")
    elif disk.f_bavail * disk.f_frsize < arguments.FULL_BYTES:
        errors.append(f"recorder: the disk of {out} is full; the last messages, the end of sound and video, and tables can be missing; free space, or name "
                      "another folder with --out")
    return errors


def lines_with(words, services):
    """The last line of the output of each node that holds one of these texts."""
    return [line for service in services.values() if (line := service.last_line_with(words))]


def incomplete_sound(lines):
    """The errors of sound files that end early or lack a part. lines: of the output of each node that reported one."""
    return [f"{line}; {MORE_SPACE}" for line in lines]


def starts_with_program_name(sentence):
    program = sentence.split(":")[0]
    return program.endswith("_node") or program.startswith((f"{hands.FIRST}_", f"{walls.FIRST}_")) or program in ("recorder", "network", "supervision", "supervisor", "summarise", "export_csv", "export_events")


def copy_summary(plan):
    """Writes summary.json also to the file of --json, which may be a pipe. Raises OSError."""
    summary = plan.out / "summary.json"
    if summary.is_file():
        with open(plan.json, "wb") as file:
            file.write(summary.read_bytes())


def main(words):
    only_arguments = words[:1] == ["--arguments-only"]
    terminal.prepare()
    try:
        plan = arguments.parse(words[1:] if only_arguments else words, os.getcwd())
        errors = [] if only_arguments else run(plan)
        if plan.json and not only_arguments:
            copy_summary(plan)
    except Refusal as refusal:
        errors = [str(refusal)]
    except OSError as error:
        errors = [sentence_of(error)]
    except (Interrupted, KeyboardInterrupt):
        if only_arguments:  # scripts/run reports it
            return INTERRUPTED
        terminal.report_error("run: interrupted; nothing was started")
        return INTERRUPTED
    for sentence in errors:
        terminal.report_error(terminal.one_line(sentence if starts_with_program_name(sentence) else f"run: {sentence}"))
    return 1 if errors else 0
