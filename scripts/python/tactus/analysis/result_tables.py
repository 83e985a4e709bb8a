"""The results as tables: one CSV for each kind of result, and JSON of all."""
import csv
import math
import os

from tactus.analysis import mixed, performance, resampling
from tactus.tables import escaped


def plain(value):
    """A field of a CSV: six digits, `inf` for a limit that was not reached, empty for no value; formulas of spreadsheets are escaped."""
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return "" if value is None else escaped(str(value))


def curve_rows(analysis):
    for c in analysis.curves:
        base = {"study": c.condition.study, "condition": c.condition.words(), "participant": c.participant or "all", "observer": c.observer, "n": int(c.total.sum())}
        if c.fit is None:
            yield {**base, "parameter": "", "value": math.nan, "low": math.nan, "high": math.nan, "why": c.why}
            continue
        for name, value in {**c.fit.params, **c.fit.derived}.items():
            low, high = c.intervals.get(name, (math.nan, math.nan))
            yield {**base, "parameter": name, "value": float(value), "low": low, "high": high, "why": c.why if name in c.intervals else "fixed" if name in c.fit.fixed else ""}
        if c.asymmetric:
            for name, value in {**c.asymmetric.params, **c.asymmetric.values}.items():
                low, high = c.asymmetric.intervals.get(name, (math.nan, math.nan))
                yield {**base, "parameter": f"asymmetric {name}", "value": float(value), "low": low, "high": high, "why": ""}
        for name, value in (("goodness of fit, p", c.dispersion.p), ("design effect", c.dispersion.factor), ("widening of variances", c.dispersion.width())):
            yield {**base, "parameter": name, "value": value, "low": math.nan, "high": math.nan, "why": ""}
        for model, value in c.aic.items():
            yield {**base, "parameter": f"AIC, {model}", "value": value, "low": math.nan, "high": math.nan, "why": "smallest" if value == min(c.aic.values()) else ""}


def limit_rows(analysis):
    for l in analysis.limits:
        yield {"limit": f"L_{l.kind}", "modality": l.factor.modality, "operator": l.factor.operator, "unit": l.factor.unit, "by": l.by, "value": l.value, "low": l.low,
               "high": l.high, "reached": int(l.reached), "bracket_low": l.bracket[0], "bracket_high": l.bracket[1], "up_to": l.up_to, "n": l.n, "note": l.note,
               "observer": l.observer}


def curve_over_margin_rows(analysis):
    for p in analysis.performances:
        for factor, rows in p.curves.items():
            for r in rows:
                yield {"study": p.study, "modality": factor.modality, "operator": factor.operator, "unit": factor.unit, "by": r["outcome"], "margin": r["margin"],
                       "limit_s": r["limit_s"], "value": r["value"], "low": r["low"], "high": r["high"], "up_to": r["up_to"], "observer": p.observer}


def ratio_rows(analysis):
    for r in analysis.ratios:
        yield {"modality": r.upper.factor.modality, "operator": r.upper.factor.operator, "detected_by": r.lower.by, "source": "measured", "ratio": r.value, "low": r.low,
               "high": r.high, "observer": r.upper.observer}
    for l, t in analysis.against_published:
        yield {"modality": l.factor.modality, "operator": l.factor.operator, "detected_by": f"{t.earlier} -> {t.later}, {t.what}", "source": t.source,
               "ratio": l.value / t.ms, "low": l.low / t.ms, "high": l.high / t.ms, "observer": l.observer}


DIFFERENCE = ("success_difference", "success_difference_low", "success_difference_high", "time_ratio", "time_ratio_low", "time_ratio_high", "restricted_time_ratio",
              "restricted_by_success_s", "restricted_by_time_s", "p_success", "p_time", "shown_harmless", "shown_harmful")


def degraded_words(degraded):
    return " and ".join(f"{f.words()}" + ("" if f.removal else f" {level:g} {f.unit}".rstrip()) for f, level in degraded) or "all senses"


