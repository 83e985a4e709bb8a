"""Tables for the terminal."""
import re
import string


class Columns:
    """A table whose columns are the fields of a template, for example Columns("{:12} {:5d}  {:8.2f} ms", "name", "n", "median").

    Headings have the width and the alignment of their column. A cell that is None is printed as "-"."""

    def __init__(self, template, *names):
        self.parts = [(literal, field is not None, spec or "") for literal, field, spec, _ in string.Formatter().parse(template)]
        self.names = names

    def heading(self):
        names = iter(self.names)
        return "".join(" " * len(literal) + (text_cell(next(names), spec) if is_field else "") for literal, is_field, spec in self.parts).rstrip()

    def line(self, *cells):
        cells = iter(cells)
        return "".join(literal + (formatted(next(cells), spec) if is_field else "") for literal, is_field, spec in self.parts).rstrip()

    def print_heading(self):
        print(self.heading(), flush=True)

    def print(self, *cells):
        print(self.line(*cells), flush=True)


def formatted(cell, spec):
    if cell is None or isinstance(cell, str):
        return text_cell("-" if cell is None else cell, spec)
    return format(cell, spec)


def text_cell(text, spec):
    """The text with the alignment and the width of a format, which may be that of a number."""
    align, width = re.match(r"([<>^]?)[+]?(\d*)", spec).groups()
    return format(text, f"{align or ('>' if spec[-1:] in set('dfeg') else '<')}{width}")


def print_markdown(names, rows):
    print("\n".join("| " + " | ".join(cells) + " |" for cells in (names, ["---"] * len(names), *rows)) + "\n")
