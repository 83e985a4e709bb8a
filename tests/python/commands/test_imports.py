"""Tests that modules import each other by full names, without cycles of modules or packages."""
import ast
import pathlib
import sys
import unittest

PYTHON = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"
FILES = {".".join(p.relative_to(PYTHON).with_suffix("").parts).removesuffix(".__init__"): p for p in (PYTHON / "tactus").rglob("*.py")}
KNOWN = {*sys.stdlib_module_names, "tactus", "numpy", "scipy", "statsmodels", "matplotlib", "lxml", "PIL", "websockets"}


def imports(name):
    """Full names of all imports of a module, also inside functions."""
    found = set()
    for node in ast.walk(ast.parse(FILES[name].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            found |= {f"{module}.{a.name}" if f"{module}.{a.name}" in FILES else module for a in node.names}
    return found


def circle(graph):
    """Names of a cycle in {name: names}, the first repeated at the end; [] without a cycle."""
    path, done = [], set()

    def visit(name):
        if name in path:
            return [*path[path.index(name):], name]
        if name in done:
            return []
        path.append(name)
        for other in sorted(graph.get(name, ())):
            if found := visit(other):
                return found
        path.pop()
        done.add(name)
        return []

    return next((found for name in sorted(graph) if (found := visit(name))), [])


class Imports(unittest.TestCase):
    def test_only_the_package_the_standard_library_and_packages_of_setup_are_imported(self):
        for name in FILES:
            self.assertEqual(set(), {other for other in imports(name) if other.split(".")[0] not in KNOWN}, name)

    def test_modules_have_no_import_cycle(self):
        self.assertEqual([], circle({name: imports(name) & FILES.keys() - {name} for name in FILES}))

    def test_packages_have_no_import_cycle(self):
        package = lambda name: ".".join(name.split(".")[:2])
        graph = {}
        for name in FILES:
            graph.setdefault(package(name), set()).update(package(other) for other in imports(name) & FILES.keys() if package(other) not in (package(name), "tactus"))
        self.assertEqual([], circle(graph))

    def test_a_cycle_is_found(self):
        self.assertEqual(["b", "c", "b"], circle({"a": {"b"}, "b": {"c"}, "c": {"b"}}))

    def test_a_folder_holds_at_most_forty_files(self):
        for folder in {path.parent for path in FILES.values()}:
            self.assertLessEqual(len([p for p in folder.iterdir() if p.is_file()]), 40, folder)


if __name__ == "__main__":
    unittest.main()
