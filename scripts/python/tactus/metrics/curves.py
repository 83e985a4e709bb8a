"""Prints and draws packets against quality for the kinaesthetic codec, from a log: deadbands of k = 0 to 0.4, with hold and linear prediction.

haptic_node renders the log again under each profile (stage "force", as tactus rerender does), and its forces are compared with those of k = 0. The motion of
the hand is that of the log, so the energy is that of an open loop. --delay adds a delay to all, and --passivity tdpa its controller.
"""
import argparse
import json
import math
import os
import re
import sys
import tempfile

from tactus import palette
from tactus.metrics import codec, of_run
from tactus.option_parser import OptionParser
from tactus.paths import BIN
from tactus.refusal import Refusal, sentence_of
from tactus.rerender import render

COLUMNS = ("force_rmse_N", "force_jnd_share", "force_hssim_like", "force_time_ms", "force_value_N", "injected_J")
COLOUR = {"hold": palette.BLUE, "linear": palette.VERMILLION}
MARK = {"hold": "o", "linear": "s"}
TICKS = (1, 3, 10, 30, 100, 300, 1000, 3000)
PANELS = (("force_rmse_N", "RMS error, N"), ("force_jnd_share", "share outside 10 %"), ("force_hssim_like", "HSSIM-like"))


def rendered(options, folder, name, band, delay_ms):
    """(packets per second or None, folder of the tables) of one rendering. band: value of the attribute deadband, or None."""
    out = os.path.join(folder, name)
    os.makedirs(out)
    words = f'{f"deadband={chr(34)}{band}{chr(34)} " if band else ""}delay="{delay_ms:g}ms" passivity="{options.passivity}"'
    profile = os.path.join(out, "profile.xml")
    with open(profile, "w", encoding="utf-8") as file:
        file.write(f'<profile name="{name}"><degrade modality="haptic" stage="force" {words}/></profile>\n')
    lines = render.render(render.command(str(BIN), "haptic", options.log, out, profile, options.tool, {}), lambda _: None)
    sent = next((m for m in (re.search(r"(\d+) of (\d+) sent", line) for line in reversed(lines)) if m), None)
    return (int(sent.group(1)) / int(sent.group(2)) if sent else 1.0), out


def measure(options, folder):
    rows = []
    _, reference = rendered(options, folder, "reference", None, 0)
    times = of_run.tool_rows(reference).get("time_s", ())
    if len(times) < 2 or times.max() <= times.min():
        raise Refusal(f"{options.log} has no ticks of this hand; give the log of a run with touch, or another --tool")
    rate_hz = (len(times) - 1) / (times.max() - times.min())
    for predictor in codec.PREDICTORS:
        for k in options.bands:
            share, out = rendered(options, folder, f"{predictor}_{k:g}", f"{100 * k:g}% force predict={predictor} floor={options.floor:g}N", options.delay)
            found = of_run.metrics(out, reference)
            rows.append({"predictor": predictor, "k": k, "packets_per_s": share * rate_hz, "share_sent": share, **{name: found.get(name) for name in COLUMNS}})
    return rows


def show(rows):
    print(f"{'predictor':10} {'k':>5} {'packets/s':>10} {'sent, %':>8} " + " ".join(f"{name:>16}" for name in COLUMNS))
    for row in rows:
        print(f"{row['predictor']:10} {row['k']:5.2f} {row['packets_per_s']:10.1f} {100 * row['share_sent']:8.2f} " +
              " ".join(f"{'-' if row[name] is None else format(row[name], '.4g'):>16}" for name in COLUMNS))


def draw(rows, path):
    from tactus.plotting import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.hashsalt": "tactus", "font.family": "DejaVu Sans", "font.size": 8.5, "legend.frameon": False, "axes.spines.top": False,
                                "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.4})
    import matplotlib.pyplot as plt
    fig, axes = plt.subplots(1, len(PANELS), figsize=(7.2, 2.5), layout="constrained")
    for panel, (name, label) in zip(axes, PANELS):
        for predictor, colour in COLOUR.items():
            mine = [row for row in rows if row["predictor"] == predictor and row[name] is not None]
            panel.plot([row["packets_per_s"] for row in mine], [row[name] for row in mine], color=colour, marker=MARK[predictor], markersize=3.5, label=predictor)
            for row in mine[1::2]:
                panel.annotate(f"{row['k']:g}", (row["packets_per_s"], row[name]), fontsize=6.5, color=colour, xytext=(3, 3), textcoords="offset points")
        panel.set(xscale="log", xlabel="packets per second", ylabel=label)
        panel.set_xticks([n for n in TICKS if panel.get_xlim()[0] <= n <= panel.get_xlim()[1]])
        panel.xaxis.set_major_formatter("{x:g}")
        panel.xaxis.set_minor_formatter("")
    axes[0].legend(title="prediction; numbers: k", title_fontsize=7)
    fig.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)


def arguments(words):
    parser = OptionParser(prog="tactus --module tactus.metrics.curves", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", help="run.lcmlog of a run with touch, or its folder")
    parser.add_argument("picture", nargs="?", help="SVG or PNG to write (default: none)")
    parser.add_argument("--bands", default="0,0.02,0.05,0.1,0.15,0.2,0.3,0.4", metavar="K,...", help="values of k (default: %(default)s)")
    parser.add_argument("--floor", type=float, default=0.0, metavar="N", help="smallest width of the band, N (default: 0)")
    parser.add_argument("--delay", type=float, default=0.0, metavar="MS", help="delay of the force, ms (default: 0)")
    parser.add_argument("--passivity", choices=("none", "tdpa"), default="none")
    parser.add_argument("--tool", help="name of the tool (default: the first of the scene)")
    parser.add_argument("--json", metavar="FILE", help="also write the rows to FILE")
    options = parser.parse_args(words)
    try:
        options.bands = [float(word) for word in options.bands.split(",")]
    except ValueError:
        options.bands = [math.nan]
    if not all(0 <= k < 1 for k in options.bands):
        parser.error("--bands: give shares from 0 to less than 1 separated by commas, for example 0,0.1,0.2")
    if not (0 <= options.floor <= 100 and 0 <= options.delay <= 1000):
        parser.error("--floor and --delay: give 0 to 100 N and 0 to 1000 ms")
    if options.picture and not options.picture.endswith((".svg", ".png")):
        parser.error(f"{options.picture}: give a file that ends with .svg or .png")
    if not os.path.exists(options.log):
        raise Refusal(f"{options.log} does not exist; give the run.lcmlog of a run, or its folder")
    return options


def main(words):
    try:
        options = arguments(words)
        with tempfile.TemporaryDirectory() as folder:
            rows = measure(options, folder)
        show(rows)
        if options.picture:
            draw(rows, options.picture)
        if options.json:
            with open(options.json, "w", encoding="utf-8") as file:
                json.dump({"log": os.path.abspath(options.log), "delay_ms": options.delay, "passivity": options.passivity, "rows": rows}, file, indent=1)
    except (Refusal, render.Refused) as refused:
        sys.exit(f"curves: {refused}")
    except OSError as error:
        sys.exit(f"curves: {sentence_of(error)}")
    return 0
