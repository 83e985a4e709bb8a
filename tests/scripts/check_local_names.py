"""Finds local names that stand in two source files of one folder: the preset dev compiles such files as one (cmake/Unity.cmake).

Takes the repository's root. A local name is a function, constant, type or macro that a source file declares outside of functions and classes. Overloads with
different parameters, and equal aliases, may stand in several files. The compiler finds every clash within a group; this check also finds those that a
new file, which shifts the groups, would cause. It reads declarations roughly: when it errs, rename one of the names.
"""
import collections
import os
import pathlib
import re
import sys

SKIPPED_FOLDERS = {"build", "out", "node_modules", ".git", "fuzz", "bench"}
COMPILED_ALONE = re.compile(r"(^|_)main\.cpp$|_(sse2|avx2|avx512)\.cpp$")
TOKEN = re.compile(r"[A-Za-z_]\w*|::|->|\d[\w.']*|\S")
WORD = re.compile(r"[A-Za-z_]\w*$")
TEXT = re.compile(r'R"([^()\s\\]{0,16})\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'', re.S)
OPENING, CLOSING = "([{", ")]}"


def tokens(source):
    """Tokens without comments and preprocessor lines; a literal becomes one token."""
    text = TEXT.sub(lambda m: " " if m[0].startswith("/") else '""', source)
    return TOKEN.findall(re.sub(r"^\s*#(?:[^\n\\]|\\\n|\\.)*", "", text, flags=re.M))


def after_block(words, i):
    """Index behind the bracket that closes the one at i."""
    depth = 0
    while i < len(words):
        depth += (words[i] in OPENING) - (words[i] in CLOSING)
        i += 1
        if depth == 0:
            break
    return i


def without_template(words):
    """A declaration without `template <...>` and a requires clause in parentheses."""
    while words and words[0] == "template":
        depth, i = 0, 1
        while i < len(words):
            depth += (words[i] == "<") - (words[i] == ">")
            i += 1
            if depth == 0:
                break
        words = words[i:]
        if words and words[0] == "requires":
            words = words[after_block(words, 1):] if words[1] == "(" else words[next((k for k, w in enumerate(words) if w == ">"), 0) + 1:]
    return words


def parameters_at(words):
    """Index of the bracket of a function's parameters; None: it declares no function."""
    angles = 0
    for i, word in enumerate(words):
        if word == "=" and angles == 0 and words[i - 1] != "operator":
            return None
        if word == "<" and i and WORD.match(words[i - 1]):
            angles += 1
        elif word == ">" and angles:
            angles -= 1
        elif word == "(" and angles == 0 and words[i - 1] not in ("decltype", "alignas", "noexcept"):
            return i
    return None


def parameter_lists(words):
    """The types with which a function can be called: a parameter with a default may be absent."""
    parameters, depth = [[]], 0
    for word in words:
        depth += (word in OPENING or word == "<") - (word in CLOSING or word == ">")
        if word == "," and depth == 0:
            parameters.append([])
        else:
            parameters[-1].append(word)
    types, least = [], None
    for i, parameter in enumerate(parameters):
        if "=" in parameter:
            least = i if least is None else least
            parameter = parameter[:parameter.index("=")]
        types.append(" ".join(parameter[:-1] if len(parameter) > 1 and WORD.match(parameter[-1]) else parameter))
    return [", ".join(types[:count]) for count in range(len(types) if least is None else least, len(types) + 1)]


def declared(words):
    """[(name, kind)] that one declaration, without its body, declares. The kind of a function has its parameters, that of an alias its target."""
    words = without_template(words)
    if not words or words[0] in ("static_assert", "extern", "friend", "catch"):
        return []
    if words[0] == "namespace":
        return [(words[1], "alias " + " ".join(words[3:]))]
    if words[0] == "using":
        if words[1] == "namespace":
            return []
        if "=" in words:
            return [(words[1], "alias " + " ".join(words[words.index("=") + 1:]))]
        return [(name.split("::")[-1], "using " + name) for name in "".join(words[1:]).split(",")]
    bracket = parameters_at(words)
    if words[0] in ("struct", "class", "enum", "union", "concept") and bracket is None:
        name = words[2] if words[1] in ("struct", "class") else words[1]
        return [(name, "type")] if words[-1] == "{" and WORD.match(name) and "::" not in words[:4] else []
    if bracket is not None:
        name, before = words[bracket - 1], words[bracket - 2] if bracket > 1 else ""
        if bracket == 0 or before == "::" or not WORD.match(name) or "operator" in words[:bracket] or re.match(r"[A-Z][A-Z_0-9]+$", name):
            return []
        return [(name, "function " + types) for types in parameter_lists(words[bracket + 1:after_block(words, bracket) - 1])]
    end = next((i for i, w in enumerate(words) if w in ("=", "{", "[")), len(words))
    if end < 2 or not WORD.match(words[end - 1]) or words[end - 2] == "::":
        return []
    names, i = [words[end - 1]], end
    while i < len(words):  # int a = 1, b = 2;
        if words[i] in OPENING:
            i = after_block(words, i)
            continue
        if words[i] == "," and i + 2 < len(words) and WORD.match(words[i + 1]) and words[i + 2] in ("=", "{", ","):
            names.append(words[i + 1])
        i += 1
    return [(name, "variable") for name in names]


def local_names(source):
    """[(namespace, name, kind, whether it is local)] of a source file, and its macros with the namespace "#"."""
    macros = set(re.findall(r"^\s*#\s*define\s+(\w+)", source, re.M)) - set(re.findall(r"^\s*#\s*undef\s+(\w+)", source, re.M))
    found, words, scopes, i = [("#", name, "macro") for name in sorted(macros)], tokens(source), [], 0
    while i < len(words):
        if words[i] == "}":
            del scopes[-1:]
        elif words[i] == "namespace" and "{" in words[i:i + 12] and "=" not in words[i:words.index("{", i)]:
            end = words.index("{", i)
            scopes.append("".join(words[i + 1:end]))
            i = end
        elif words[i] != ";":
            begin = i
            while i < len(words) and words[i] not in (";", "{"):
                i = after_block(words, i) if words[i] in "([" else i + 1
            body = i < len(words) and words[i] == "{"
            declaration = words[begin:i + 1] if body else words[begin:i]
            if body:
                i = after_block(words, i)
                if parameters_at(without_template(declaration)) is None:  # a class or an initial value ends with a semicolon
                    end = i
                    while end < len(words) and words[end] != ";":
                        end = after_block(words, end) if words[end] in OPENING else end + 1
                    declaration += words[begin + len(declaration):end] if declaration[0] not in ("struct", "class", "enum", "union") else []
                    i = end
                else:
                    i -= 1
            found += [("::".join(filter(None, scopes)), *d, "" in scopes or "static" in declaration or "const" in declaration or "constexpr" in declaration)
                      for d in declared(declaration)]
        i += 1
    return [(*f, True) if len(f) == 3 else f for f in found]


def folders_of(root):
    """{folder: its source files that are compiled in groups}."""
    folders = collections.defaultdict(list)
    for folder, inner, names in os.walk(root):
        inner[:] = sorted(set(inner) - SKIPPED_FOLDERS)
        inside = os.path.relpath(folder, root)
        of_tests = inside.split(os.sep)[0] == "tests" and "cluster" not in inside
        for name in sorted(names):
            if name.endswith("_test.cpp" if of_tests else ".cpp") and not COMPILED_ALONE.search(name):
                folders[inside].append(os.path.join(folder, name))
    return folders


def clashes(paths):
    """[(name, files)] of local names that stand in several of these files."""
    where = collections.defaultdict(lambda: collections.defaultdict(set))
    local = set()
    for path in paths:
        for space, name, kind, is_local in local_names(pathlib.Path(path).read_text(encoding="utf-8")):
            where[space, name][kind].add(path)
            if is_local:
                local.add((space, name))
    found = []
    for key in sorted(local & set(where)):
        kinds = where[key]
        files = set().union(*kinds.values())
        aliases = all(kind.startswith(("alias", "using")) for kind in kinds)
        functions = all(kind.startswith("function") for kind in kinds)
        if len(files) > 1 and not (aliases and len(kinds) == 1) and not (functions and all(len(f) == 1 for f in kinds.values())):
            found.append((key[1], sorted(os.path.basename(f) for f in files)))
    return found


def main():
    root = sys.argv[1]
    count = 0
    for folder, paths in sorted(folders_of(root).items()):
        for name, files in clashes(paths):
            count += 1
            print(f"{folder}: {name} is a local name in {' and '.join(files)}; share it in a header, or rename it")
    print(f"local names: {count or 'no'} clashes")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
