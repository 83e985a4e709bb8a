"""Runs a scene, or replays a log, with every node in a process of its own."""
