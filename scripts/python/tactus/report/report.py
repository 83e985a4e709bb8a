"""A report on one log or several: its sections, in order. What a log does not hold is said, not left out."""
from tactus.log import log_tables
from tactus.paths import REPOSITORY
from tactus.report import sections, traces, words


class Report:
    """What the sections share: the logs, figures, the numbering of tables and sources, and what is missing."""

    def __init__(self, logs, gallery):
        self.logs, self.gallery = logs, gallery
        self.thresholds = log_tables.thresholds(REPOSITORY / "sync" / "presentation" / "thresholds.csv")
        self.tables, self.sources, self.missing = 0, [], []

    @property
    def log(self):
        """The one that is told of; of several the first, which the others are held against."""
        return self.logs[0]

    def table(self, caption, head, rows):
        self.tables += 1
        return words.table(caption, head, rows, self.tables)

    def cite(self, source):
        """[n] of a source."""
        if source not in self.sources:
            self.sources.append(source)
        n = self.sources.index(source) + 1
        return f'<a href="#ref{n}">[{n}]</a>'

    def lacks(self, sentence):
        self.missing.append(sentence)
        return f'<p class="missing">{words.safe(sentence)}</p>\n'

    def html(self):
        parts = [sections.head(self)]
        if len(self.logs) > 1:
            parts.append(sections.comparison(self))
        parts += [section(self) for section in (sections.methods, sections.contacts, sections.processes, sections.latency, sections.asynchrony,
                                                sections.raster, traces.section, sections.degradation)]
        parts.append("<h2>What the log does not hold</h2>\n")
        parts.append("<ul>" + "".join(f"<li>{words.safe(m)}</li>" for m in [*self.missing, *sections.always_missing(self)]) + "</ul>\n")
        if self.sources:
            parts.append('<h2>Sources</h2>\n<ol class="refs">' + "".join(f'<li id="ref{i + 1}">{words.safe(s)}</li>' for i, s in enumerate(self.sources)) +
                         "</ol>\n")
        return words.page(f"Report on {self.log.name}", "".join(parts))