def difference_cells(d):
    """Cells of a Difference; empty ones for the baseline, None."""
    cells = {} if d is None else {
        "success_difference": d.success, "success_difference_low": d.success_interval[0], "success_difference_high": d.success_interval[1], "time_ratio": d.time,
        "time_ratio_low": d.time_interval[0], "time_ratio_high": d.time_interval[1], "restricted_time_ratio": d.restricted, "restricted_by_success_s": d.parts_s[0],
        "restricted_by_time_s": d.parts_s[1], "p_success": d.p_success, "p_time": d.p_time, "shown_harmless": int(d.harmless), "shown_harmful": int(d.harmful)}
    return {name: cells.get(name) for name in DIFFERENCE}


def between_people(cell):
    """Correlation of the success of two games of the same person, beta-binomial."""
    from tactus.psychophysics import overdispersion
    return overdispersion.beta_binomial(*performance.counted(cell, sorted(set(cell.participants)))).rho


def condition_rows(analysis):
    for p in analysis.performances:
        for degraded, c in p.cells.items():
            share, time = c.share_interval(p.clustered), resampling.interval(c.draws[:, 1])
            d = p.differences.get(degraded)
            row = {"study": p.study, "condition": degraded_words(degraded), "achieved": c.achieved, "n": c.n, "success": c.share, "success_low": share[0],
                   "success_high": share[1], "time_s": c.mean_time_s, "time_low_s": time[0], "time_high_s": time[1], "time_to_win_s": math.exp(c.times.mu), "sd_log_time": c.times.sd,
                   "winnable": c.times.winnable, "rho": between_people(c) if p.clustered else math.nan}
            row.update(difference_cells(d))
            for name, values in c.extras.items():
                known = values[values == values]
                row[name] = float(known.mean()) if len(known) else math.nan
            yield {**row, "observer": p.observer}


def frontier_rows(analysis):
    for p in analysis.performances:
        for f in p.frontiers:
            for level, l in f.edge:
                yield {"study": p.study, "first": f.first.axis(), "first_level": level, "second": f.second.axis(), "L_break_of_second": l.value, "low": l.low,
                       "high": l.high, "up_to": l.up_to, "n": l.n, "observer": l.observer}


def felt_rows(analysis):
    for f in analysis.felt:
        for level, shift, (low, high), n in zip(f.levels, f.shifts, f.intervals, f.counts):
            yield {"property": f.property, "by": "measured" if f.measured else "judged", "modality": f.factor.modality, "operator": f.factor.operator, "level": level, "unit": f.factor.unit, "shift": shift,
                   "low": low, "high": high, "jnd": f.jnd, "published_jnd": f.source.jnd, "criterion": f.source.criterion, "n": n, "source": f.source.source, "observer": f.observer}


def model_rows(analysis):
    for words, model in analysis.models:
        if not isinstance(model, mixed.Model):
            yield {"of": words, "effect": "", "estimate": math.nan, "low": math.nan, "high": math.nan, "p": math.nan, "sd_intercept": math.nan, "sd_slope": math.nan,
                   "participants": "", "rows": "", "what": model, "observer": analysis.observer}
            continue
        for e in model.effects:
            yield {"of": words, "effect": e.name, "estimate": e.estimate, "low": e.low, "high": e.high, "p": e.p, "sd_intercept": model.sd_intercept,
                   "sd_slope": model.sd_slope, "participants": model.participants, "rows": model.rows, "what": model.words, "observer": analysis.observer}


TABLES = {"psychometric": curve_rows, "limits": limit_rows, "limit_curves": curve_over_margin_rows, "ratios": ratio_rows, "conditions": condition_rows, "frontier": frontier_rows,
          "felt": felt_rows, "mixed_models": model_rows}


def all_rows(analysis):
    """{table: [row]} of the tables that have rows."""
    made = {name: list(rows(analysis)) for name, rows in TABLES.items()}
    return {name: rows for name, rows in made.items() if rows}


def write(made, folder):
    for name, rows in made.items():
        with open(os.path.join(folder, name + ".csv"), "w", newline="", encoding="utf-8") as file:
            out = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            out.writeheader()
            out.writerows({key: plain(value) for key, value in row.items()} for row in rows)


def for_programs(made):
    """The rows for JSON, which has no NaN and no infinity: null, and "not reached"."""
    def plain_json(value):
        if isinstance(value, float) and not math.isfinite(value):
            return None if value != value else "not reached"
        return value
    return {name: [{key: plain_json(value) for key, value in row.items()} for row in rows] for name, rows in made.items()}
