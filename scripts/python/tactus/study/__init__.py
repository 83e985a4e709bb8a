"""Studies: the study file, its plan, sessions with participants and their results."""
