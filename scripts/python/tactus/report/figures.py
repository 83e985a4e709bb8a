"""Style and output of figures: SVG in the page, PNG and SVG in a folder, reproducible to the byte."""
import base64
import os

from tactus import palette, terminal
from tactus.plotting import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "svg.hashsalt": "tactus", "svg.fonttype": "path", "font.family": "DejaVu Sans", "font.size": 8.5, "axes.titlesize": 9, "axes.titlelocation": "left",
    "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.7, "axes.grid": True, "grid.linewidth": 0.4, "grid.color": "#dddddd",
    "axes.axisbelow": True, "lines.linewidth": 1.1, "legend.frameon": False, "legend.fontsize": 8, "figure.dpi": 100, "savefig.bbox": "tight",
    "savefig.pad_inches": 0.05, "path.simplify_threshold": 0.3})
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

WIDTH_IN = 7.2
COLOUR = palette.MODALITY
PHASE_COLOUR = palette.PHASE
OF_LOG = palette.SERIES  # several logs in one figure; the first has the colours of the modalities
DASHES = ("-", ":", "--", "-.")
NAME = {"haptic": "touch (hit)", "haptic_push": "touch (push)", "audio": "sound", "visual": "vision", "thermal": "warmth"}


def new(rows=1, columns=1, height_in=2.6, **more):
    return plt.subplots(rows, columns, figsize=(WIDTH_IN, height_in), layout="constrained", **more)


def cdf(axes, values, **style):
    """Empirical distribution function: a step up of 1/n at each value."""
    x = np.sort(values)
    axes.step(np.concatenate([[x[0]], x]), np.concatenate([[0], np.arange(1, len(x) + 1) / len(x)]), where="post", **style)


def envelope(x, y, most=1500):
    """A curve reduced to about `most` points: minimum and maximum of each section, so that peaks remain."""
    if len(x) <= most:
        return x, y
    pieces = np.array_split(np.arange(len(x)), most // 2)
    keep = np.array(sorted({int(i) for piece in pieces for i in (piece[np.argmin(y[piece])], piece[np.argmax(y[piece])])}))
    return x[keep], y[keep]


def stretches(x, lists, most=1500):
    """Means of several curves in `most` common sections of x, for a band between them."""
    if len(x) <= most:
        return x, lists
    pieces = np.array_split(np.arange(len(x)), most)
    return np.array([x[p].mean() for p in pieces]), [np.array([y[p].mean() for p in pieces]) for y in lists]


def name_logs(fig, names, line=False):
    """Adds a legend with the names of the logs above a figure."""
    if len(names) > 1:
        marks = [plt.Line2D([], [], color="#444444" if line or i == 0 else OF_LOG[i % len(OF_LOG)], linestyle=DASHES[i % len(DASHES)] if line else "-",
                            linewidth=3 if i == 0 and not line else 1.2) for i in range(len(names))]
        fig.legend(marks, names, loc="lower right", bbox_to_anchor=(1, 1), ncols=len(names))


class Gallery:
    """Numbers figures and writes them: `folder`/NAME.svg and .png."""

    def __init__(self, folder):
        self.folder = folder
        self.count = 0
        os.makedirs(folder, exist_ok=True)

    def keep(self, figure, name, caption):
        """HTML of a numbered figure; caption: HTML."""
        self.count += 1
        path = os.path.join(self.folder, name)
        for text in figure.findobj(plt.Text):  # names of others, which no font shows
            text.set_text(terminal.printable(text.get_text()))
        figure.savefig(path + ".svg", metadata={"Date": None, "Creator": "Tactus"})
        figure.savefig(path + ".png", dpi=200, metadata={"Software": "Tactus"})
        plt.close(figure)
        with open(path + ".svg", "rb") as file:
            data = base64.b64encode(file.read()).decode()
        return (f'<figure id="{name}"><img alt="{name.replace("_", " ")}" src="data:image/svg+xml;base64,{data}">'
                f"<figcaption><b>Figure {self.count}.</b> {caption}</figcaption></figure>\n")
