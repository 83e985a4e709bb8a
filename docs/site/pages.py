"""The pages of the site: which files of the repository, where they are in the site, and where their links lead."""
import os
import pathlib
import posixpath
import shutil

import page_text
from page_text import PageError

SKIPPED = {"build", "out", "node_modules", "dist", "__pycache__"}
PICTURES = (".svg", ".png", ".jpg")
# (title, page or None, pages below it). The generated reference is added by nav().
NAV = (
    ("Home", "README.md"),
    ("Install", ("install.md", "supported_systems.md")),
    ("Getting started", "getting_started.md"),
    ("Tutorials", ("tutorials/README.md", "tutorials/first_scene.md", "tutorials/own_world.md", "tutorials/materials.md", "tutorials/degrade_live.md",
                   "tutorials/record_replay.md", "tutorials/two_machines.md", "tutorials/cave.md", "tutorials/device.md", "tutorials/run_study.md",
                   "tutorials/analyse_study.md", "tutorials/sweep.md", "tutorials/modality.md")),
    ("Concepts", ("concepts/time.md", "concepts/contacts.md", "concepts/touch.md", "concepts/touch_stages.md", "concepts/degradation.md", "concepts/playout.md", "concepts/studies.md", "concepts/tasks.md", "concepts/replications.md",
                  "concepts/logs.md", "glossary.md")),
    ("Reference", ("reference/README.md", "reference/command_line.md", "settings.md", "scene_format.md", "commands.md", "reference/operators.md", "reference/study_elements.md",
                   "results.md", "export.md", "study_formats.md", "reference/messages.md", "reference/channels.md")),
    ("Results", ("how_far.md", "how_far/battery.md", "how_far/with_people.md", "how_far/stage_model.md", "contact_laws.md", "contact_laws/peers.md", "growth.md", "visuals.md")),
    ("Laboratory", ("safety.md", "security.md", "between_sites.md")),
    ("Development", ("architecture.md", "event_path.md", "adding_a_modality.md", "debugging.md")),
)


def markdown_files(root):
    """Paths of all Markdown files of the repository, relative to it, without generated ones."""
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("."))
        for name in sorted(files):
            if name.endswith(".md"):
                yield pathlib.PurePosixPath(pathlib.Path(folder, name).relative_to(root).as_posix())


def place_of(path):
    """Place of a repository path in the site: docs/ is its top, all else is below code/."""
    return path.relative_to("docs") if path.parts[0] == "docs" else pathlib.PurePosixPath("code", path)


class Staging:
    """The folder that mkdocs reads. generated: {name: text} of docs/reference."""

    def __init__(self, root, folder, generated):
        self.root, self.folder = pathlib.Path(root), pathlib.Path(folder)
        self.pages = {p: (self.root / p).read_text(encoding="utf-8") for p in markdown_files(self.root)}
        self.pages.update({pathlib.PurePosixPath("docs/reference", name): text for name, text in generated.items()})

    def fill(self):
        """Writes all pages, and copies the files to which they link. Raises PageError for a link that leads nowhere."""
        for page, text in self.pages.items():
            text = page_text.with_links(page_text.with_lists(text), lambda target, page=page: self.target_of(page, target))
            self.write(place_of(page), text)

    def write(self, place, text):
        path = self.folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def target_of(self, page, target):
        """A link target of a page, as it must be in the site; None: the site has no page of it."""
        if "://" in target or target.startswith(("#", "mailto:")):
            return target
        link, hash_mark, anchor = target.partition("#")
        aim = pathlib.PurePosixPath(posixpath.normpath(posixpath.join(page.parent.as_posix(), link)))
        if (self.root / aim).is_dir() and aim / "README.md" in self.pages:
            aim /= "README.md"
        if aim in self.pages:
            place = place_of(aim)
        elif aim.parts[0] != ".." and (self.root / aim).is_dir():
            return None  # a folder without a page of its own
        elif aim.parts[0] != ".." and (self.root / aim).is_file():
            place = self.copied(aim)
        else:
            raise PageError(f"{page}: the link to {target} leads nowhere; correct it")
        return posixpath.relpath(place.as_posix(), place_of(page).parent.as_posix()) + hash_mark + anchor

    def copied(self, aim):
        """Copies a file that is no page. A source file gets the suffix .txt, so that a browser shows it."""
        place = place_of(aim)
        if aim.suffix not in PICTURES + (".xz", ".csv"):
            place = place.with_name(place.name + ".txt")
        to = self.folder / place
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.root / aim, to)
        return place

    def nav(self):
        """The navigation, as data of mkdocs.yml. Raises PageError for a page of docs/ that it lacks, or that is not there."""
        listed = {pathlib.PurePosixPath("docs", p) for _, pages in NAV for p in ([pages] if isinstance(pages, str) else pages)}
        for page in listed - set(self.pages):
            raise PageError(f"docs/site/pages.py lists {page}, which is not there; remove it from NAV")
        for page in self.pages:
            if page.parts[0] == "docs" and page not in listed and page != pathlib.PurePosixPath("docs/site/README.md"):
                raise PageError(f"{page} is in no section of the site; add it to NAV in docs/site/pages.py")
        shown = [{title: pages if isinstance(pages, str) else list(pages)} for title, pages in NAV]
        return [*shown, {"Folders": self.folders()}]

    def folders(self):
        """The pages below code/ and those of the builder, in alphabetical order, with the name of their folder."""
        rest = sorted(p for p in self.pages if p.parts[0] != "docs" or p.parts[1:2] == ("site",))
        return [{("Overview" if p.as_posix() == "README.md" else p.parent.as_posix() if p.name == "README.md" else p.as_posix()): place_of(p).as_posix()} for p in rest]
