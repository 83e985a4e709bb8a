"""Common style of the figures of a study: colours, mark of simulated observers, and published thresholds behind the data."""

import unicodedata

from tactus import palette
from tactus.report import figures
from matplotlib import font_manager

figures.matplotlib.rcParams["text.parse_math"] = False  # shows names literally

INK, PALE, BREAK = "#222222", "#9aa7b5", palette.LIMIT["break"]
BANDS = palette.BANDS


def colour(modality):
    return figures.COLOUR.get(modality.partition(":")[0], INK)


def stamp(fig, observer):
    """Marks a figure whose answers are partly or all simulated."""
    if "simulated" in observer:
        fig.text(0.998, 1.0, f"observer = {observer}", ha="right", va="bottom", fontsize=7, color=INK)


def thresholds_behind(axes, found, legend=True):
    """Draws a line for each of found, [(x, Threshold)], one colour per source, and the range between the smallest and the largest on each side. Returns
    the number of thresholds outside the axis."""
    low, high = axes.get_xlim()
    shown = [(x, t) for x, t in found if low <= x <= high]
    for side in (-1, 1):
        mine = [x for x, _ in shown if x * side > 0]
        if len(mine) > 1:
            axes.axvspan(min(mine), max(mine), color="#f9f3e4", zorder=0, linewidth=0)
    marks = {}
    sources = []
    for x, t in shown:
        label = t.short()
        if label not in sources:
            sources.append(label)
        marks[label] = axes.axvline(x, color=BANDS[sources.index(label) % len(BANDS)], linewidth=1, linestyle=(0, (4, 2)), zorder=1)
    if marks and legend:
        axes.add_artist(axes.legend(marks.values(), marks.keys(), loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=6.5, title="published thresholds",
                                    title_fontsize=7, handlelength=1.6))
    return len(found) - len(shown)


def is_drawn(text):
    """Whether matplotlib draws a text as it is written: its font has every character, none joins another, and it runs from left to right."""
    font = font_manager.get_font(font_manager.findfont("DejaVu Sans"))
    return all(font.get_char_index(ord(c)) and unicodedata.category(c)[0] not in "MC" and unicodedata.bidirectional(c) not in ("R", "AL", "AN") for c in text)


def number_of(participant, curves):
    """Number of a participant among these curves, from 1."""
    return 1 + [c.participant for c in curves if c.participant].index(participant)


def label_of(participant, curves):
    """Title of a participant in a figure: the name, or its number in the table when the figure cannot show the name."""
    if not participant:
        return "all together"
    return participant if is_drawn(participant) else f"participant {number_of(participant, curves)}"


def name_in_table(participant, curves):
    """The name of a participant in a table, with its number when figures show that instead."""
    if not participant:
        return "all together"
    return participant if is_drawn(participant) else f"{number_of(participant, curves)}: {participant}"
