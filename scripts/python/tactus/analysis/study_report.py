"""The report of a study: one self-contained HTML page, with its figures beside it as SVG and PNG."""
import collections
import re

import numpy as np

from tactus.analysis import incomplete, limit_plots, limits, mixed, performance_plots, published, resampling
from tactus.analysis.plot_style import figures
from tactus.analysis.result_tables import degraded_words
from tactus.report.words import figure as number, listed, page, safe, table


class Report:
    """Numbers figures, tables and sources while the sections are generated."""

    def __init__(self, analysis, folder):
        self.analysis = analysis
        self.gallery = figures.Gallery(folder)
        self.tables, self.sources, self.slugs = 0, [], collections.Counter()

    def keep(self, fig, slug, caption):
        """Adds a figure under a unique, valid file name, also if two studies share a condition; returns its HTML."""
        slug = re.sub(r"[^A-Za-z0-9_]+", "-", slug)
        self.slugs[slug] += 1
        return self.gallery.keep(fig, slug if self.slugs[slug] == 1 else f"{slug}_{self.slugs[slug]}", caption + self.who())

    def table(self, caption, head, rows):
        self.tables += 1
        return table(caption + self.who(), head, rows, self.tables)

    def who(self):
        return f" <b>observer = {safe(self.analysis.observer)}</b>." if self.analysis.observer.startswith("simulated") else f" Observers: {safe(self.analysis.observer)}." if "simulated" in self.analysis.observer else ""

    def cite(self, source):
        if source not in self.sources:
            self.sources.append(source)
        n = self.sources.index(source) + 1
        return f'<a href="#ref{n}">[{n}]</a>'

    def html(self, name):
        sections = [head, limits_section, curves_section, felt_section, performance_section, models_section, methods]
        body = "".join(section(self) for section in sections)
        if self.sources:
            body += '<h2>Sources</h2>\n<ol class="refs">' + "".join(f'<li id="ref{i + 1}">{safe(s)}</li>' for i, s in enumerate(self.sources)) + "</ol>\n"
        return page(f"Study {name}", body)


POOR = 0.05  # p of a fit below which the page mentions it; usual
SMALLEST = 1e-6  # magnitudes below are printed as 0; design


def span(low, high, endless="not reached"):
    """An interval as text; endless: text of an infinite end."""
    end = lambda v: endless if np.isinf(v) else number(0.0 if abs(v) < SMALLEST else v)
    return f"[{end(low)}, {end(high)}]"


def value_of(limit):
    unit = f" {limit.factor.unit}" if limit.factor.unit else ""
    if np.isnan(limit.value):
        return "not identified"
    return f"{number(limit.value)}{unit} {span(limit.low, limit.high)}" if limit.reached else f"not reached up to {number(limit.up_to)}{unit}"


def head(report):
    a = report.analysis
    studies = sorted({s for s in a.trials["study"] if s}) or ["a study without a name"]
    people = len(a.trials.participants())
    sentences = [f"{number(len(a.trials))} trials and games of {number(people)} participant{'s' if people != 1 else ''} were analysed"
                 + (f"; {number(a.left_out)} were left out because the apparatus missed its tolerance." if a.left_out else "; none was left out.")
                 + "".join(f" {clause}." for clause in incomplete.words(a.trials))]
    if "simulated" in a.observer:
        sentences.append(f"<b>observer = {safe(a.observer)}</b>: no person took part; all results are of simulated participants."
                         if a.observer.startswith("simulated") else "<b>Some observers were simulated</b>; figures and tables mix them with people.")
    for limit in (l for l in a.limits if l.kind == "break" and l.by.split()[0] == limits.EITHER):
        whose = limit.by.removeprefix(limits.EITHER)
        sentences.append(f"L_break of {safe(limit.factor.words() + whose)}: {safe(value_of(limit))}.")
    return f"<h1>{safe(listed(studies))}</h1>\n<p class=\"sub\">Limits of degradation of each sense: noticed, felt, harmful to the task</p>\n<p class=\"sum\">{' '.join(sentences)}</p>\n"


def margins_of(analysis):
    """" (10 points, 10 %)" if all studies have the same margins, else ""."""
    found = {p.margins for p in analysis.performances}
    return "".join(f" ({100 * success:g} points, {100 * (time - 1):.3g} %)" for success, time in found) if len(found) == 1 else ""


