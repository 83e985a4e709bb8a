"""Tests of the builder of the site: the Markdown of GitHub becomes that of mkdocs, and each fault of a link is found."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "site"))
import links
import page_text
import pages
from page_text import PageError


class Text(unittest.TestCase):
    def test_links_are_replaced_outside_of_code_only(self):
        text = "[a](x.md) `[b](x.md)` ![p](p.png)\n```\n[c](x.md)\n```\n    [d](x.md)\n[`e`](x.md#f)\n"
        self.assertEqual("[a](<x.md>) `[b](x.md)` ![p](<p.png>)\n```\n[c](x.md)\n```\n    [d](x.md)\n[`e`](<x.md#f>)\n", page_text.with_links(text, lambda t: f"<{t}>"))

    def test_a_link_without_a_page_keeps_its_label(self):
        self.assertEqual("see `a` now", page_text.with_links("see [`a`](folder) now", lambda t: None))

    def test_a_list_after_a_line_of_text_begins_a_list(self):
        self.assertEqual("text\n\n- a\n- b\n  c\n- d", page_text.with_lists("text\n- a\n- b\n  c\n- d"))
        self.assertEqual("```\ntext\n- a\n```", page_text.with_lists("```\ntext\n- a\n```"))
        self.assertEqual("text\n\n1. a\n2. b", page_text.with_lists("text\n1. a\n2. b"))


class Staged(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.root, self.to = pathlib.Path(kept.name, "root"), pathlib.Path(kept.name, "to")
        self.write("docs/README.md", "# Home\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def staged(self, generated=None):
        pages.Staging(self.root, self.to, generated or {}).fill()
        return {p.relative_to(self.to).as_posix(): p.read_text(encoding="utf-8") for p in self.to.rglob("*") if p.is_file()}

    def test_pages_of_docs_are_at_the_top_and_others_below_code(self):
        self.write("sync/README.md", "[home](../docs/README.md) [source](x.h) [r](../docs/reference/a.md#b)")
        self.write("sync/x.h", "int x;")
        self.write("docs/a.md", "[sync](../sync) [s](../sync/README.md)")
        found = self.staged({"a.md": "# A\n[home](../README.md)"})
        self.assertEqual("[home](../../README.md) [source](x.h.txt) [r](../../reference/a.md#b)", found["code/sync/README.md"])
        self.assertEqual("int x;", found["code/sync/x.h.txt"])
        self.assertEqual("[sync](code/sync/README.md) [s](code/sync/README.md)", found["a.md"])
        self.assertEqual("# A\n[home](../README.md)", found["reference/a.md"])

    def test_a_link_that_leads_nowhere_or_out_of_the_repository_is_refused(self):
        for target in ("none.md", "../../x.md", "../none/README.md"):
            self.write("docs/a.md", f"[x]({target})")
            with self.subTest(target), self.assertRaises(PageError) as caught:
                self.staged()
            self.assertIn(f"docs/a.md: the link to {target} leads nowhere", str(caught.exception))

    def test_generated_and_built_folders_are_no_pages(self):
        for name in ("build/x.md", "scripts/live/page/node_modules/y/README.md", ".git/z.md"):
            self.write(name, "# x\n")
        self.assertEqual(["README.md"], sorted(self.staged()))

    def test_every_page_of_docs_is_in_the_navigation(self):
        staging = pages.Staging(ROOT, self.to, {n: "" for n in ("messages.md", "channels.md", "operators.md", "study_elements.md", "command_line.md")})
        staging.nav()
        staging.pages[pathlib.PurePosixPath("docs/new.md")] = ""
        with self.assertRaises(PageError) as caught:
            staging.nav()
        self.assertIn("docs/new.md is in no section", str(caught.exception))


class Links(unittest.TestCase):
    def faults(self, text):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "a.html").write_text(text, encoding="utf-8")
            pathlib.Path(folder, "b.html").write_text('<h1 id="there">b</h1>', encoding="utf-8")
            return list(links.faults(folder))

    def test_good_links_have_no_fault(self):
        self.assertEqual([], self.faults('<a href="b.html#there">x</a><a href="https://example.org">y</a><a href="#z" id="z">z</a>'))

    def test_each_fault_is_found(self):
        for text, said in (('<a href="c.html">x</a>', "the link to c.html leads nowhere"), ('<a href="b.html#gone">x</a>', "leads to no heading"),
                           ('<img src="p.png" alt="p">', "the link to p.png leads nowhere"), ('<img src="a.html">', "has no description"),
                           ('<script src="https://cdn.example.org/x.js"></script>', "loaded from a network"), ('<link rel="stylesheet" href="//fonts.example.org/x">', "loaded from a network"),
                           ('<a href="../out.html">x</a>', "leads nowhere")):
            with self.subTest(text):
                self.assertIn(said, " ".join(self.faults(text)))


if __name__ == "__main__":
    unittest.main()
