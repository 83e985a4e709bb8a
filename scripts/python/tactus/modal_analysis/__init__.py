"""Finds the modes of a struck object in a recording."""
