"""Fits the hand of a recorded run and runs the scene again with it, under another profile."""