def limits_section(report):
    a = report.analysis
    if not a.limits:
        return ""
    factors = sorted({l.factor for l in a.limits})
    parts = ["<h2>Limits of each sense</h2>\n",
             report.table("Limits with 95 % intervals. L_detect: noticed; L_appear: a felt property differs by more than its JND; L_break: success or time worse than "
                          f"undegraded by the margin{margins_of(a)}.",
                          ["sense and operator", "limit", "by", "level", "bracket", "n"],
                          [[l.factor.words(), f"L_{l.kind}", l.by, value_of(l), "" if np.isnan(l.bracket).any() else span(*l.bracket, "∞"), l.n]
                           for f in factors for l in a.limits if l.factor == f]),
             "<p>A bracket holds the limit with 95 % and assumes only that performance gets no better with the level; the limit and its interval assume that it changes smoothly.</p>\n"
             if any(l.kind == "break" for l in a.limits) else ""]
    noted = collections.defaultdict(list)
    for l in a.limits:
        if l.note:
            noted[l.note].append(f"L_{l.kind} of {l.factor.words()} by {l.by}")
    parts += [f"<p>{safe(listed(of))}: {safe(note)}.</p>\n" for note, of in noted.items()]
    for factor in factors:
        mine = [l for l in a.limits if l.factor == factor]
        behind = published.of_factor(factor)
        for t in behind:
            report.cite(t.source)
        parts.append(report.keep(limit_plots.limits_figure(factor, mine, behind, a.observer), f"limits_{factor.modality}_{factor.operator}",
                                 f"Limits of {safe(factor.words())} with 95 % intervals" + ("; grey: published thresholds by source." if behind else ".")))
    rows = [(f"{r.upper.factor.words()} / {r.lower.by}", False, r.value, r.low, r.high) for r in a.ratios]
    rows += [(f"{l.factor.words()} / {t.earlier} → {t.later}, {t.what}: {t.short()}", True, l.value / t.ms, l.low / t.ms, l.high / t.ms) for l, t in a.against_published]
    if rows:
        parts.append(report.keep(limit_plots.forest_figure(rows, a.observer), "ratio_break_detect",
                                 "L_break / L_detect with 95 % intervals. Black: both measured here; grey: relative to a published threshold, whose own spread is "
                                 "not in the interval."))
    return "".join(parts)


def curves_section(report):
    if not report.analysis.curves:
        return ""
    from tactus.analysis import curve_plots
    from tactus.analysis import plot_style
    from tactus.analysis import psychometric
    parts, seed = ["<h2>Psychometric functions</h2>\n"], report.analysis.settings.seed
    conditions = []
    for curve in report.analysis.curves:
        if curve.condition not in conditions:
            conditions.append(curve.condition)
    for condition in conditions:
        mine = [c for c in report.analysis.curves if c.condition == condition]
        together_curve = mine[0]
        parts.append(f"<h3>{safe(condition.words())}{safe(f' ({condition.study})' if condition.study else '')}</h3>\n")
        names = list(dict.fromkeys(name for c in mine if c.fit for name in c.intervals))
        rows = [[plot_style.name_in_table(c.participant, mine), int(c.total.sum())] + ([f"{number(0.0 if abs(c.value(n)) < SMALLEST else c.value(n))} {span(*c.intervals[n], 'no end')}" if n in c.intervals else "–" for n in names] if c.fit
                else [c.why, *[""] * (len(names) - 1)]) for c in mine]
        parts.append(report.table(f"Maximum likelihood with 95 % intervals: {safe(condition.axis())}.", ["participant", "n", *(names or ["why not"])], rows))
        if together_curve.aic:
            best = min(together_curve.aic, key=together_curve.aic.get)
            parts.append(f"<p>Of three windows, the one with {safe(best) if best != 'asymmetric' else 'an asymmetric form'} describes the answers of all together best: "
                         + safe(", ".join(f"AIC {value:.1f} ({model})" for model, value in together_curve.aic.items())) + f". The asymmetric window has its maximum at "
                         f"{number(together_curve.asymmetric.values['pss'])} ms, a peak of {number(together_curve.asymmetric.values['peak'])}, and reaches 75 % of it at "
                         f"{number(together_curve.asymmetric.values['low75'])} and {number(together_curve.asymmetric.values['high75'])} ms.</p>\n")
        varied = [c for c in mine if c.fit and c.dispersion.p < POOR]
        if varied:
            parts.append(f"<p>The answers of {safe(listed([c.participant or 'all together' for c in varied]))} do not fit the function as independent answers would (p = "
                         + safe(", ".join(f"{c.dispersion.p:.3f}" for c in varied)) + ", deviance of refits); their design effects are "
                         + safe(", ".join(f"{c.dispersion.factor:.2f}" for c in varied)) + ", and the intervals allow for this.</p>\n")
        doubtful = [c.participant or "all together" for c in mine if c.fit and c.why]
        if doubtful:
            parts.append(f"<p>{safe(listed(doubtful).capitalize())}: {safe(psychometric.TOO_FAR)}.</p>\n")
        if together_curve.fit is not None:
            fig, beyond = curve_plots.curve_figure(together_curve, seed)
            for t in dict.fromkeys(t for _, t in published.of_pair(*condition.pair)) if condition.pair else []:
                report.cite(t.source)
            parts.append(report.keep(fig, f"curve_{condition.slug()}", f"{safe(condition.words().capitalize())}: points proportional to the number of answers, the function with its 95 % band; at the bottom the 95 % interval of its centre" + ("; dashed: published thresholds" if condition.pair else "")
                                     + (f", {beyond} of them outside the presented levels" if beyond else "") + "."))
        if len(mine) > 2:
            parts.append(report.keep(curve_plots.small_multiples(mine), f"participants_{condition.slug()}", "Each participant; grey: all together."))
        if condition.pair and len(together_curve.levels):
            parts.append(report.keep(curve_plots.achieved_figure(together_curve), f"achieved_{condition.slug()}", "Measured asynchronies, and their differences to the requested ones."))
        if any(len(c.trials) for c in mine):
            parts.append(report.keep(curve_plots.trace_figure(mine), f"levels_{condition.slug()}", "Levels in order of presentation; filled: "
                                     f"{ {'sj': 'judged synchronous', 'toj': 'first sense first', '2ifc': 'correct'}[condition.kind]}. Line: running estimate of the centre; band: its final interval."))
        if len(mine) > psychometric.FEWEST_TRIALS + 5:
            parts.append(f"<p>The first {curve_plots.MAX_SMALL} participants are shown; the table lists all.</p>\n")
    return "".join(parts)


