"""Plays the games of a study in virtual time, on this machine or a Slurm cluster."""
