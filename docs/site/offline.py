"""Builds the site with mkdocs: configuration, and a search that works from the disk."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import links
import pages
from page_text import PageError

MKDOCS = "/usr/bin/mkdocs"
# YAML is a superset of JSON, except for the function that makes anchors: those of GitHub.
EXTENSIONS = """
markdown_extensions:
  - tables
  - attr_list
  - toc: {permalink: "#", permalink_title: "Link to this section", slugify: !!python/object/apply:pymdownx.slugs.slugify {kwds: {case: lower}}}
  - pymdownx.superfences
  - pymdownx.highlight: {use_pygments: true}
  - pymdownx.tilde
"""


def configuration(docs, site, theme, nav):
    """Text of mkdocs.yml. No font, icon or script comes from a network."""
    data = {
        "site_name": "Tactus", "docs_dir": str(docs), "site_dir": str(site), "use_directory_urls": False, "strict": True,
        "theme": {"name": "material", "custom_dir": str(theme), "language": "en", "font": False, "icon": {"logo": "material/hand-front-right-outline"}, "favicon": "icon.svg",
                  "features": ["navigation.tabs", "navigation.sections", "navigation.indexes", "navigation.top", "toc.follow", "search.highlight", "search.suggest"],
                  "palette": [{"scheme": "default", "media": "(prefers-color-scheme: light)", "toggle": {"icon": "material/weather-night", "name": "Dark colours"}},
                              {"scheme": "slate", "media": "(prefers-color-scheme: dark)", "toggle": {"icon": "material/weather-sunny", "name": "Light colours"}}]},
        "plugins": [{"search": {"lang": "en"}}], "extra_css": ["tactus/site.css"], "extra_javascript": ["tactus/keyboard.js"], "extra": {"generator": False}, "nav": nav}
    return "\n".join(f"{key}: {json.dumps(value)}" for key, value in data.items()) + EXTENSIONS


def search_as_script(site):
    """Writes the search index as a script: __search for mkdocs-material 8, __index for 9."""
    index = (site / "search" / "search_index.json").read_text(encoding="utf-8")
    (site / "search" / "search_index.js").write_text(f"var __index = {index}; var __search = {{ index: Promise.resolve(__index) }};\n", encoding="utf-8")


def build(root, out, generated):
    """Writes the site to `out`. Raises PageError when mkdocs is missing, when it reports a fault, or when a link leads nowhere."""
    if not os.path.exists(MKDOCS):
        raise PageError("there is no mkdocs; install it: scripts/setup docs")
    if out.exists() and any(out.iterdir()) and not (out / "search" / "search_index.json").exists():
        raise PageError(f"{out} holds other files; name a new or empty folder with --out")
    with tempfile.TemporaryDirectory(prefix="tactus-site-") as folder:
        staged = pages.Staging(root, pathlib.Path(folder, "pages"), generated)
        staged.fill()
        shutil.copyfile(root / "scripts" / "live" / "page" / "icon.svg", pathlib.Path(folder, "pages", "icon.svg"))
        configured = pathlib.Path(folder, "mkdocs.yml")
        site = pathlib.Path(folder, "site")
        configured.write_text(configuration(pathlib.Path(folder, "pages"), site, root / "docs" / "site" / "theme", staged.nav()), encoding="utf-8")
        done = subprocess.run([MKDOCS, "build", "--quiet", "--strict", "--config-file", str(configured)], capture_output=True, text=True, check=False, cwd="/",
                              env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "HOME": folder})
        if done.returncode != 0:
            raise PageError(f"mkdocs: {' '.join((done.stderr or done.stdout).split())[-1500:]}")
        search_as_script(site)
        found = list(links.faults(site))
        if found:
            raise PageError("; ".join(found[:20]) + (f"; and {len(found) - 20} more" if len(found) > 20 else ""))
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(site, out)
