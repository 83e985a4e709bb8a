"""The remaining time of a sweep, from the games that remain and the measured times of the games of their conditions."""
import dataclasses
import heapq
import statistics

from tactus.sweep import chunk_file


@dataclasses.dataclass(frozen=True)
class Chunk:
    """State of a chunk: its condition, how many of its games remain, and the measured times of the others, s."""
    condition: str
    left: int
    times: list


def chunks_of(folder):
    """The state of all chunks of a sweep, also while they are played."""
    return [Chunk(chunk[0].condition.id, len(chunk) - chunk_file.count(folder.file(number)), chunk_file.times(folder.file(number)))
            for number, chunk in enumerate(folder.chunks)]


@dataclasses.dataclass(frozen=True)
class Remaining:
    """Remaining time, s, and the number of conditions that remain without a measured game: their games count like the mean of all others."""
    seconds: float
    unmeasured: int


def remaining(chunks, workers):
    """The Remaining of chunks that `workers` play in parallel, in order; None: no game has been measured.

    A chunk is played by one worker, so the last chunks can take longer than an equal share."""
    measured = {}
    for chunk in chunks:
        measured.setdefault(chunk.condition, []).extend(chunk.times)
    known = {condition: statistics.fmean(times) for condition, times in measured.items() if times}
    if not known:
        return None
    typical = statistics.fmean(known.values())  # a mean of the conditions: those with more games so far count no more
    ends = [0.0] * max(1, workers)
    # A chunk in progress has a worker already.
    for chunk in sorted((c for c in chunks if c.left > 0), key=lambda c: not c.times):
        heapq.heapreplace(ends, ends[0] + chunk.left * known.get(chunk.condition, typical))
    return Remaining(max(ends), len({c.condition for c in chunks if c.left > 0} - set(known)))


def duration(seconds):
    """Duration as text."""
    return f"{seconds / 3600:.1f} h" if seconds > 5400 else f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"


def sentence(done, of, rate, left):
    """The line of progress. rate: games a second; left: a Remaining or None."""
    text = f"sweep: {done} of {of} games, {rate:.2f} a second"
    if left is None or done >= of:
        return text
    text += f", {duration(left.seconds)} left"
    if left.unmeasured:
        text += f" if the {left.unmeasured} conditions without a game yet are like the others" if left.unmeasured > 1 else " if the condition without a game yet is like the others"
    return text
