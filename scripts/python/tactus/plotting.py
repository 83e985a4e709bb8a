"""Imports matplotlib without the file matplotlibrc of the current folder, which it would read first: its values are partly evaluated as code,
and would change the figures."""
import os


def imported():
    """The package matplotlib. Raises ImportError."""
    here = os.open(".", os.O_RDONLY | os.O_DIRECTORY)
    os.chdir("/")
    try:
        import matplotlib as package
        return package
    finally:
        os.fchdir(here)
        os.close(here)


matplotlib = imported()
