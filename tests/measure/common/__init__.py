"""Shared parts of the commands of tests/measure. Importing it makes the package `tactus` of scripts/python importable."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
