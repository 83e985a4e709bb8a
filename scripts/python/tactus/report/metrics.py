"""The section on the metrics that predict success best. HTML."""
from tactus.metrics import of_run, ranking
from tactus.report.words import safe

SHOWN = 3
SOURCE = ("Ranking of this project: a curve of success against the metric, fitted to the games of all other operators of a modality, predicts those of the operator that was left out; "
          "simulated player, one task")


def section(report):
    """The values of the SHOWN best metrics of the stored ranking, for each log; forces are compared with those of the first."""
    stored = ranking.stored()
    best = [row for row in stored["ranking"] if row["metric"] in of_run.MEANING][:SHOWN]
    reference = report.log.folder if len(report.logs) > 1 else None
    rows = []
    for i, log in enumerate(report.logs):
        found = of_run.metrics(log.folder, reference if i > 0 else None, log)
        rows.append([log.name, *(found.get(row["metric"]) for row in best)])
    head = [f"{row['metric'].removesuffix('_' + unit)}, {unit}" if (unit := of_run.MEANING[row["metric"]][0]) != "1" else row["metric"] for row in best]
    meanings = "; ".join(f"{row['metric']}: {of_run.MEANING[row['metric']][1]} (skill {row['skill']:.2f})" for row in best)
    text = (f"<p>The metrics that predicted success best in {stored['games']} games, out of sample {report.cite(SOURCE)}. {safe(meanings)}. Skill is the share of the uncertainty about a game "
            f"that the metric removes. <code>{safe(stored['command'])}</code> repeats the ranking.</p>\n")
    out = "<h2>Metrics</h2>\n" + text
    if all(value is None for row in rows for value in row[1:]):
        return out + report.lacks("No metric has data: no modality was degraded, and there is no second log with the same motion to compare forces with.")
    return out + report.table("Metrics of each log; forces are compared with those of the first log, and are meaningful only for the same motion of the hand.", ["log", *head], rows)
