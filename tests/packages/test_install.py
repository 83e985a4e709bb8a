"""Tests of an installation: it holds no path of the build, runs from another place and any folder as an ordinary user, and four projects build against it.

TACTUS_BUILD: a build folder whose programs are built.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("TACTUS_BUILD") or ROOT / "build" / "dev")
CMAKE = os.environ.get("TACTUS_CMAKE") or "cmake"
SCENE = "newtons_cradle.sdf"
# Project of examples/ and its programs.
PROJECTS = {"modality": ["lamp_node"], "device_driver": ["device_driver"], "collision_detector": ["sim_with_balls"], "behaviour_model": ["sim_with_drag"]}
NOBODY = 65534


def variables():
    kept = {name: value for name, value in os.environ.items() if not name.startswith("TACTUS_")}
    return {**kept, "PATH": "/usr/bin:/bin:/usr/sbin:/sbin"}


def output(*words, status=0, **how):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, **{"env": variables(), **how})
    if done.returncode != status:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return done.stdout + done.stderr


class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.top = pathlib.Path(tempfile.mkdtemp(prefix="tactus-install-"))
        cls.addClassCleanup(shutil.rmtree, cls.top)
        cls.top.chmod(0o755)
        output(CMAKE, "--install", BUILD, "--prefix", cls.top / "first", "--strip")
        cls.prefix = cls.top / "moved"
        (cls.top / "first").rename(cls.prefix)
        cls.tactus = cls.prefix / "bin" / "tactus"
        cls.home = cls.top / "home"
        cls.home.mkdir()
        cls.user = {}
        if os.geteuid() == 0:  # everything below runs as an ordinary user
            os.chown(cls.home, NOBODY, NOBODY)
            cls.user = {"user": NOBODY, "group": NOBODY, "extra_groups": []}

    def run_tactus(self, *words, status=0):
        return output(self.tactus, *words, status=status, cwd=self.home, env={**variables(), "HOME": str(self.home)}, **self.user)

    def test_no_file_holds_a_path_of_the_build_or_of_the_first_place(self):
        names = [str(path).encode() for path in (ROOT, BUILD, self.top / "first")]
        found = []
        for path in (p for p in self.prefix.rglob("*") if p.is_file() and not p.is_symlink()):
            data = path.read_bytes()
            found += [path for name in names if re.search(re.escape(name) + rb"(?![\w-])", data)]
        self.assertEqual([], found)
        for path in (p for p in self.prefix.rglob("*") if p.is_symlink()):
            self.assertFalse(os.path.isabs(os.readlink(path)), path)
            self.assertTrue(path.exists(), path)

    def test_every_file_of_the_package_and_every_scene_is_installed(self):
        scripts = self.prefix / "share" / "tactus" / "scripts"
        wanted = {path.relative_to(ROOT) for path in (ROOT / "scripts" / "python" / "tactus").rglob("*")
                  if path.is_file() and path.name != "README.md" and not {"__pycache__", "virtual_time_check"} & set(path.parts)}
        self.assertEqual(set(), {path for path in wanted if not (scripts.parent / path).is_file()})
        self.assertEqual(sorted(p.name for p in (ROOT / "sim_node" / "scenes").glob("*.sdf")), sorted(p.name for p in (scripts.parent / "sim_node" / "scenes").glob("*.sdf")))

    def test_a_run_of_an_ordinary_user_writes_its_results_and_nothing_into_the_installation(self):
        before = sorted(self.prefix.rglob("*"))
        self.run_tactus("run", SCENE, "--seconds", "2", "--out", "results", "--quiet", "--json", "summary.json")
        summary = json.loads((self.home / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary, json.loads((self.home / "results" / "summary.json").read_text(encoding="utf-8")))
        for name in ("run.lcmlog", "audio.wav", "haptic.csv"):
            self.assertGreater((self.home / "results" / name).stat().st_size, 0, name)
        self.run_tactus("export", "results")
        self.assertTrue((self.home / "results" / "tables" / "schema.json").is_file())
        self.assertEqual(before, sorted(self.prefix.rglob("*")))

    def test_commands_find_their_data(self):
        self.assertRegex(self.run_tactus("--version"), r"^tactus \d+\.\d+\.\d+ \(\w+\)\n$")
        self.assertIn("cave4", self.run_tactus("run", "--room", "none", status=1))
        self.assertIn("there is no setting", self.run_tactus("run", "--set", "audio_node.none=1", status=1))
        self.assertIn("rubber-steel", self.run_tactus("check-sounds"))
        self.assertIn("audio_visual_synchrony", self.run_tactus("study", "--help"))

    def test_commands_of_a_source_tree_are_refused(self):
        for name in ("build", "test", "package"):
            self.assertEqual(f"tactus: '{name}' needs the sources of Tactus, and this is an installation; clone the repository\n", self.run_tactus(name, status=1))
        self.assertNotIn("builds and runs the tests", self.run_tactus("--help"))

    def test_four_projects_build_against_it_and_their_programs_start(self):
        launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={shutil.which('ccache')}"] if shutil.which("ccache") else []
        for project, programs in PROJECTS.items():
            build = self.top / "build" / project
            sources = self.prefix / "share" / "doc" / "tactus-dev" / "examples" / project
            output(CMAKE, "-G", "Ninja", "-S", sources, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=RelWithDebInfo", *launcher)
            output(CMAKE, "--build", build, "--target", *programs)
        self.assertIn("Flashes a lamp for every hit.", output(self.top / "build" / "modality" / "lamp_node", "--help"))
        for project, setting in (("collision_detector", "detector=custom:balls"), ("behaviour_model", "solver=custom:drag")):
            program = self.top / "build" / project / PROJECTS[project][0]
            place = f"sim_node={program}"
            self.run_tactus("run", SCENE, "--program", place, "--set", f"sim_node.{setting}", "--seconds", "1", "--out", project, "--without", "visual_node")
            self.assertGreater((self.home / project / "haptic.csv").stat().st_size, 0)
            refused = self.run_tactus("run", SCENE, "--set", f"sim_node.{setting}", "--seconds", "1", "--out", "none", status=1)
            self.assertIn("is not part of this program; start the program that registers it", refused)


if __name__ == "__main__":
    unittest.main()
