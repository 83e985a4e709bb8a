"""The command `tactus`: the table of its commands, and the commands that belong to no other package."""
