"""Psychometric functions, fits and intervals, and the procedures that choose levels."""
