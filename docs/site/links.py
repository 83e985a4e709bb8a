"""Checks every link, picture and anchor of a built site, and that no page loads anything from a network."""
import html.parser
import pathlib
import urllib.parse

LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("object", "data")}


class Page(html.parser.HTMLParser):
    """ids: anchors of the page; links: (target, whether the browser loads it with the page); without_text: pictures without a description."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.without_text = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        for name in ("id", "name"):
            if values.get(name):
                self.ids.add(values[name])
        if tag == "a" and values.get("href"):
            self.links.append((values["href"], False))
        for name in ("src", "href", "data"):
            if (tag, name) in LOADED and values.get(name) and values.get("rel") not in ("canonical", "edit"):
                self.links.append((values[name], True))
        if tag == "img" and not values.get("alt"):
            self.without_text.append(values.get("src", ""))


def faults(site):
    """Sentences about the links of the site that lead nowhere."""
    site = pathlib.Path(site).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    for path, page in pages.items():
        where = path.relative_to(site)
        for picture in page.without_text:
            yield f"{where}: the picture {picture} has no description; add one"
        for target, loaded in page.links:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme in ("http", "https") or parts.netloc:
                if loaded:
                    yield f"{where}: {target} is loaded from a network; the site must be readable without one"
                continue
            if parts.scheme in ("mailto", "data", "javascript"):
                continue
            name = urllib.parse.unquote(parts.path)
            aim = path if not name else (site / name.lstrip("/") if name.startswith("/") else (path.parent / name)).resolve()
            if aim.is_dir():
                aim = aim / "index.html"
            if where.name == "404.html" and name.startswith("/"):
                continue  # a server's page, whose links begin at the top of that server
            if not aim.is_relative_to(site) or not aim.is_file():
                yield f"{where}: the link to {target} leads nowhere"
            elif parts.fragment and aim in pages and urllib.parse.unquote(parts.fragment) not in pages[aim].ids:
                yield f"{where}: the link to {target} leads to no heading of that page"
