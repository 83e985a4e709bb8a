"""Tests that no block of a tutorial is left out."""
import pathlib
import re
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from tutorial_blocks import BlockError, blocks_of, pages

ROOT = HERE.parents[1]


class Blocks(unittest.TestCase):
    def test_each_kind_of_block_is_run_in_its_way(self):
        page = '```sh\na\n```\n\n```sh title="first terminal"\nb\n```\n```xml title="x.xml"\n<x/>\n```\n```xml\n<y/>\n```\n```cpp title="n/main.cpp"\nint x;\n```\n'
        self.assertEqual([("run", "", "a\n", 1), ("first terminal", "first terminal", "b\n", 5), ("file", "x.xml", "<x/>\n", 8), ("shown", "", "<y/>\n", 11),
                          ("file", "n/main.cpp", "int x;\n", 14)], [(b.way, b.title, b.text, b.line) for b in blocks_of(page)])

    def test_a_block_that_would_not_be_run_is_refused_with_its_line(self):
        for page, said in (("\n```python\nx\n```\n", "line 2: a block in 'python' without a title"), ("```sh title=\"a b c\"\nx\n```\n", "line 1: 'a b c' is no way"),
                           ("```xml title=\"../x\"\nx\n```\n", "line 1: '../x'"), ("```sh\nx\n", "line 1: the block has no end"), ("- x\n\n  ```sh\n  x\n  ```\n", "line 3: "),
                           ("```\nx\n```\n", "line 1: a block in ''"), ("```xml title=\"a/b/c\"\nx\n```\n", "line 1: 'a/b/c'")):
            with self.subTest(page), self.assertRaises(BlockError) as caught:
                blocks_of(page)
            self.assertIn(said, str(caught.exception))


class Tutorials(unittest.TestCase):
    def test_there_are_twelve_in_the_list_in_the_folder_and_in_the_tests(self):
        listed = [page.stem for page in pages(ROOT)]
        self.assertEqual(12, len(listed))
        self.assertEqual(sorted(listed), sorted(p.stem for p in (ROOT / "docs" / "tutorials").glob("*.md") if p.name != "README.md"))
        tested = re.search(r"foreach\(page ([\w ]+)\)", (HERE / "CMakeLists.txt").read_text(encoding="utf-8")).group(1).split()
        self.assertEqual(sorted(listed), sorted(tested))

    def test_every_block_of_every_tutorial_has_a_way(self):
        for page in pages(ROOT):
            with self.subTest(page.name):
                blocks = blocks_of(page.read_text(encoding="utf-8"))
                self.assertTrue(any(b.way not in ("file", "shown") for b in blocks))
                for before, block in zip(blocks, blocks[1:]):
                    if block.way == "second terminal":
                        self.assertIn(before.way, ("first terminal", "second terminal", "file"), f"line {block.line} has no run in the first terminal")

    def test_no_tutorial_leaves_the_machine(self):
        """Runs use private networks: no block names another network, an address outside of this machine, or a download."""
        for page in pages(ROOT):
            for block in blocks_of(page.read_text(encoding="utf-8")):
                if block.way not in ("shown", "file"):
                    with self.subTest(f"{page.name}:{block.line}"):
                        self.assertNotRegex(block.text, r"--network host|https?://|\bcurl\b|\bwget\b|\bpip\b|\bapt\b|--ttl")


if __name__ == "__main__":
    unittest.main()
