"""A replay, after the build: reads the description of the log, then runs like scripts/run with `replay` instead of the
simulation."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

from tactus import terminal
from tactus.launch import arguments, cluster, delays, hands, keys, main as supervisor, privileges
from tactus.log import description
from tactus.refusal import Refusal, sentence_of
from tactus.terminal import report_run

SENSES = arguments.SENSES
REPLAY_OPTIONS = ("speed", "start", "end", "channels", "leave_out", "also", "most")
END_REACHED = "replay: over"  # sync/tools/replay_main.cpp
EXIT_LINE = "replay: ends"
SETTLING_S = 0.5  # the last sounds and frames are presented after the last message
MAX_SECONDS = arguments.MAX_SECONDS


def describe_log(log, run=1):
    """Description of a run of the log: scene, tools, seed, recovered, warnings. Raises Refusal."""
    return description.describe(log, run, lambda words: privileges.least(words, privileges.needed([words[0], log])), cluster.BIN)


def parse(words, here):
    """(plan, --stay, description of the log). Raises Refusal."""
    parser = arguments.Parser(add_help=False, allow_abbrev=False, prog="replay")
    parser.error = lambda message: (_ for _ in ()).throw(Refusal(f"{message}; see tactus replay --help"))
    parser.add_argument("log")
    for option in (*REPLAY_OPTIONS, "out", "degrade", *arguments.PLAYOUT):
        parser.add_argument("--" + option.replace("_", "-"))
    for option in ("only", "without", "rename", "device", "set"):
        parser.add_argument("--" + option, action="append", default=[])
    for option in ("loop", "paused", "as-recorded", "verbatim", "stay", "window", "listen"):
        parser.add_argument("--" + option, action="store_true")
    parser.add_argument("--realtime", choices=("require", "try", "off"), default="try")
    parser.add_argument("--seed")
    parser.add_argument("--json")
    parser.add_argument("--run")
    parser.add_argument("--network", choices=("auto", "private", "host"), default="auto")
    parser.add_argument("--port", default="7667")
    for word in words:
        if any(ord(c) < 32 or ord(c) == 127 for c in word):
            raise Refusal(f"argument {word!r}: contains a control character; remove it")
    a = parser.parse_args(words)
    here = pathlib.Path(here)
    log = here / a.log  # for a folder, the program replay reads all parts
    if a.run and description.run_number(a.run) is None:
        raise Refusal(f"--run {a.run}: is not the number of a run; give a whole number from 1, as in the column run of tactus export")
    run = [a.run] if a.run else []
    described = describe_log(log, *run)
    others = hands.processes(described["tools"])
    known = (*SENSES, *others, "sync_node")
    for node in (*a.only, *a.without):
        if node not in known:
            raise Refusal(f"--only or --without {node}: there is no such node in a replay; choose from {', '.join(known)}")
    without = [*a.without]
    if a.only:
        wanted = {*a.only, *(name for name in others if hands.FIRST in a.only)}
        without += [n for n in (*SENSES, *others) if n not in wanted]
        if hands.FIRST in without and wanted & set(others):
            raise Refusal(f"--only {', '.join(sorted(wanted & set(others)))}: {hands.FIRST} holds the first tool; add --only {hands.FIRST}")
    elif hands.FIRST in without:
        without += [*others]
    if a.degrade and a.as_recorded:
        raise Refusal("--degrade and --as-recorded contradict each other; remove one")
    others = {process: tool for process, tool in others.items() if process not in without}
    words = [str(log), "--stay", *(word for number in run for word in ("--run", number))]
    for option in REPLAY_OPTIONS:
        if (value := getattr(a, option)) is not None:
            words += ["--" + option.replace("_", "-"), value]
    words += [f"--{option.replace('_', '-')}" for option in ("loop", "paused", "as_recorded", "verbatim") if getattr(a, option)]
    words += [word for rename in a.rename for word in ("--rename", rename)]
    a.without = without
    return arguments.Plan(
        scene=pathlib.Path(described["scene"] or log.name), shaders=None, seconds=MAX_SECONDS,
        out=arguments.out_folder(here, a.out), out_is_ours=not a.out, without=without,
        devices=arguments.devices(a.device, without, described["tools"]), hands=others, room="", walls={},
        degrade=arguments.profile(here, a.degrade), playout=arguments.playout(a), window=a.window, listen=a.listen,
        realtime=a.realtime, seed=int(arguments.number("--seed", a.seed or str(described["seed"]), 0, 2**63 - 1, "", whole=True)),
        network=a.network, port=int(arguments.number("--port", a.port, 1024, 65534, "", whole=True)),
        settings=arguments.settings(a.set, others), world="replay", replay=words,
        json=(here / a.json).absolute() if a.json else None), a.stay, described


def watcher(control, stay):
    """Returns the watch function for main.run: waits for the end of the replay and forwards commands to it."""
    def watch_over(running, _seconds, stop):
        world = running.services["replay"]
        begun, over_since = False, None
        settling_s = SETTLING_S + delays.longest_s(running.plan)
        reported = set()
        with keys.KeyCommands(control) as commands:
            while not stop.requested:
                if not begun and running.world_has_begun():
                    begun = True
                    running.show_table()
                if commands.forward_new() or world.log_contains(EXIT_LINE):
                    break
                over = END_REACHED in world.last_output_line()
                over_since = (over_since or time.monotonic()) if over else None
                if over and not stay and time.monotonic() > over_since + settling_s:
                    break
                if not running.alive():
                    raise Refusal(f"supervisor: ended too early; see {running.plan.out}/logs/supervisor.log")
                for name, why in running.lost().items():
                    if name not in reported:
                        reported.add(name)
                        report_run(f"{name}: {why}; the others continue ({running.services[name].last_output_line()})")
                if world.lost():
                    break
                time.sleep(0.05)
        return begun
    return watch_over


def main(words):
    terminal.prepare()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-replay-"))
    control = folder / "control"
    try:
        os.mkfifo(control)
        plan, stay, described = parse(words, os.getcwd())
        plan.replay += ["--control", str(control)]
        if described["recovered"]:
            report_run(described["recovered"])
        description.report_warnings("run", described)
        plan.out.mkdir(parents=True, exist_ok=True)
        (plan.out / "control").unlink(missing_ok=True)
        (plan.out / "control").symlink_to(control)
        plan.out_is_ours = False
        errors = supervisor.run(plan, watcher(control, stay))
        (plan.out / "control").unlink(missing_ok=True)
        if plan.json:
            supervisor.copy_summary(plan)
    except Refusal as refusal:
        errors = [str(refusal)]
    except OSError as error:
        errors = [sentence_of(error)]
    except (supervisor.Interrupted, KeyboardInterrupt):
        terminal.report_error("replay: interrupted; nothing was started")
        return supervisor.INTERRUPTED
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for sentence in errors:
        terminal.report_error(sentence if supervisor.starts_with_program_name(sentence) or sentence.startswith("replay:")
                          else f"replay: {sentence}")
    return 1 if errors else 0