def felt_section(report):
    felt = report.analysis.felt
    if not felt:
        return ""
    parts = ["<h2>Felt properties</h2>\n"]
    for f in felt:
        left = f" {f.left_out} answers of participants who never judged the undegraded stimulus are left out." if f.left_out else ""
        parts.append(report.keep(limit_plots.felt_figure(f), f"felt_{f.property}_{f.factor.modality}_{f.factor.operator}",
                                 f"{'Measured' if f.measured else 'Felt'} {f.property} under {safe(f.factor.words())}, relative to the undegraded stimulus, with 95 % intervals. Band: the JND {report.cite(f.source.source)} "
                                 f"({safe(f.source.situation)}; {number(f.source.jnd)} {safe(f.source.unit)} by {safe(f.source.criterion)}" + ("" if f.source.percent != f.source.percent else f", {number(f.source.at75)} at 75 %") + f"). L_appear: {safe(value_of(f.limit))}; the property is felt as {f.toward}.{left}"))
    return "".join(parts)


def performance_section(report):
    a, parts = report.analysis, []
    for p in a.performances:
        parts.append(f"<h2>Games{': ' + safe(p.study) if p.study else ''}</h2>\n")
        baseline = p.cells[()]
        rows = []
        for degraded, c in p.cells.items():
            d = p.differences.get(degraded)
            time = resampling.interval(c.draws[:, 1])
            low, high = c.share_interval(p.clustered)
            rows.append([degraded_words(degraded), c.n, f"{100 * c.share:.1f} [{100 * low:.1f}, {100 * high:.1f}]", f"{c.mean_time_s:.2f} {span(*time)}"]
                        + ([f"{100 * d.success:+.1f} [{100 * d.success_interval[0]:+.1f}, {100 * d.success_interval[1]:+.1f}]",
                            f"{d.time:.3f} {span(*d.time_interval)}" if d.time == d.time else "not identified", f"{d.parts_s[0]:+.2f} {d.parts_s[1]:+.2f}" if d.parts_s[0] == d.parts_s[0] else "",
                            "harmless" if d.harmless else "harmful" if d.harmful else "open"] if d else ["", "", "", "baseline"]))
        parts.append(report.table(f"Games won (%), mean time (s; games not won count {number(p.limit_s) if np.isfinite(p.limit_s) else 'with the limit, but all were won'}"
                                  f"{' s' if np.isfinite(p.limit_s) else ''}), and both compared with all senses: the difference of success, the ratio of the times to win with games not won as "
                                  "censored, and the change of the mean time by success and by time to win (s). Harmless: shown to be within both margins; harmful: an interval lies "
                                  "beyond its margin.", ["condition", "n", "won %", "time s", "difference, points", "ratio of time to win", "by success, by time", "shown"], rows))
        if baseline.share < p.margins[0] or not np.exp(baseline.times.mu) * p.margins[1] <= p.limit_s:
            parts.append("<p>The undegraded games were won too rarely, or too late, for any level to be worse by a margin: no level is shown to be harmless by that outcome.</p>\n")
        for factor, found in p.limits.items():
            parts.append(report.keep(performance_plots.factor_figure(p.cells, factor, found, p.margins, p.observer, p.clustered), f"games_{factor.modality}_{factor.operator}",
                                     f"Games under {safe(factor.words())}. Green: all senses, with their interval; dashed: the margin; red: L_break with its interval."))
            parts.append(report.keep(performance_plots.margin_figure(factor, p.curves[factor], p.margins, p.observer), f"limits_over_margin_{factor.modality}_{factor.operator}",
                                     f"L_break of {safe(factor.words())} over the margin and over the time limit, with 95 % bands. An answer that hangs on one margin or limit is a property of that choice."))
        removed = [(degraded_words(degraded), d) for degraded, d in p.differences.items() if all(f.removal for f, _ in degraded)]
        if removed:
            parts.append(report.keep(performance_plots.removal_figure(removed, baseline, p.margins, p.observer), "removal",
                                     "Contribution of each sense: games without it compared with all senses, with 95 % intervals. Dashed: the margins."))
        for f in p.frontiers:
            slug = f"{f.first.modality}_{f.first.operator}_{f.second.modality}_{f.second.operator}"
            parts.append(report.keep(performance_plots.frontier_figure(f, p.cells, p.margins, p.observer), f"frontier_map_{slug}",
                                     f"{safe(f.first.words().capitalize())} and {safe(f.second.words())} together. Red line: where the margin is reached; dashed: 75 % of the games won."))
            if f.edge:  # empty if neither sense was degraded alone
                parts.append(report.keep(performance_plots.edge_figure(f, p.observer), f"frontier_{slug}",
                                         f"L_break of {safe(f.second.words())}, by success or time, at each level of {safe(f.first.words())}, with 95 % intervals."))
    return "".join(parts)


