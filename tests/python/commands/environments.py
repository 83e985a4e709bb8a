"""The table of environments and commands: every command must answer in every environment as in a plain one.

A row of the answer is "as plain", or the difference. tests/measure/environment_table prints the table; test_environments requires that it holds.
"""
import concurrent.futures
import dataclasses
import os
import pathlib
import stat
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.commands.table import BY_NAME

SCRIPTS = ROOT / "scripts"
TIMEOUT_S = 60
# Output of the dynamic linker and of bash itself before the first line of a script.
NOT_OURS = ("ERROR: ld.so: object", "shell-init: error", "chdir: error", "/bin/bash: warning: setlocale")
TRAP = "#!/bin/sh\n: >>'{folder}/sprung'\nexit 7\n"


@dataclasses.dataclass(frozen=True)
class Environment:
    """variables: added to the environment, with {folder} for the scratch folder. prefix: command words before the command. refused: the sentence that replaces the answer of every command."""
    name: str
    variables: dict = dataclasses.field(default_factory=dict)
    prefix: tuple = ()
    refused: str = ""
    linked: bool = False
    folder: str = ""


FOLDER = "the current folder does not exist any more, or this user cannot enter it; change to another folder"
LONG = "/".join(["d" * 200] * 6)  # 1,205 characters
HOSTILE = "a b&'\"$(touch sprung)`touch sprung`;\n%s*[x]\\" + os.fsdecode(b"\xff")
ENVIRONMENTS = (
    Environment("CDPATH with the folder itself", {"CDPATH": "{folder}:/:."}),
    Environment("CDPATH empty", {"CDPATH": ":"}),
    Environment("a link to the command", linked=True),
    Environment("GIT_DIR of another repository", {"GIT_DIR": "{folder}/other/.git", "GIT_WORK_TREE": "{folder}", "GIT_INDEX_FILE": "/proc/none"}),
    Environment("LD_PRELOAD of a missing library", {"LD_PRELOAD": "/proc/none/lib.so"}),
    Environment("LD_PRELOAD of a missing and an installed library", {"LD_PRELOAD": "/proc/none/lib.so:libm.so.6"}),
    Environment("TMP and TEMP", {"TMP": "{folder}/tmp", "TEMP": "/proc/none"}),
    Environment("TMPDIR that is not there", {"TMPDIR": "/proc/none"}),
    Environment("TMPDIR with a space", {"TMPDIR": "{folder}/tmp dir"}),
    Environment("another python3 first in PATH", {"PATH": "{folder}/traps:" + os.environ["PATH"]}),
    Environment("a short PATH", {"PATH": "/usr/bin:/bin"}),
    Environment("PYTHONPATH and PYTHONHOME", {"PYTHONPATH": "{folder}/traps", "PYTHONHOME": "/proc/none", "PYTHONINSPECT": "1", "PYTHONWARNINGS": "error"}),
    Environment("a dead PULSE_SERVER", {"PULSE_SERVER": "tcp:127.0.0.1:1", "PIPEWIRE_REMOTE": "none"}),
    Environment("a dead DISPLAY", {"DISPLAY": ":99", "WAYLAND_DISPLAY": "none", "XAUTHORITY": "/proc/none"}),
    Environment("BASH_ENV and ENV", {"BASH_ENV": "{folder}/traps/start", "ENV": "{folder}/traps/start"}),
    Environment("options of bash", {"SHELLOPTS": "errexit:noglob:nounset:xtrace", "BASHOPTS": "nullglob:failglob", "PS4": "$(touch {folder}/sprung)"}),
    Environment("exported functions", {f"BASH_FUNC_{name}%%": "() {{ touch {folder}/sprung; return 7; }}" for name in ("cd", "dirname", "cat", "cmake", "source", "fail")}),
    Environment("POSIXLY_CORRECT", {"POSIXLY_CORRECT": "1"}),
    Environment("IFS, GLOBIGNORE, FUNCNEST, TMOUT", {"IFS": "/", "GLOBIGNORE": "*", "EXECIGNORE": "*", "FUNCNEST": "1", "TMOUT": "1"}),
    Environment("GREP_OPTIONS", {"GREP_OPTIONS": "-v --color=always", "GREP_COLOR": "1"}),
    Environment("PARALLEL and SHELL", {"PARALLEL": "--dry-run", "SHELL": "/bin/false"}),
    Environment("settings of matplotlib", {"MATPLOTLIBRC": "/proc/none", "MPLBACKEND": "none", "MPLCONFIGDIR": "/proc/none"}),
    Environment("settings of node and cmake", {"NODE_OPTIONS": "--require /proc/none", "NODE_ENV": "production", "CMAKE_GENERATOR": "none"}),
    Environment("no HOME", {"HOME": "/proc/none", "XDG_CACHE_HOME": "/proc/none", "XDG_RUNTIME_DIR": "/proc/none"}),
    Environment("locale C", {"LC_ALL": "C"}),
    Environment("a locale with a decimal comma", {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8", "LANGUAGE": "de"}),
    Environment("a Turkish locale", {"LC_ALL": "tr_TR.UTF-8"}),
    Environment("no TERM, narrow", {"TERM": "", "COLUMNS": "80", "NO_COLOR": "1"}),
    Environment("a time zone of +14 h", {"TZ": "Pacific/Kiritimati"}),
    Environment("umask 077", prefix=("sh", "-c", 'umask 077; exec "$@"', "sh")),
    Environment("nohup", prefix=("nohup",)),
    Environment("SIGINT ignored", prefix=("sh", "-c", "trap '' INT; exec \"$@\"", "sh")),
    Environment("stdin closed", prefix=("sh", "-c", 'exec "$@" <&-', "sh")),
    Environment("a folder with a hostile name", folder=HOSTILE),
    Environment("a folder of 1,205 characters", folder=LONG),
    Environment("a folder that was removed", prefix=("sh", "-c", 'd=$(mktemp -d ./goneXXXXXX) && cd "$d" && rmdir "../$d"; exec "$@"', "sh"), refused=FOLDER),
)
# Cheap work, and refusals that name the input; the other commands print their help.
CASES = {
    "run --arguments-only": ("--module", "tactus.launch.main", "--arguments-only", "--seconds", "2"),
    "run: a scene that is not there": ("run", "none.sdf"),
    "build: an unknown preset": ("build", "--preset", "none"),
    "test: a wrong number": ("test", "--repeat", "none"),
    "setup: an unknown option": ("setup", "--none"),
    "degrade: a missing profile": ("degrade", "none.xml"),
    "set: a missing folder": ("set", "haptic_node", "a=1", "--in", "none"),
    "export: a missing log": ("export", "none.lcmlog"),
    "log upgrade: a missing name": ("log", "upgrade", "a"),
    "study: an unknown study": ("study", "analyse", "none"),
    "study replicate: an unknown experiment": ("study", "replicate", "none"),
    "study information: an unknown task": ("study", "information", "none"),
    "metrics: a missing run": ("metrics", "none", "--json", "figures.json"),
    "rerun: a missing log": ("rerun", "none"),
    "analyse-modes: a missing recording": ("analyse-modes", "none.wav", "--picture", "picture.svg"),
    "report: a missing log": ("report", "none"),
    "cluster check of a shipped file": ("cluster", "check", "one_machine"),
    "units into a folder that is not there": ("units", "install", "--root", "none"),
    "drumkit-sounds: no kits": ("drumkit-sounds", "sounds", "--from", "none"),
}


def commands():
    """{name: words after scripts/tactus} of all rows."""
    with_case = {words[0] for words in CASES.values()}
    return {**{f"{name} --help": (name, "--help") for name in BY_NAME if name not in with_case}, **CASES}


def prepare(folder):
    """Makes the files that the environments name."""
    for name in ("tmp", "tmp dir", "traps", "other/.git", LONG):
        (folder / name).mkdir(parents=True)
    (folder / HOSTILE).mkdir()
    for name in ("python3", "python", "ninja", "node", "start"):
        trap = folder / "traps" / name
        trap.write_text(TRAP.format(folder=folder), encoding="utf-8")
        trap.chmod(0o755)
    for name in ("json", "argparse", "pathlib", "tactus"):
        (folder / "traps" / f"{name}.py").write_text(f"open({str(folder / 'sprung')!r}, 'a')\n", encoding="utf-8")


def answer(folder, environment, words):
    """(status, stdout, stderr) of a command in an environment, without the lines of the dynamic linker and of the start of bash."""
    kept = {name: value for name, value in os.environ.items() if name in ("PATH", "HOME", "USER", "LANG")}
    variables = {**kept, "LC_ALL": "C.UTF-8", "TACTUS_BIN": "/nowhere", **{name: value.format(folder=folder) for name, value in environment.variables.items()}}
    program = SCRIPTS / "tactus"
    if environment.linked:
        program = folder / "linked"
        if not program.is_symlink():
            program.symlink_to(SCRIPTS / "tactus")
    try:
        done = subprocess.run([*environment.prefix, program, *words], cwd=folder / environment.folder, env=variables, stdin=subprocess.DEVNULL, capture_output=True,
                              check=False, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return None, b"", b"still runs"
    said = b"\n".join(line for line in done.stderr.splitlines() if not line.decode(errors="replace").startswith((*NOT_OURS, "nohup: ")))
    return done.returncode, done.stdout, said


def difference(environment, plain, found, name):
    """"as plain", or what differs."""
    status, out, said = found
    if environment.refused:
        sentence = environment.refused.encode()
        right = status == 1 and not out and said.endswith(sentence) and said.count(b"\n") == 0
        return "refused in one sentence" if right else f"status {status}, {out[:100]!r}, {said[:200]!r}"
    if found == plain:
        return "as plain"
    if environment.folder and status == 1 and not out and b"contains a control character; remove it" in said and said.count(b"\n") == 0:
        return "refused in one sentence"
    return f"status {status}, plain {plain[0]}; stdout {'as plain' if out == plain[1] else repr(out[:100])}; stderr {said[:200]!r}, plain {plain[2][:200]!r}"


def table(folder, jobs=2, names=None, helps_every=1):
    """{environment: {command: verdict}}; names: of the environments, default all. helps_every: the help of each command only in every n-th environment.
    Raises AssertionError when a file of the user was executed."""
    prepare(folder)
    before = sorted(path for path in folder.rglob("*"))
    chosen = [e for e in ENVIRONMENTS if names is None or e.name in names]
    rows = commands()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        plain = dict(zip(rows, pool.map(lambda words: answer(folder, Environment("plain"), words), rows.values())))
        keys = [(e, name) for i, e in enumerate(chosen) for j, name in enumerate(rows) if name in CASES or (i + j) % helps_every == 0]
        found = list(pool.map(lambda key: answer(folder, key[0], rows[key[1]]), keys))
    verdicts = {e.name: {} for e in chosen}
    for (environment, name), result in zip(keys, found):
        verdicts[environment.name][name] = difference(environment, plain[name], result, name)
    left = sorted(path for path in folder.rglob("*") if path.name != "linked")
    if left != before:
        raise AssertionError(f"files appeared: {sorted(set(map(str, left)) - set(map(str, before)))}")
    return verdicts


def is_right(verdict):
    return verdict in ("as plain", "refused in one sentence")
