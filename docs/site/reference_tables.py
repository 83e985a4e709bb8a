"""Reference pages of the operators of a profile, from parse_operator.cpp and modality.csv, and of the elements of a study file, from study.xsd."""
import csv
import re
import xml.etree.ElementTree as tree

from page_text import PageError

XS = "{http://www.w3.org/2001/XMLSchema}"


def stream_operators(root):
    """Attributes of <degrade> in the order of the parser, with their effect in the table of sync/degradation/README.md."""
    text = (root / "sync" / "degradation" / "parse_operator.cpp").read_text(encoding="utf-8")
    names = re.findall(r'\{"(\w+)",\s*\[\]\(Rule& r, Words& w\)', text)
    if not names:
        raise PageError("sync/degradation/parse_operator.cpp: its table of operators has another form; adapt docs/site/reference_tables.py")
    readme = (root / "sync" / "degradation" / "README.md").read_text(encoding="utf-8")
    rows = [[c.strip() for c in line.strip("|").split("|")] for line in readme.splitlines() if line.startswith("| `")]
    for name in names:
        row = next((r for r in rows if re.search(rf"`{name}(?:=|`)", r[0])), None)
        if not row:
            raise PageError(f"sync/degradation/README.md: the table of operators lacks {name}; add a row")
        yield name, row


def output_operators(root):
    """Rows (modality, operator, unit, range, meaning) of all modality.csv."""
    for path in sorted(root.glob("*/modality.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        modality = next(r["name"] for r in rows if r["what"] == "modality")
        for r in rows:
            if r["what"] in ("operator", "pair"):
                meaning = r["meaning"] if r["what"] == "operator" else f"second number of the operator above, written `{r['name']}=`; default {r['default']} {r['unit']}"
                yield modality, r["name"], "" if r["unit"] == "1" else r["unit"], f"{r['min']} to {r['max']}", meaning


def refused(root):
    for path in sorted(root.glob("*/modality.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        modality = next(r["name"] for r in rows if r["what"] == "modality")
        for r in rows:
            if r["what"] == "without":
                yield modality, r["name"], r["meaning"]


def operators(root):
    lines = ["# Operators of a profile\n", "All attributes of `<degrade>`. [Degradation](../concepts/degradation.md) explains where they act, "
             "[operators](../../sync/degradation/operators.md) defines their numbers.\n", "## Operators of a stream\n",
             "| attribute | in the table | effect | acts on |\n|---|---|---|---|"]
    lines += [f"| `{name}` | {row[0]} | {row[1]} | {row[2] if len(row) > 2 else ''} |" for name, row in stream_operators(root)]
    lines += ["\n## Operators of an output\n", "| modality | attribute | unit | range | meaning |\n|---|---|---|---|---|"]
    lines += [f"| {modality} | `{name}` | {unit} | {reach} | {meaning} |" for modality, name, unit, reach, meaning in output_operators(root)]
    lines += ["\n## Refused operators\n", "| modality | operator | reason |\n|---|---|---|"]
    lines += [f"| {modality} | `{name}` of force | {meaning} |" for modality, name, meaning in refused(root)]
    return "\n".join([*lines, ""])


def documented(node):
    """The text of xs:annotation of an element or attribute."""
    note = node.find(f"{XS}annotation/{XS}documentation")
    return " ".join((note.text or "").split()) if note is not None else ""


def values_of(node, types):
    """The allowed values of an attribute or of the text of an element, as words."""
    kind = (node.get("type") or "").removeprefix("xs:")
    inner = node.find(f"{XS}simpleType")
    source = inner if inner is not None else types.get(kind)
    if source is not None:
        words = [e.get("value") for e in source.iter(f"{XS}enumeration")]
        if words:
            return ", ".join(f"`{w}`" for w in words)
    return {"string": "text", "double": "number", "int": "whole number", "unsignedInt": "whole number", "quantity": "number with unit", "quantities": "numbers with units",
            "count": "whole number from 1", "sense": "name of a modality", "two_senses": "two modalities", "name": "letters, digits, `_`, `-`"}.get(kind, kind or "numbers")


def children_of(node, types):
    """The direct child elements of an element, through sequences and choices and its type."""
    kind = types.get((node.get("type") or ""))
    for start in ([node.find(f"{XS}complexType")] if node.find(f"{XS}complexType") is not None else [kind] if kind is not None else []):
        todo = list(start)
        while todo:
            part = todo.pop(0)
            if part.tag == f"{XS}element":
                yield part
            elif part.tag in (f"{XS}sequence", f"{XS}choice"):
                todo = list(part) + todo


def attributes_of(node, types):
    kind = node.find(f"{XS}complexType")
    kind = types.get(node.get("type") or "") if kind is None else kind
    if kind is None:
        return []
    extension = kind.find(f"{XS}simpleContent/{XS}extension")
    return (kind if extension is None else extension).findall(f"{XS}attribute")


def element_sections(node, types, parents, seen, file="scripts/python/tactus/study/study.xsd"):
    path = [*parents, node.get("name")]
    key = (node.get("name"), node.get("type"))
    if key in seen and node.get("type"):
        return
    seen.add(key)
    meaning = documented(node)
    if not meaning:
        raise PageError(f"{file}: the element {'/'.join(path)} has no xs:documentation; add one sentence")
    yield f"## {' / '.join(path)}\n"
    often = node.get("maxOccurs", "1")
    yield f"{meaning}{'' if len(path) == 1 else ' Required.' if node.get('minOccurs') != '0' else ' Optional.'}{'' if often == '1' else f' At most {often}.'}\n"
    rows = [f"| `{a.get('name')}` | {'yes' if a.get('use') == 'required' else ''} | {values_of(a, types)} |" for a in attributes_of(node, types)]
    if rows:
        yield "| attribute | required | values |\n|---|---|---|"
        yield from rows
        yield ""
    for child in children_of(node, types):
        yield from element_sections(child, types, path, seen, file)


# Schemas of study files.
SCHEMAS = ("scripts/python/tactus/study/study.xsd", "scripts/python/tactus/replication/replication.xsd")


def study_elements(root):
    lines = ["# Elements of a study file\n", "Generated from the schemas `study.xsd` and `replication.xsd`, of published experiments. [Studies](../concepts/studies.md) explains the parts, the [README of the package]"
             "(../../scripts/python/tactus/study/README.md) what each element does.\n"]
    for file in SCHEMAS:
        schema = tree.parse(root / file).getroot()
        types = {t.get("name"): t for t in schema if t.tag in (f"{XS}simpleType", f"{XS}complexType")}
        for node in schema.findall(f"{XS}element"):
            lines += element_sections(node, types, [], set(), file)
    return "\n".join(lines)


def pages(root):
    return {"operators.md": operators(root), "study_elements.md": study_elements(root)}
