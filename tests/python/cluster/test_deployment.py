"""Tests of the files that a host of a cluster receives."""
import ast
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.cluster import deployment

PACKAGE = ROOT / "scripts" / "python" / "tactus"


def imported(path):
    """Files of the package that a module imports when it is loaded."""
    for statement in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(statement, ast.ImportFrom) and statement.level == 0 and (statement.module or "").split(".")[0] == "tactus":
            folder = PACKAGE.joinpath(*statement.module.split(".")[1:])
            for module in [folder, *(folder / name.name for name in statement.names)]:
                for file in (module.with_suffix(".py"), module / "__init__.py"):
                    if file.is_file():
                        yield file


class Deployment(unittest.TestCase):
    def test_every_module_of_the_doctor_of_a_host_has_what_it_imports(self):
        sent = {PACKAGE / name for name in deployment.DOCTOR} | set((PACKAGE / "doctor").glob("*.py"))
        missing = [f"{path.name} imports {file.relative_to(PACKAGE)}" for path in sent for file in imported(path) if file not in sent]
        self.assertGreater(len(sent), 15)
        self.assertEqual([], missing)


if __name__ == "__main__":
    unittest.main()
