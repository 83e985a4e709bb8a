"""Tests of the recipe for a container: it installs packages that exist, and starts the command as an ordinary user."""
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def instructions():
    """[(instruction, words)] of the Containerfile."""
    lines = (ROOT / "examples/container/Containerfile").read_text(encoding="utf-8").splitlines()
    return [tuple(line.split(" ", 1)) for line in lines if line and not line.startswith("#")]


class Container(unittest.TestCase):
    def test_the_base_is_the_release_that_is_fully_supported(self):
        self.assertEqual(("FROM", "docker.io/library/debian:12-slim"), instructions()[0])
        self.assertRegex((ROOT / "docs/supported_systems.md").read_text(encoding="utf-8"), r"Debian 12 \(bookworm\), amd64 \| full")

    def test_every_package_that_it_installs_is_one_of_the_packages(self):
        made = set(re.findall(r"^tactus_package\(\w+ ([\w-]+) ", (ROOT / "cmake/Packages.cmake").read_text(encoding="utf-8"), re.M))
        installed = next(words for name, words in instructions() if name == "RUN" and "apt-get install" in words).split("--no-install-recommends ")[1].split()
        self.assertLessEqual(set(installed), made)
        self.assertIn("tactus", installed)

    def test_the_command_is_started_by_an_ordinary_user_whose_folder_it_may_write(self):
        steps = instructions()
        self.assertEqual(["tactus"], json.loads(dict(steps)["ENTRYPOINT"]))
        user, folder = dict(steps)["USER"], dict(steps)["WORKDIR"]
        self.assertTrue(any(name == "RUN" and f"useradd --create-home {user}" in words and f"install -d -o {user} {folder}" in words for name, words in steps))
        self.assertFalse([words for name, words in steps[[name for name, _ in steps].index("USER"):] if name == "RUN"])

    def test_the_repository_is_gone_from_the_image(self):
        removed = " ".join(words for name, words in instructions() if name == "RUN" and words.startswith("rm "))
        for place in ("/srv/tactus", "/etc/apt/sources.list.d/tactus.list", "/var/lib/apt/lists"):
            self.assertIn(place, removed)


if __name__ == "__main__":
    unittest.main()
