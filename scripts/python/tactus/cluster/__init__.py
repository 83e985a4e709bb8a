"""Runs a scene on several hosts described by a cluster file; also the lab, private paths and systemd units."""
