"""Simulated players of games: their names, and the checks of the players of a population (scripts/simulated_player)."""
import concurrent.futures
import csv
import dataclasses
import os
import subprocess

from tactus import tables
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal

NAMES = ("stage_model", "observer")  # the first is the default; also observer:NUMBER
LARGEST_NUMBER = 2**32 - 1
LARGEST_PRACTICE = 100_000  # as --practice of simulated_player
MOST = 2048                 # players of one study; design: a population of which a tenth passes the checks
CHECKS = ("require", "leave_out", "count")
CHECK_TIMEOUT_S = 600       # of one player; design: sixty times the 10 s that its checks take
MAX_DRAWN = 1_000_000     # as --count of observer_players
PROPERTIES_TIMEOUT_S = 60
NAMED = 20                  # players of one line, design
REPORTED = 20               # players between two lines of progress, design
PROGRAM = BIN / "observer_players"


@dataclasses.dataclass(frozen=True)
class Player:
    """name: stage_model, observer or observer:NUMBER. population: seed of the population. practice: actions whose effects an observer perceived before the
    game. failed: numbers of the checks that it fails; None: not checked, or it has none."""
    name: str = NAMES[0]
    population: int = 1
    practice: int = 0
    failed: tuple = None

    @property
    def number(self):
        """Number in the population; None: another player, or the typical person."""
        return int(self.name.partition(":")[2]) if ":" in self.name else None

    @property
    def participant(self):
        """Its name in trial tables. Players of fixed rules have always been `player`."""
        return "player" if self.name == NAMES[0] else self.name.replace(":", "") + (f"_population{self.population}" if self.population != 1 else "")

    def words(self):
        if self.name == NAMES[0]:
            return self.name
        of = f" of population {self.population}" if self.number is not None else ""
        return f"{self.name}{of}" + (f", {self.practice} actions of practice" if self.practice else "")

    def request(self):
        """Members of a request of bin/play_games; its checks are those of `checked`."""
        return {} if self.name == NAMES[0] else {"player": self.name, "population": self.population, "practice": self.practice, "checks": "skip"}

    def verdict(self):
        """The column failed_checks of a trial table."""
        return "" if self.failed is None else " ".join(map(str, self.failed)) or "none"


def is_number(text):
    """True for the number of a player."""
    return tables.whole_number(text, 0, LARGEST_NUMBER) is not None


def is_player(word):
    """True for stage_model, observer and observer:NUMBER (scripts/simulated_player/player_choice.h)."""
    name, colon, number = word.partition(":")
    return word in NAMES or name == "observer" and bool(colon) and is_number(number)


def numbers_of(text):
    """Numbers of a list such as "0-7 12". Raises ValueError with a sentence."""
    found = []
    for part in text.split():
        first, dash, last = part.partition("-")
        if not all(map(is_number, (first, last) if dash else (first,))):
            raise ValueError(f"{part} is no number of a player; write numbers and ranges, for example 0-7 12")
        many = range(int(first), int(last if dash else first) + 1)
        if not many or len(many) > MOST:
            raise ValueError(f"{part} is empty or has more than {MOST} players; write the smaller number first")
        found += many
    if not found or len(found) > MOST or len(set(found)) < len(found):
        raise ValueError(f"the list of players is empty, has more than {MOST}, or repeats one; give each number once")
    return found


def several(name, numbers, population, practice):
    """The players of one choice. numbers: text of numbers_of, or None. Raises ValueError with a sentence."""
    if name not in NAMES:
        raise ValueError(f"there is no player {name}; write {' or '.join(NAMES)}")
    if name == NAMES[0] and (numbers is not None or practice or population != 1):
        raise ValueError(f"the player {name} has fixed rules, without numbers, population and practice; remove them, or write observer")
    if numbers is None:
        return [Player(name, population, practice)]
    return [Player(f"{name}:{n}", population, practice) for n in numbers_of(numbers)]