def models_section(report):
    models = report.analysis.models
    if not models:
        return ""
    rows, doubts = [], []
    for words, model in models:
        if not isinstance(model, mixed.Model):
            doubts.append((words, model))
            continue
        rows += [[words if i == 0 else "", e.name, f"{number(e.estimate)} {span(e.low, e.high)}", "< 0.0001" if e.p < 1e-4 else f"{e.p:.4f}"] for i, e in enumerate(model.effects)]
        rows.append(["", "between participants", f"sd of intercept {number(model.sd_intercept)}, of slope {number(model.sd_slope)}", f"{model.participants} people"])
        doubts.append((words, model.words))
    text = "<h2>Models over participants</h2>\n"
    if rows:
        text += report.table("Mixed models: effects with 95 % intervals, in log odds or in ln(s), per unit of the level.", ["of", "effect", "estimate", "p"], rows)
    by_words = {}
    for words, said in doubts:
        by_words.setdefault(said, []).append(words)
    return text + "".join(f"<p>{safe(listed(of).capitalize())}: {safe(said)}</p>\n" for said, of in by_words.items())


def methods(report):
    a = report.analysis
    clusters = "Participants were the sample." if len(a.trials.participants()) >= resampling.FEWEST_PARTICIPANTS else \
        f"There were fewer than {resampling.FEWEST_PARTICIPANTS} participants: intervals hold for the trials of these participants and not for other people."
    return ("<h2>Methods</h2>\n<p>All levels are measured ones where the apparatus measured them. "
            f"{clusters} Seed {a.settings.seed}. L_break is the level at which success, or the time to win given success, is worse by the margin: a Gaussian process, made "
            "monotone, over the log odds of success and over the logarithm of the time, whose games not won are censored (log-normal, with a share that cannot be won). Its bracket holds "
            "over all levels together. Success was tested by Farrington and Manning’s score test of non-inferiority with Newcombe’s interval, or over people by Student’s t on the log "
            f"odds; time by Student’s t on the logarithm; one-sided at α = {a.settings.alpha:g}, from the mildest level on. Synchrony windows have a free peak.</p>\n")
