"""Reference pages of messages and channels, from lcmtypes/."""
import dataclasses
import re

from page_text import PageError

GROUPS = {"world": "World: bodies, contacts, commands", "touch": "Touch and warmth: tools, devices", "presentation": "Presentation: reports and pictures",
          "control": "Control: profiles, playout, settings, questions", "status": "Status: headers, health, clocks", "scene": "Scene: assets and their parts",
          "geometry": "Geometry: vectors and rotations"}
FIELD = re.compile(r"^([\w.]+)\s+(\w+)\s*((?:\[\w+\])*);$")
CONSTANT = re.compile(r"^const\s+(\w+)\s+(.+);$")


@dataclasses.dataclass
class Field:
    """constants: [(name, value, meaning)] that stand below the field."""
    name: str
    kind: str
    meaning: str
    constants: list


@dataclasses.dataclass
class Struct:
    name: str
    group: str
    meaning: str
    fields: list


def read(path):
    """The struct of a .lcm file. Raises PageError for a line of another form, so that no field is left out."""
    comment, struct = [], None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        line = line.strip()
        if line.startswith("//"):
            comment.append(line[2:].strip())
            continue
        meaning, comment = " ".join(comment), []
        if not line or line in ("package tactus;", "}"):
            continue
        begin, field, constant = re.match(r"^struct (\w+) \{$", line), FIELD.match(line), CONSTANT.match(line)
        if begin:
            struct = Struct(begin.group(1), path.parent.name, meaning, [])
        elif constant and struct:
            owner = struct.fields[-1].constants if struct.fields else []
            for name, value in re.findall(r"(\w+)\s*=\s*([^,]+)", constant.group(2)):
                owner.append((name, value.strip(), meaning))
        elif field and struct:
            struct.fields.append(Field(field.group(2), field.group(1).removeprefix("tactus.") + field.group(3), meaning, []))
        else:
            raise PageError(f"{path}:{number}: the reference cannot read '{line}'; extend docs/site/reference_messages.py")
    return struct


def structs(root):
    return [read(path) for path in sorted((root / "lcmtypes" / "types").glob("*/*.lcm"))]


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;")


def kind_of(field, names):
    """The type of a field, with a link to the struct that it is."""
    base = field.kind.partition("[")[0]
    return f"[`{field.kind}`](#{base})" if base in names else f"`{field.kind}`"


def section(struct, names):
    yield f"### {struct.name}\n"
    yield f"{struct.meaning.replace('<', '&lt;')}\n"
    yield "| field | type | meaning |\n|---|---|---|"
    for field in struct.fields:
        meaning = field.meaning or ("Sender, times and number of the message." if field.kind == "header_t" else "")
        yield f"| `{field.name}` | {kind_of(field, names)} | {cell(meaning)} |"
        for name, value, meaning in field.constants:
            yield f"| | `{name}` = {value} | {cell(meaning)} |"
    yield ""


def messages(root):
    found = structs(root)
    names = {s.name for s in found}
    lines = ["# Messages\n", "Every message of the bus, from the files in `lcmtypes/types`. A field of the type of another struct has a link to it. [Conventions](../../lcmtypes/README.md#conventions) "
             "apply to all: SI units are part of a name, `sim_time_ns` is the instant of the world, -1 is an absent index.\n"]
    for group in sorted({s.group for s in found} - set(GROUPS)):
        raise PageError(f"lcmtypes/types/{group} has no title; add it to GROUPS in docs/site/reference_messages.py")
    for group, title in GROUPS.items():
        lines.append(f"## {title}\n")
        for struct in (s for s in found if s.group == group):
            lines += section(struct, names)
    return "\n".join(lines)


def constants(root):
    """[(channel, message, whether it is on the bulk port)] of channels.h."""
    text = (root / "lcmtypes" / "channels.h").read_text(encoding="utf-8")
    bulk = text.index("// Bulk port")
    found = [(m.group(1), m.group(2), m.start() > bulk) for m in re.finditer(r'inline constexpr const char\* k\w+ = "(\w+)";\s*// (\w+_t)', text)]
    if len(found) < len(re.findall(r"inline constexpr const char\* k\w+ = \"[A-Z_]+\"", text)):
        raise PageError("lcmtypes/channels.h has a channel without the name of its message; write it behind the channel")
    return found


def channels(root):
    """The table of lcmtypes/README.md, checked against channels.h."""
    readme = (root / "lcmtypes" / "README.md").read_text(encoding="utf-8")
    rows = {m.group(1): [c.strip() for c in m.group(0).strip("|").split("|")] for m in re.finditer(r"^\| ([A-Z_]+) \|.*\|$", readme, re.M)}
    lines = ["# Channels\n", "R is the real-time port (7667 unless set otherwise), B the bulk port, the next number. `sync_node` and the recorder receive every channel.\n",
             "| channel | message | published by | read by | rate | port | expected presentation |\n|---|---|---|---|---|---|---|"]
    found = constants(root)
    for name, message, _ in found:
        row = rows.pop(name, None)
        if not row or f"`{message}`" != row[1]:
            raise PageError(f"lcmtypes/README.md: the table of channels lacks {name} with {message}, as channels.h has it; add the row")
        lines.append("| " + " | ".join([f"`{name}`", f"[`{message}`](messages.md#{message})", *row[2:]]) + " |")
    for name in rows:
        raise PageError(f"lcmtypes/README.md: the table of channels has {name}, which channels.h lacks; remove the row")
    return "\n".join([*lines, ""])


def pages(root):
    return {"messages.md": messages(root), "channels.md": channels(root)}
