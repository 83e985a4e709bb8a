"""The command `tactus`: its table of commands, and those commands that belong to no other package."""
