"""Runs a scene, or replays a log, with each node in its own process."""
