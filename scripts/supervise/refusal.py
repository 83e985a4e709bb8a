"""The one error of this folder."""


class Refusal(Exception):
    """One sentence: what is wrong, with which value, and what to do."""
