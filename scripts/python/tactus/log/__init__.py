"""Reads what a run left: the tables of its log, its sound and its video."""
