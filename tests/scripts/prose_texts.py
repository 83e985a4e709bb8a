"""The prose of a source file: comments, literals, paragraphs and cells, each with the line of each of its parts; and the code alone."""
import bisect
import csv
import os
import re

C_LIKE = (".h", ".cpp", ".c", ".lcm", ".glsl", ".vert", ".frag", ".ts", ".mjs")
CODE = (".h", ".cpp", ".c", ".lcm", ".py", ".ts")
LEAST_WORDS = 3

C_TOKEN = re.compile(r'//(?P<line>[^\n]*)|/\*(?P<block>.*?)\*/|R"(?P<tag>\w*)\((?P<raw>.*?)\)(?P=tag)"|"(?P<string>(?:[^"\\\n]|\\.)*)"'
                     r"|(?<![0-9a-fA-F])'(?P<char>(?:[^'\\\n]|\\.)*)'|`(?P<template>(?:[^`\\]|\\.)*)`", re.S)
PY_TOKEN = re.compile(r'#(?P<line>[^\n]*)|"""(?P<block>.*?)"""|\'\'\'(?P<raw>.*?)\'\'\'|"(?P<string>(?:[^"\\\n]|\\.)*)"'
                      r"|'(?P<char>(?:[^'\\\n]|\\.)*)'", re.S)
SH_TOKEN = re.compile(r'(?:(?<=\s)|\A)#(?P<line>[^\n]*)|<<-?\s*\'?(?P<tag>[A-Z]+)\'?[^\n]*\n(?P<raw>.*?)\n\s*(?P=tag)\b|\'(?P<char>[^\']*)\'|'
                      r'"(?P<string>(?:[^"\\]|\\.)*)"', re.S)
CMAKE_TOKEN = re.compile(r'#(?P<line>[^\n]*)|"(?P<string>(?:[^"\\]|\\.)*)"', re.S)
WORD = re.compile(r"[A-Za-z][a-z']+")


class Text:
    """A piece of prose with the line of each of its parts."""

    def __init__(self):
        self.parts, self.starts, self.lines, self.size = [], [], [], 0

    def add(self, part, line, glue=" "):
        if self.parts:
            self.parts.append(glue)
            self.size += len(glue)
        for k, row in enumerate(part.split("\n")):
            if k:
                self.parts.append("\n")
                self.size += 1
            self.starts.append(self.size)
            self.lines.append(line + k)
            self.parts.append(row)
            self.size += len(row)

    def text(self):
        return "".join(self.parts)

    def line(self, at):
        return self.lines[bisect.bisect_right(self.starts, at) - 1]


def line_counter(source):
    starts = [m.end() for m in re.finditer("\n", source)]
    return lambda at: bisect.bisect_right(starts, at) + 1


def plain(comment):
    return re.sub(r"^[ \t]*(?:[*/!<]+(?:[ \t]+|$))?", "", comment, flags=re.M).replace("`", "'")


def is_prose(text):
    return len(WORD.findall(text)) >= LEAST_WORDS


def unescaped(literal):
    return literal.replace("\\n", "\n").replace('\\"', "'").replace("\\'", "'").replace("\n\n", ". \n")


def texts_of_code(source, token, strings=True):
    """The comments, joined over consecutive lines, and the literals, joined where only white space is between them."""
    line_at = line_counter(source)
    found, comment, literal, last = [], None, None, 0

    for match in token.finditer(source):
        kind, between = match.lastgroup, source[last:match.start()]
        kind = "raw" if kind == "tag" else kind
        line = line_at(match.start())
        if kind == "line":
            if comment is None or between.strip() or between.count("\n") > 1 or between.count("\n") == 0:
                comment = Text()
                found.append(comment)
            comment.add(plain(match.group("line")), line, "\n")
            literal = None
        elif kind == "block":
            text = Text()
            text.add(plain(match.group("block")).strip(), line + len(match.group("block")[:len(match.group("block")) - len(match.group("block").lstrip())].split("\n")) - 1)
            found.append(text)
            comment = literal = None
        elif strings:
            value = match.group(kind)
            if literal is None or re.sub(r"\b[rbuf]+$", "", between).strip():
                literal = Text()
                found.append((literal,))
            if kind == "raw":
                line = line_at(match.start(kind))
            literal.add(unescaped(value), line, "")
            comment = None
        last = match.end()
    for item in found:
        if isinstance(item, tuple):
            if is_prose(item[0].text()):
                yield item[0]
        else:
            yield item


def code_only(source, token):
    """The source with blanks for its comments and literals; lines keep their numbers."""
    return token.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), source)


def texts_of_markdown(source):
    """Paragraphs, items, cells and headings, without fences, inline code and targets of links."""
    def blank(match):
        return re.sub(r"[^\n]", "", match.group())
    source = re.sub(r"^(?: {0,3})(```|~~~).*?^ *\1[^\n]*$", blank, source, flags=re.M | re.S)
    source = re.sub(r"<!--.*?-->", blank, source, flags=re.S)
    source = re.sub(r"`[^`\n]+`", "CODE", source)
    source = re.sub(r"\]\([^)]*\)", "]", source).replace("[", "").replace("]", "").replace("**", "")
    text = None
    for number, line in enumerate(source.split("\n"), start=1):
        start = re.match(r"\s*(?:[-*+]|\d+\.|#+|>)\s+", line)
        if not line.strip() or start or line.lstrip().startswith("|"):
            if text:
                yield text
            text = None
        if line.lstrip().startswith("|"):
            for cell in line.strip().strip("|").split("|"):
                text = Text()
                text.add(cell.strip(), number)
                yield text
            text = None
        elif line.strip():
            text = text or Text()
            text.add(line[start.end():] if start else line.strip(), number, "\n")
    if text:
        yield text


def texts_of_html(source):
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())
    source = re.sub(r"<(script|style)\b.*?</\1>|<!--.*?-->", blank, source, flags=re.S | re.I)
    line_at = line_counter(source)
    for match in re.finditer(r">([^<>]+)<|(?:title|placeholder|aria-label)=\"([^\"]+)\"", source):
        value = match.group(1) or match.group(2)
        if value.strip() and is_prose(value):
            text = Text()
            text.add(value.strip(), line_at(match.end() - len(value.lstrip()) - 1))
            yield text


def texts_of_settings(source):
    """The columns meaning and source; no cell holds a line break."""
    for number, row in enumerate(csv.DictReader(source.splitlines()), start=2):
        for column in ("meaning", "source"):
            text = Text()
            text.add(row.get(column) or "", number)
            yield text


def texts(path, source):
    name = os.path.basename(path)
    if name.endswith(C_LIKE):
        return texts_of_code(source, C_TOKEN, strings=not name.endswith(".lcm"))
    if name.endswith(".md"):
        return texts_of_markdown(source)
    if name.endswith(".html"):
        return texts_of_html(source)
    if name == "settings.csv":
        return texts_of_settings(source)
    if name == "CMakeLists.txt" or name.endswith(".cmake"):
        return texts_of_code(source, CMAKE_TOKEN)
    if name.endswith(".py") or re.match(r"#!.*python", source):
        return texts_of_code(source, PY_TOKEN)
    if name.endswith(".sh") or re.match(r"#!.*\b(?:ba|da)?sh\b", source):
        return texts_of_code(source, SH_TOKEN)
    return ()


def code(path, source):
    name = os.path.basename(path)
    if name.endswith(CODE) or re.match(r"#!.*python", source):
        return code_only(source, PY_TOKEN if name.endswith(".py") or source.startswith("#!") else C_TOKEN)
    return ""
