"""Tests of scripts/build with a cmake and a ninja that only record: moved and copied checkouts, memory limits, Ctrl-C."""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
CMAKE = """#!/bin/sh
echo "cmake $PWD" >>"$RECORD"
mkdir -p build/dev
tests=ON
case "$*" in *TACTUS_TESTS=OFF*) tests=OFF ;; esac
printf 'TACTUS_TESTS:BOOL=%s\\n' $tests >build/dev/CMakeCache.txt
printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\\nCMAKE_CACHEFILE_DIR:INTERNAL=%s/build/dev\\n' "$PWD" "$PWD" >>build/dev/CMakeCache.txt
touch build/dev/build.ninja
"""
# Prints the lines of $FILES ("DONE ALL SECONDS TEXT") as ninja does, and fails after a line with FAILED.
NINJA = """#!/bin/sh
echo "ninja $*" >>"$RECORD"
[ -n "$FILES" ] || { echo 'ninja: no work to do.'; exit 0; }
echo "ninja: Entering directory \\`build'"
printf '%s\n' "$FILES" | while read -r made all seconds text; do
  case $text in
    FAILED*) echo "$text"; exit 1 ;;
    *) printf '%s\n' "$(printf '%s' "$NINJA_STATUS" | sed "s/%f/$made/; s/%t/$all/; s/%e/$seconds/")$text" ;;
  esac
done
"""
MEMORY = "MemTotal: 64000000 kB\nMemAvailable: {kB} kB\n"


