"""The complete analysis of a study's trials in one object, from which tables, figures and report are made."""
import dataclasses

import numpy as np

from tactus.analysis import appearance, break_limits, detection, frontier, limits, mixed, performance, presses, published, trials as tables
from tactus.analysis.answers import kind_of


MARGIN = 0.10  # design; default of command and study file: 10 points of success, 10 % of time


@dataclasses.dataclass
class Settings:
    """margin_success: share of games, 0.1 = 10 points; margin_time: share of the time; time_limit_s: of a game. None: value of the study file. stated:
    {study: study_files.Stated}."""
    margin_success: float = None
    margin_time: float = None
    alpha: float = performance.ALPHA  # one-sided
    time_limit_s: float = None
    seed: int = 1
    asymmetric: bool = False  # windows of synchrony
    stated: dict = dataclasses.field(default_factory=dict)

    def margins(self, study):
        """(share of success, ratio of time)."""
        file = self.stated.get(study)
        success, time = (file.margin_success, file.margin_time) if file else (MARGIN, MARGIN)
        return success if self.margin_success is None else self.margin_success, 1 + (time if self.margin_time is None else self.margin_time)

    def limit_s(self, study):
        """Time limit of a game, s; None: from the games."""
        return self.stated[study].limit_s if self.time_limit_s is None and study in self.stated else self.time_limit_s

    def felt(self, study):
        return self.stated[study].felt if study in self.stated else ""


@dataclasses.dataclass
class Performance:
    """Results of the games of one study."""
    study: str
    margins: tuple
    cells: dict
    clustered: bool
    limit_s: float
    differences: dict
    limits: dict  # {Factor: [Limit]}
    curves: dict  # {Factor: rows of break_limits.curves}
    frontiers: list
    observer: str
    participants: int


@dataclasses.dataclass
class Analysis:
    settings: Settings
    trials: object
    left_out: int
    curves: list
    felt: list
    performances: list
    limits: list
    ratios: list  # of L_break to a measured L_detect
    against_published: list  # [(Limit, Threshold)]
    models: list  # [(words, Model, or the reason why there is none)]
    observer: str


def performances_of(trials, settings):
    made = []
    for i, ((study,), games) in enumerate(performance.games_of(trials).groups("study")):
        limit_s, margins = performance.limit_s(games, settings.limit_s(study)), settings.margins(study)
        rng = np.random.default_rng([settings.seed, 2000 + i])
        cells, clustered = performance.cells_of(games, limit_s, rng)
        differences = performance.differences(cells, clustered, margins, settings.alpha, limit_s)
        found, over = {}, {}
        for factor in limits.factors_of(cells):
            worse = break_limits.worsenings(cells, factor, clustered, rng)
            found[factor] = break_limits.break_limits(cells, factor, clustered, margins, games.observer(), rng, worse)
            over[factor] = break_limits.curves(cells, factor, clustered, margins, limit_s, rng, worse)
        edges = [frontier.frontier(cells, *pair, clustered, margins, games.observer(), rng) for pair in frontier.pairs_of(cells)]
        made.append(Performance(study, margins, cells, clustered, limit_s, differences, found, over, edges, games.observer(), len(games.participants())))
    return made


def curves_of(trials, settings):
    if not any(kind_of(task) for task in trials["task"]):
        return []
    from tactus.analysis import psychometric
    return psychometric.curves(trials, settings.seed, settings.asymmetric)


def ratios_of(limits_, rng):
    """Ratio of L_break (by the earlier of success and time) to each L_detect of the same factor."""
    breaks = [l for l in limits_ if l.kind == "break" and l.by.split()[0] == limits.EITHER]
    return [limits.ratio(b, d, rng) for b in breaks for d in limits_ if d.kind == "detect" and d.factor == b.factor]


def against_published(limits_):
    return [(b, t) for b in limits_ if b.kind == "break" and b.by.split()[0] == limits.EITHER for t in published.of_factor(b.factor)]


def models_of(trials, curves, performances):
    """Mixed models of each condition with answers, and of each factor of the games."""
    made = []
    for curve in curves:
        if curve.participant == "" and len(curve.levels):
            made.append((curve.condition.words(), answers_model(curve)))
    for p in performances:
        for factor in p.limits:
            mine = [p.cells[()], *limits.series(p.cells, factor)]
            severity = np.concatenate([np.full(c.n, 0.0 if not c.degraded else factor.severity(c.achieved)) for c in mine])
            people = np.concatenate([c.participants for c in mine])
            join = lambda name: np.concatenate([getattr(c, name) for c in mine])
            many = len(people) == len(set(people))
            won = join("success")
            made.append((f"games won, {factor.words()}", mixed.ONCE if many else mixed.logistic(people, severity, won, factor.severity_axis())))
            made.append((f"time to win, {factor.words()}", mixed.ONCE if many else mixed.log_linear(people, severity, join("ended_s"), factor.severity_axis(), won == 1)))
    return made


def answers_model(curve):
    from tactus.analysis import answers
    from tactus.analysis import psychometric
    levels, _ = psychometric.achieved(curve.trials, (None, curve.condition.pair, curve.condition.factor))
    _, yes = answers.answered(curve.condition.kind, curve.trials, curve.condition.pair)
    return mixed.logistic(curve.trials["participant_id"], levels, yes, "SOA" if curve.condition.pair else curve.condition.factor.severity_axis(), curve.condition.kind == "sj")


def analyse(trials, settings):
    """Analysis of all rows. Raises Refusal if the rows lack data that an analysis needs."""
    kept, left_out = tables.usable(trials)
    rng = np.random.default_rng([settings.seed, 3000])
    curves = curves_of(kept, settings)
    felt = [f for (name, rows) in appearance.judged(kept, settings.felt) for f in appearance.felt(name, rows, rng)] + presses.felt(kept, rng)
    performances = performances_of(kept, settings)
    found = detection.detection_limits(curves, settings.seed, settings.felt) if curves else []
    found += [f.limit for f in felt]
    for p in performances:
        several = f" ({p.study})" if len(performances) > 1 else ""  # names the study if there are several
        found += [dataclasses.replace(l, by=l.by + several) for of_factor in p.limits.values() for l in of_factor]
    return Analysis(settings, kept, left_out, curves, felt, performances, found, ratios_of(found, rng), against_published(found),
                    models_of(kept, curves, performances), trials.observer())
