"""Tests of how a command ends: its exit status, and one line on stderr."""
import contextlib
import io
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus import ending
from tactus.refusal import Refusal


def ended(result):
    """(status, stderr) of a command that returns or raises `result`."""
    def run():
        if isinstance(result, BaseException):
            raise result
        return result
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        status = ending.status("play", run)
    return status, said.getvalue()


class Ending(unittest.TestCase):
    def test_a_status_is_passed_on(self):
        self.assertEqual((0, ""), ended(0))
        self.assertEqual((3, ""), ended(3))

    def test_an_error_is_one_sentence(self):
        self.assertEqual((1, "play: a.xml is empty\n"), ended(Refusal("a.xml is empty")))
        self.assertEqual((1, "play: a.xml: Permission denied\n"), ended(PermissionError(13, "Permission denied", "a.xml")))

    def test_a_name_in_an_error_reaches_the_terminal_in_one_line_without_control_characters(self):
        status, said = ended(Refusal("\x1b[31m\nb"))
        self.assertEqual((1, 1), (status, said.count("\n")))
        self.assertNotIn("\x1b", said)

    def test_an_interruption_is_named(self):
        self.assertEqual((130, "play: interrupted\n"), ended(KeyboardInterrupt()))

    def test_a_fault_of_the_program_is_not_hidden(self):
        self.assertRaises(ZeroDivisionError, ended, ZeroDivisionError())


if __name__ == "__main__":
    unittest.main()
