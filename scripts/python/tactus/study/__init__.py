"""Studies: the study file, its plan, sessions with participants and the files that they leave."""
