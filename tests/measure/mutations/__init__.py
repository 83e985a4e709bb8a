"""Random changes of valid worlds, meshes and logs, and the properties that every reader keeps: no crash, no NaN, no silence."""
