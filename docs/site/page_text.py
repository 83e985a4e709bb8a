"""The differences between the Markdown of GitHub, in which the pages are written, and that of mkdocs."""
import re

FENCE = re.compile(r"^\s*(```+|~~~+)")
LINK = re.compile(r"(!?\[(?:[^\]\[]|\[[^\]]*\])*\])\(([^)\s]+)\)")
ITEM = re.compile(r"^(\s*)(?:[-*]|\d+\.) ")


class PageError(Exception):
    """A page that cannot be part of the site; the text is one sentence with its remedy."""


def with_links(text, target_of):
    """The page with each link target replaced by target_of(target); None removes the link and keeps its label."""
    lines, fence = [], ""
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if mark:
            if not fence:
                fence = mark.group(1)
            elif mark.group(1).startswith(fence):
                fence = ""
        elif not fence and not line.startswith("    "):
            line = LINK.sub(lambda m: m.group(0) if in_code(m) else linked(m.group(1), target_of(m.group(2))), line)
        lines.append(line)
    return "\n".join(lines)


def linked(label, target):
    """A link, or its label alone when there is no target."""
    return f"{label}({target})" if target else label.strip("![]")


def in_code(match):
    """Whether a match is inside of a code span: an odd number of backquotes precedes it."""
    return match.string[:match.start()].count("`") % 2 == 1


def with_lists(text):
    """The page with a blank line before each list: GitHub begins a list after a line of text, mkdocs does not."""
    lines, fence, before = [], False, ""
    for line in text.split("\n"):
        if FENCE.match(line):
            fence = not fence
        if not fence and ITEM.match(line) and not line.startswith("    ") and before.strip() and not ITEM.match(before) and not before.startswith("  "):
            lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines)