def failing(player, first_only=False):
    """Numbers of the checks that a player of a population fails, as a tuple; first_only: at most one, in a third of the time. Raises Refusal when they cannot be
    run."""
    words = [str(PROGRAM), "admit" if first_only else "table", "--first", str(player.number), "--count", "1", "--seed", str(player.population)]
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=CHECK_TIMEOUT_S, check=False)
    except OSError as error:
        raise Refusal(f"{PROGRAM}: cannot be run ({error.strerror}); {remedy()}") from None
    except subprocess.TimeoutExpired:
        raise Refusal(f"{PROGRAM}: the checks of {player.words()} did not end in {CHECK_TIMEOUT_S} s; stop other programs, and repeat the command") from None
    lines = [line.split(",") for line in done.stdout.splitlines()]
    if done.returncode != 0 or len(lines) < 2 or len(lines[1]) != len(lines[0]):
        raise Refusal(f"{PROGRAM}: does not check {player.words()}: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
    if first_only:
        return tuple(int(number) for number in lines[1][-1:] if number)
    return tuple(number for number, verdict in enumerate(lines[1][1:-1], start=1) if verdict == "FAIL")


def checked(players, rule, report=lambda line: None, known=None):
    """The players with the numbers of the checks that they fail. rule: require: one that fails is a Refusal; leave_out: it does not play; count: it plays, and
    its games name the checks. The typical person is not checked: its checks are tests of the library. known: {(population, number): failed checks} of players
    that were checked before. Raises Refusal."""
    known = known or {}
    asked = [player for player in players if player.number is not None and (player.population, player.number) not in known]
    first_only = rule != "count"
    if asked:
        report(f"checks {described(asked)}; up to 10 s of a processor for each")
    found, left_out, done = [], [], 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        try:
            failures = pool.map(lambda player: failing(player, first_only), asked)  # in order
            for player in players:
                if player.number is not None:
                    failed = known.get((player.population, player.number))
                    if failed is None:
                        failed, done = next(failures), done + 1
                        if done % REPORTED == 0:
                            report(f"{done} of {len(asked)} players are checked")
                    player = dataclasses.replace(player, failed=failed)
                    if failed and rule == "count":
                        report(f"{player.words()} fails the checks {player.verdict()}; its results are not those of a player that is like people")
                    if failed and rule == "require":
                        raise Refusal(f"{player.words()} fails check {player.verdict()} and is not asked; choose another number "
                                      "(bin/observer_players table), or write leave_out or count as the rule for failed checks")
                (left_out if player.failed and rule == "leave_out" else found).append(player)
        except BaseException:  # also Ctrl-C: players whose checks have not begun are not checked
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    if left_out:
        report(f"{len(left_out)} of {len(players)} players fail a check and are not asked: " + named(left_out))
    if not found:
        raise Refusal("no player passes the checks, so no player is left; choose other numbers, or write count as the rule for failed checks")
    return found


def named(players):
    """The first players with their failed checks."""
    return "; ".join(f"{p.name}: {p.verdict()}" for p in players[:NAMED]) + (f"; and {len(players) - NAMED} more" if len(players) > NAMED else "")


def described(players):
    """One line that names the players."""
    if len(players) <= 4:
        return "; ".join(player.words() for player in players)
    return f"{len(players)} players, {players[0].words()} to {players[-1].words()}"


def properties(population, numbers):
    """{name [unit]: list of the values} of these players of a population. Raises Refusal."""
    if max(numbers) >= MAX_DRAWN:
        raise Refusal(f"player {max(numbers)}: its properties cannot be printed; give games of players below {MAX_DRAWN}")
    words = [str(PROGRAM), "players", "--count", str(max(numbers) + 1), "--seed", str(population)]
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=PROPERTIES_TIMEOUT_S, check=True)
    except (OSError, subprocess.SubprocessError):
        raise Refusal(f"{PROGRAM}: does not print the players; run scripts/build") from None
    try:
        rows = list(csv.DictReader(done.stdout.splitlines(), strict=True))
        return {name: [float(rows[number][name]) for number in numbers] for name in rows[0] if name != "player"}
    except (csv.Error, IndexError, TypeError, ValueError):
        raise Refusal(f"{PROGRAM}: prints no table of players; run scripts/build") from None
