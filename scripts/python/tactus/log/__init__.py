"""Reads the results of a run: tables of the log, sound and video."""
