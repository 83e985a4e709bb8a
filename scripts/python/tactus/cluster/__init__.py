"""Runs a scene on several hosts, as a cluster file says; the lab, private paths and units for systemd."""
