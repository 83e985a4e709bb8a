"""Tactus: runs, clusters, studies and analyses, around the programs of the repository."""
