"""What is wrong with what a person gave, as one sentence."""


class Refusal(Exception):
    pass
