"""All pages of the reference, generated from the code."""
import reference_commands
import reference_messages
import reference_tables


def pages(root, programs):
    """{name of a file: its text}. programs: the folder of the built programs. Raises PageError where the code and its description disagree."""
    return {**reference_messages.pages(root), **reference_tables.pages(root), **reference_commands.pages(root, programs)}
