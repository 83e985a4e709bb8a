"""Numbers, tables and sentences of a report, as HTML."""
import html


def safe(text):
    return html.escape(str(text), quote=True)


def figure(value, digits=3):
    """A number as text with `digits` significant digits, without exponent if possible."""
    if value is None or value != value:
        return "–"
    whole = isinstance(value, int) or float(value).is_integer() or abs(value) >= 10 ** (digits - 1)
    if whole and abs(value) < 1e15:
        return f"{round(value):,}".replace(",", "\u2009").replace("-", "−")
    text = f"{value:.{digits}g}"
    if "e" in text and abs(value) >= 1e-6:
        text = f"{value:.9f}".rstrip("0")
    return text.replace("-", "−")


def table(caption, head, rows, number):
    """HTML of a table. rows: lists of cells; texts are left-aligned, numbers and the heads of their columns right-aligned."""
    out = [f"<table><caption><b>Table {number}.</b> {caption}</caption>"]
    if any(head):
        texts = [all(isinstance(row[i], str) for row in rows if i < len(row)) for i in range(len(head))]
        out += ["<thead><tr>", *(f"<th>{safe(h)}</th>" if text else f'<th class="n">{safe(h)}</th>' for h, text in zip(head, texts)), "</tr></thead>"]
    out.append("<tbody>")
    for row in rows:
        out.append("<tr>" + "".join(f"<td>{safe(c)}</td>" if isinstance(c, str) else f'<td class="n">{figure(c)}</td>' for c in row) + "</tr>")
    out.append("</tbody></table>\n")
    return "".join(out)


def listed(words):
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1] if words else "none"


STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 Georgia, "DejaVu Serif", serif; color: #1a1a1a; max-width: 50em; margin: 2.5em auto 5em; padding: 0 1.5em; background: #fff; }
h1 { font-size: 1.7em; line-height: 1.2; margin: 0 0 .15em; }
h2 { font-size: 1.2em; margin: 2.2em 0 .5em; border-bottom: 1px solid #ccc; padding-bottom: .15em; }
h3 { font-size: 1em; margin: 1.4em 0 .3em; }
.sub { color: #555; margin: 0 0 1.5em; }
.sum { background: #f5f3ee; border-left: 3px solid #c2562b; padding: .7em 1em; margin: 1.2em 0; }
table { border-collapse: collapse; font: 12.5px/1.4 "DejaVu Sans", Verdana, sans-serif; margin: 1.1em 0; width: 100%; font-variant-numeric: tabular-nums; }
caption, figcaption { caption-side: top; text-align: left; font: 13px/1.45 Georgia, "DejaVu Serif", serif; color: #333; margin-bottom: .4em; }
thead th { border-top: 1.5px solid #333; border-bottom: 1px solid #333; padding: .25em .5em; text-align: left; font-weight: 600; vertical-align: bottom; }
thead th.n { text-align: right; }
thead th:first-child, td:first-child { text-align: left; }
td { padding: .18em .5em; text-align: left; border-bottom: 1px solid #eee; overflow-wrap: anywhere; }
td.n { text-align: right; white-space: nowrap; }
table:not(:has(thead)) tr:first-child td { border-top: 1.5px solid #333; }
td:first-child { white-space: nowrap; }
tbody tr:last-child td { border-bottom: 1.5px solid #333; }
figure { margin: 1.4em 0; } figure img { width: 100%; height: auto; }
pre { background: #f7f7f7; padding: .7em 1em; font-size: 12px; white-space: pre-wrap; overflow-wrap: anywhere; }
ol.refs { font-size: .9em; } .missing { color: #7a4a00; }
@media print { body { max-width: none; margin: 0; } figure, table { break-inside: avoid; } }
"""


def page(title, body):
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{safe(title)}</title><style>{STYLE}</style></head><body>\n{body}</body></html>\n")
