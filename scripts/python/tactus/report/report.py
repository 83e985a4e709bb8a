"""A report on one or several logs: its sections, in order. The report states which data a log lacks."""
from tactus.paths import THRESHOLDS
from tactus.report import metrics, sections, traces, words
from tactus.tables import read_rows


class Report:
    """State shared by the sections: logs, figures, numbers of tables and sources, missing data."""

    def __init__(self, logs, gallery):
        self.logs, self.gallery = logs, gallery
        self.thresholds = read_rows(THRESHOLDS)
        self.tables, self.sources, self.missing = 0, [], []

    @property
    def log(self):
        """The described log: the first, with which the others are compared."""
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
                                                sections.raster, traces.section, sections.degradation, metrics.section)]
        parts.append("<h2>Missing data</h2>\n")
        parts.append("<ul>" + "".join(f"<li>{words.safe(m)}</li>" for m in [*self.missing, *sections.always_missing(self)]) + "</ul>\n")
        if self.sources:
            parts.append('<h2>Sources</h2>\n<ol class="refs">' + "".join(f'<li id="ref{i + 1}">{words.safe(s)}</li>' for i, s in enumerate(self.sources)) +
                         "</ol>\n")
        return words.page(f"Report on {self.log.name}", "".join(parts))
