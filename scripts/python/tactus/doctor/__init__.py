"""Checks whether this machine is fit for a cluster."""
