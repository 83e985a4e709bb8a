"""Checks whether a machine is fit to run a cluster."""
