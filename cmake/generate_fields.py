#!/usr/bin/python3 -I
"""Generates a table of the message types for use at run time; lcmtypes/fields.h describes its use.

  generate_fields.py OUT.cpp channels.h TYPE.lcm ...

A comment belongs to the field below it. The comment after a channel name in channels.h is its message type.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import re

STRUCT = re.compile(r"struct\s+(\w+)\s*\{(.*)\}", re.S)
FIELD = re.compile(r"(\w+)\s+(\w+)\s*(?:\[(\w+)\])?\s*;")
CHANNEL = re.compile(r'\*\s*k\w+\s*=\s*"(\w+)";\s*//\s*(\w+)')
MAX_COMMENT_LENGTH = 400


def fields_of(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    name, body = STRUCT.search(text).groups()
    fields, comment = [], []
    for line in body.splitlines():
        line = line.strip()
        if line.startswith("//"):
            comment.append(line[2:].strip())
        elif line.startswith("const "):
            comment = []
        elif line:
            match = FIELD.fullmatch(line.split("//")[0].strip())
            if not match:
                sys.exit(f"{path}: cannot read {line!r}; write one field a line")
            fields.append((*match.groups(default=""), " ".join(comment)[:MAX_COMMENT_LENGTH]))
            comment = []
    return name, fields


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def main():
    out, channels, *paths = sys.argv[1:]
    types = [fields_of(path) for path in sorted(paths, key=os.path.basename)]
    lines = ['#include "lcmtypes/fields.h"', ""]
    lines += [f"#include <tactus/{name}.hpp>" for name, _ in types]
    lines += ["", "namespace tactus {", "namespace {", ""]
    for name, fields in types:
        rows = ", ".join("{" + ", ".join(quoted(part) for part in field) + "}" for field in fields)
        lines.append(f"constexpr Field k_{name}[] = {{{rows}}};")
    lines += ["", "}  // namespace", "", "std::span<const MessageType> message_types() {",
              "  static const MessageType all[] = {"]
    lines += [f'      {{"{name}", {name}::getHash(), k_{name}}},' for name, _ in types]
    lines += ["  };", "  return all;", "}", "", "std::span<const Channel> channel_types() {", "  static constexpr Channel all[] = {"]
    with open(channels, encoding="utf-8") as file:
        lines += [f'      {{"{channel}", "{name}"}},' for channel, name in CHANNEL.findall(file.read())]
    lines += ["  };", "  return all;", "}", "", "}  // namespace tactus", ""]
    os.makedirs(os.path.dirname(out), exist_ok=True)
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


if __name__ == "__main__":
    main()