class Tree(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.top = pathlib.Path(os.path.realpath(kept.name))
        self.record = self.top / "record"
        self.write("bin/cmake", CMAKE)
        self.write("bin/ninja", NINJA)
        self.tree = self.top / "tree"
        (self.tree / "scripts").mkdir(parents=True)
        for name in ("build", "build_jobs.sh", "build_progress.sh", "prologue.sh", "removed_variables.txt"):
            shutil.copy(SCRIPTS / name, self.tree / "scripts")

    def write(self, name, text):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def environment(self):
        return {**os.environ, "PATH": f"{self.top / 'bin'}:{os.environ['PATH']}", "RECORD": str(self.record)}

    def build(self, tree, *words):
        """(commands that were called, output)."""
        self.record.write_text("", encoding="utf-8")
        done = subprocess.run([tree / "scripts" / "build", *words], env=self.environment(), check=True, capture_output=True, text=True)
        return [line.split()[0] for line in self.record.read_text(encoding="utf-8").splitlines()], done.stdout + done.stderr


class Moved(Tree):
    def test_a_checkout_that_stays_is_configured_once(self):
        self.assertEqual(["cmake", "ninja"], self.build(self.tree)[0])
        self.assertEqual(["ninja"], self.build(self.tree)[0])
        (self.top / "link").symlink_to(self.tree)
        self.assertEqual(["ninja"], self.build(self.top / "link")[0])

    def test_a_moved_and_a_copied_checkout_are_configured_again_with_a_sentence(self):
        self.build(self.tree)
        (self.tree / "build" / "dev" / "old.o").touch()
        for name, transfer in (("copy", shutil.copytree), ("a b'$(x)", os.rename)):
            other = self.top / name
            transfer(self.tree, other)
            called, said = self.build(other)
            self.assertEqual(["cmake", "ninja"], called)
            self.assertIn(f"was made for {self.tree}: this checkout was moved or copied, so everything is built again", said)
            self.assertFalse((other / "build" / "dev" / "old.o").exists())
            self.assertEqual(["ninja"], self.build(other)[0])

    def test_a_build_without_its_cache_is_configured_again(self):
        self.build(self.tree)
        (self.tree / "build" / "dev" / "CMakeCache.txt").unlink()
        self.assertEqual(["cmake", "ninja"], self.build(self.tree)[0])


class Tests(Tree):
    def has_tests(self):
        return "TACTUS_TESTS:BOOL=ON" in (self.tree / "build" / "dev" / "CMakeCache.txt").read_text(encoding="utf-8")

    def test_a_run_builds_without_tests_and_a_later_test_adds_them_for_good(self):
        for words, called, tests in ((("--programs",), ["cmake", "ninja"], False), (("--programs",), ["ninja"], False), (("sim_node",), ["ninja"], False),
                                     (("sync_test",), ["cmake", "ninja"], True), (("--programs",), ["ninja"], True), ((), ["ninja"], True)):
            self.assertEqual(called, self.build(self.tree, *words)[0], words)
            self.assertEqual(tests, self.has_tests(), words)


class Progress(Tree):
    # CMake looks for new files first; 9 generated files take 1 s, 30 compiled ones 10 s each.
    FILES = (["1 2 0.1 Re-checking globbed directories...", "2 2 0.9 Re-running CMake..."] + [f"{n} 40 1.0 Generating {n}.hpp" for n in range(1, 10)]
             + [f"{9 + n} 40 {10 * n}.500 Building CXX object {n}.o" for n in range(1, 31)] + ["40 40 300.9 Linking CXX executable a"])

    def output(self, *files, status=0):
        environment = {**self.environment(), "FILES": "\n".join(files)}
        done = subprocess.run([self.tree / "scripts" / "build"], env=environment, check=False, capture_output=True, text=True)
        self.assertEqual(status, done.returncode, done.stderr)
        return done.stdout.splitlines()[2:], done.stderr

    def test_each_minute_the_files_of_all_and_the_remaining_time_are_printed(self):
        # After file 9 + n, 31 - n are left at 10 s each.
        lines, errors = self.output(*self.FILES)
        self.assertEqual(["build: 15 of 40 files, about 5 min left", "build: 21 of 40 files, about 4 min left", "build: 27 of 40 files, about 3 min left",
                          "build: 33 of 40 files, about 70 s left", "build: 39 of 40 files, about 10 s left"], lines)
        self.assertEqual("", errors)

    def test_a_build_of_less_than_a_minute_prints_no_progress(self):
        self.assertEqual(([], ""), self.output(*self.FILES[:13]))
        self.assertEqual(([], ""), self.output())

    def test_the_output_of_compilers_goes_to_stderr_and_a_failure_is_reported(self):
        lines, errors = self.output(*self.FILES[:13], "14 40 9.0 FAILED: 3.o", status=1)
        self.assertEqual(([], "FAILED: 3.o\nbuild: the build failed; see above\n"), (lines, errors))


class Memory(Tree):
    def free(self, groups, available_kB=60_000_000, **files):
        """free_memory_kB with a /proc and control groups of this test. groups: text of /proc/self/cgroup; files: {path: text}."""
        self.write("proc/meminfo", MEMORY.format(kB=available_kB))
        self.write("proc/self/cgroup", groups)
        shutil.rmtree(self.top / "groups", ignore_errors=True)
        for name, text in files.items():
            self.write("groups/" + name, text)
        script = f'source "{SCRIPTS}/build_jobs.sh"; free_memory_kB "$0/proc" "$0/groups"; build_jobs "$0/proc" "$0/groups"'
        done = subprocess.run(["/bin/bash", "-pc", script, self.top], check=True, capture_output=True, text=True)
        self.assertEqual("", done.stderr)
        free, jobs = map(int, done.stdout.split())
        self.assertEqual(max(1, min(os.cpu_count(), len(os.sched_getaffinity(0)), free // 1_500_000)), jobs)
        return free

    def files(self, folder, limit, usage, cached, names):
        return {f"{folder}/{names[0]}": f"{limit}\n", f"{folder}/{names[1]}": f"{usage}\n", f"{folder}/memory.stat": f"anon 5\n{names[2]} {cached}\n"}

    V2 = ("memory.max", "memory.current", "inactive_file")
    V1 = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")

    def test_without_a_limit_the_free_memory_of_the_machine_counts(self):
        self.assertEqual(60_000_000, self.free("0::/\n"))
        self.assertEqual(60_000_000, self.free("0::/a/b\n", **self.files("a/b", "max", 1, 0, self.V2)))
        self.assertEqual(60_000_000, self.free("4:memory:/a\n", **self.files("memory/a", 9223372036854771712, 1, 0, self.V1)))

    def test_the_limit_of_a_container_and_of_every_group_around_it_counts(self):
        gib = 1 << 30
        self.assertEqual(2 << 20, self.free("0::/\n", **self.files(".", 3 * gib, gib, 0, self.V2)))
        self.assertEqual(2 << 20, self.free("0::/a/b\n", **{**self.files("a", 3 * gib, gib, 0, self.V2), **self.files("a/b", 5 * gib, gib, 0, self.V2)}))
        self.assertEqual(3 << 20, self.free("0::/a\n", **self.files("unified/a", 3 * gib, gib, gib, self.V2)))  # cached files are free
        self.assertEqual(1 << 20, self.free("9:name=systemd:/\n4:cpu,memory:/x/y\n", **self.files("memory", 2 * gib, gib, 0, self.V1)))

    def test_the_machine_can_be_tighter_than_the_limit(self):
        self.assertEqual(1_000_000, self.free("0::/\n", 1_000_000, **self.files(".", 8 << 30, 0, 0, self.V2)))


class Interrupted(Tree):
    def test_ctrl_c_ends_a_build_with_130_and_one_line(self):
        self.write("bin/ninja", '#!/bin/sh\n: >"$RECORD.started"\nexec sleep 100\n')
        process = subprocess.Popen([self.tree / "scripts" / "build"], env=self.environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        while not pathlib.Path(f"{self.record}.started").exists():
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGINT)
        said = process.communicate(timeout=30)[1]
        self.assertEqual((130, "build: interrupted\n"), (process.returncode, said))


if __name__ == "__main__":
    unittest.main()
