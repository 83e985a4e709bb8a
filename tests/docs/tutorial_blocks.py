"""The blocks of a tutorial, and how each is run; docs/tutorials/README.md explains them to a reader."""
import dataclasses
import pathlib
import re

FENCE = re.compile(r"^```(\w*)(?: title=\"([^\"]*)\")?$")
# Titles of sh blocks that are commands; any other title is the name of a file.
WAYS = ("", "is refused", "first terminal", "second terminal", "needs root", "needs a person", "needs tactus-dev")
SHOWN = ("text", "cpp", "json", "cmake")  # blocks without a title in these languages are shown only; xml without a title is a part of a file


class BlockError(Exception):
    """A block that cannot be run; the text is one sentence with its line."""


@dataclasses.dataclass(frozen=True)
class Block:
    """way: one of WAYS for commands, "file" for the content of the file `title`, "shown" for a block that is only read."""
    way: str
    title: str
    text: str
    line: int


def way_of(language, title, line):
    if language == "sh" and title in WAYS:
        return title or "run"
    if title:
        if not re.fullmatch(r"([\w-]+/)?[\w-]+(\.[\w-]+)*", title):
            raise BlockError(f"line {line}: '{title}' is no way to run a block and no name of a file; use one of {', '.join(WAYS[1:])}, or a file name")
        return "file"
    if language in SHOWN or language == "xml":
        return "shown"
    raise BlockError(f"line {line}: a block in '{language}' without a title is not run; give it the name of a file as its title, or write ```text")


def blocks_of(text):
    """All fenced blocks of a page in their order. Raises BlockError for a block that would not be run."""
    found, inside = [], None
    for number, line in enumerate(text.split("\n"), 1):
        if inside is None and line.lstrip().startswith("```"):
            mark = FENCE.match(line)
            if not mark:
                raise BlockError(f"line {number}: '{line}' begins no block; write ```LANGUAGE or ```LANGUAGE title=\"...\" at the start of the line")
            inside = (mark.group(1), mark.group(2) or "", number, [])
        elif inside is not None and line == "```":
            language, title, begin, lines = inside
            found.append(Block(way_of(language, title, begin), title, "\n".join(lines) + "\n", begin))
            inside = None
        elif inside is not None:
            inside[3].append(line)
    if inside is not None:
        raise BlockError(f"line {inside[2]}: the block has no end")
    return found


def pages(root):
    """The tutorials in the order of their list."""
    folder = pathlib.Path(root, "docs", "tutorials")
    return [folder / name for name in re.findall(r"\]\((\w+\.md)\)", (folder / "README.md").read_text(encoding="utf-8").split("## ")[0])]
