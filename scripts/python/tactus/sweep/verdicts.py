"""Verdicts of the checks of players from an earlier run of `observer_players admit`: the checks of a population of a thousand take an hour."""
import pathlib

from tactus import own_files, players, tables
from tactus.refusal import Refusal, sentence_of

HEADER = "population,player,admitted,first failing check"
LARGEST_BYTES = 1_000_000  # design: twenty times a table of players.MOST lines
CHECKS = 12


def read(path):
    """{(population, number): failed checks, at most the first} of a table. Raises Refusal with the line."""
    path = pathlib.Path(path)
    try:
        content = own_files.read_regular(path, LARGEST_BYTES)
        if len(content) > LARGEST_BYTES:
            raise Refusal(f"{path}: has more than {LARGEST_BYTES} bytes; give the output of observer_players admit")
        lines = content.decode("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Refusal(f"{path}: cannot be read ({sentence_of(error) if isinstance(error, OSError) else 'it is no text in UTF-8'}); give the output of observer_players admit") from None
    if not lines or lines[0] != HEADER:
        raise Refusal(f"{path}: its first line is not {HEADER}; give the output of observer_players admit")
    found = {}
    for number, line in enumerate(lines[1:], start=2):
        words = line.split(",")
        values = [tables.whole_number(word, 0, players.LARGEST_NUMBER) for word in words[:2]]
        failed = tables.whole_number(words[3], 1, CHECKS) if len(words) == 4 and words[3] else None
        if len(words) != 4 or None in values or words[2] != ("no" if words[3] else "yes") or bool(words[3]) != (failed is not None) or tuple(values) in found:
            raise Refusal(f"{path}:{number}: is no verdict of a player, or its second one; give the output of observer_players admit")
        found[tuple(values)] = (failed,) if failed else ()
    return found


def verified(path, of):
    """read(path), for the players `of`. Checks the first player that passes and the first that fails again: another build may give other verdicts. Raises Refusal."""
    known = read(path)
    mine = [player for player in of if player.number is not None and (player.population, player.number) in known]
    if not mine:
        raise Refusal(f"{path}: has no verdict of these players; give a table of the same population, or remove --verdicts")
    for passes in (True, False):
        for player in [p for p in mine if (not known[p.population, p.number]) == passes][:1]:
            if players.failing(player, True) != known[player.population, player.number]:
                raise Refusal(f"{path}: its verdict of {player.words()} is another one with this build; remove --verdicts")
    return known
