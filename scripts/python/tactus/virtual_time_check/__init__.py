"""Compares the same scene and the same games live and in virtual time."""
