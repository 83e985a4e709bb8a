"""Tactus: runs, clusters, studies and analyses with the programs of this repository."""
