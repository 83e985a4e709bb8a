"""Runs the commands of the README: every command of its sh blocks and every ./scripts/... of its text.

Takes the repository's root. A command that would run for long is asked whether its arguments are right; the run itself is a
test of its own (tests/cluster/run_test.cpp). Links to files of the repository must lead somewhere.
"""
import pathlib
import re
import shlex
import subprocess
import sys


def commands(text):
    """Lines of the sh blocks and inline code that begin with ./scripts/, without their comments."""
    for block in re.findall(r"```sh\n(.*?)```", text, re.S):
        yield from (line.split("#")[0].strip() for line in block.splitlines() if line.split("#")[0].strip())
    for code in re.findall(r"`(\./scripts/[^`]+)`", text):
        if code.endswith("--help") or " " in code:
            yield code.strip()


def dry(words):
    """The command that checks the arguments of this one without doing its work; None where there is none."""
    if words[0] == "./scripts/run" and "--help" not in words:
        arguments = [w for w in words[1:] if not w.endswith(".sdf")]  # the reader's own scene is not here
        return ["scripts/tactus", "--module", "tactus.launch.main", "--arguments-only", *arguments]
    if words[0] == "./scripts/tactus":
        return [*words[:2], "--help"]
    return [words[0], "--help"]


def main():
    root = pathlib.Path(sys.argv[1])
    text = (root / "README.md").read_text(encoding="utf-8")
    failures, tried = [], 0
    for line in dict.fromkeys(commands(text)):
        words = shlex.split(line)
        if not (root / words[0]).exists():
            failures.append(f"{line}: there is no {words[0]}")
            continue
        result = subprocess.run(dry(words), cwd=root, capture_output=True, text=True, check=False)
        tried += 1
        if result.returncode != 0:
            failures.append(f"{line}: {result.stderr.strip() or 'exit ' + str(result.returncode)}")
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        if "://" not in target and not (root / target).exists():
            failures.append(f"link to {target}, which is not there")
    if tried < 4:
        failures.append(f"only {tried} commands found in README.md; the reader of the file, or the file, is broken")
    for failure in failures:
        print(f"README.md: {failure}")
    sys.exit(1 if failures else 0)


main()
