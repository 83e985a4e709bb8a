"""Pictures of an analysis: spectrum with modes, damping over frequency, recordings beside their re-synthesis."""
from xml.sax.saxutils import escape

import numpy as np

from tactus import palette
from tactus.modal_analysis import analysis as analyses, damping
from tactus.refusal import Refusal

LEFT, RIGHT, RANGE_DB = 64, 20, 90.0
RECORDED, AGAIN, MARK = palette.GREY, palette.BLUE, palette.VERMILLION


class Panel:
    """SVG axes: logarithmic frequency to the right, values upwards."""

    def __init__(self, box, frequencies_Hz, values, is_log=False):
        (self.x0, self.y0, self.wide, self.tall), (self.low_Hz, self.high_Hz), (self.low, self.high) = box, frequencies_Hz, values
        self.is_log = is_log
        self.out = [f'<rect x="{self.x0}" y="{self.y0}" width="{self.wide}" height="{self.tall}" fill="none" stroke="#999"/>']

    def x(self, f):
        return self.x0 + self.wide * np.log(np.asarray(f) / self.low_Hz) / np.log(self.high_Hz / self.low_Hz)

    def y(self, v):
        v = np.clip(v, self.low, self.high)
        share = np.log(v / self.low) / np.log(self.high / self.low) if self.is_log else (v - self.low) / (self.high - self.low)
        return self.y0 + self.tall * (1 - share)

    def grid(self, values, unit, title):
        for value in values:
            self.out.append(f'<line x1="{self.x0}" x2="{self.x0 + self.wide}" y1="{self.y(value):.1f}" y2="{self.y(value):.1f}" stroke="#e4e4e4"/>'
                            f'<text x="{self.x0 - 6}" y="{self.y(value) + 4:.1f}" text-anchor="end" fill="#555">{value:g}</text>')
        ticks = [base * k for base in (10, 100, 1000, 10000) for k in (1, 2, 5) if self.low_Hz <= base * k <= self.high_Hz]
        for f in ticks:
            self.out.append(f'<line x1="{self.x(f):.1f}" x2="{self.x(f):.1f}" y1="{self.y0}" y2="{self.y0 + self.tall}" stroke="#eee"/>'
                            f'<text x="{self.x(f):.1f}" y="{self.y0 + self.tall + 14}" text-anchor="middle" fill="#555">'
                            f'{f"{f // 1000} kHz" if f >= 1000 else f"{f} Hz"}</text>')
        self.out.append(f'<text x="{self.x0 - 40}" y="{self.y0 - 8}" fill="#555">{escape(unit)}</text>'
                        f'<text x="{self.x0 + self.wide}" y="{self.y0 - 8}" text-anchor="end" font-weight="bold">{escape(title)}</text>')

    def line(self, f, v, colour, width=1.0):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(self.x(f), self.y(np.asarray(v))))
        self.out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"/>')

    def circle(self, f, v, colour, filled, radius=3.0):
        self.out.append(f'<circle cx="{self.x(f):.1f}" cy="{self.y(v):.1f}" r="{radius:.1f}" fill="{colour if filled else "none"}" stroke="{colour}"/>')


def spectrum_dB(samples, rate):
    """(frequencies Hz, level dB) of a signal that starts with a blow: the window falls from its start to 0. An undamped amplitude of 1 is 0 dB."""
    window = np.hanning(2 * len(samples) + 1)[len(samples):-1]
    spectrum = np.abs(np.fft.rfft(samples * window, 2 * len(samples))) / (window.sum() / 2)
    return np.fft.rfftfreq(2 * len(samples), 1 / rate), 20 * np.log10(np.maximum(spectrum, 1e-12))


def outlined(f, level, low_Hz, high_Hz, columns=420):
    """The highest point in each of `columns` equal columns of a logarithmic axis."""
    edges = np.geomspace(low_Hz, high_Hz, columns + 1)
    at = np.searchsorted(f, edges)
    centres, tops = [], []
    for i in range(columns):
        if at[i + 1] > at[i]:
            best = at[i] + int(np.argmax(level[at[i]:at[i + 1]]))
            centres.append(max(f[best], low_Hz))
            tops.append(level[best])
    return np.array(centres), np.array(tops)


def compared(a):
    """The analysed samples and their re-synthesis, of equal length."""
    count = min(len(a.samples) - a.begins, int(1.5 * a.rate))
    return a.samples[a.begins:a.begins + count], analyses.resynthesis(a, count)


def range_of(a):
    return max(20.0, 0.6 * a.modes[0].frequency_Hz), min(0.5 * a.rate, 1.25 * a.modes[-1].frequency_Hz)


def spectrum_panel(box, a, title, is_marked):
    """Spectra of recording and re-synthesis, or a circle on each mode, filled if both methods agree."""
    original, again = compared(a)
    low_Hz, high_Hz = range_of(a)
    f, level = spectrum_dB(original, a.rate)
    top = 10 * np.ceil(level.max() / 10)
    panel = Panel(box, (low_Hz, high_Hz), (top - RANGE_DB, top))
    panel.grid(np.arange(top - RANGE_DB, top + 1, 30), "dB", title)
    panel.line(*outlined(f, level, low_Hz, high_Hz), RECORDED)
    if is_marked:
        for m in a.modes:
            panel.circle(m.damped_Hz, level[int(round(m.damped_Hz / f[1]))], MARK, m.agrees)
    else:
        panel.line(*outlined(f, spectrum_dB(again, a.rate)[1], low_Hz, high_Hz), AGAIN)
    return panel.out


def damping_panel(box, a):
    low_Hz, high_Hz = range_of(a)
    d = np.array([m.damping_1_s for m in a.modes])
    panel = Panel(box, (low_Hz, high_Hz), (10 ** np.floor(np.log10(d.min() / 1.5)), 10 ** np.ceil(np.log10(d.max() * 1.5))), is_log=True)
    decades = 10.0 ** np.arange(np.log10(panel.low), np.log10(panel.high) + 0.5)
    law = a.law
    panel.grid(decades, "damping, 1/s", f'alpha {law["rayleigh_alpha_1_s"]:.3g} 1/s, beta {law["rayleigh_beta_s"]:.3g} s (line); '
               f'loss factor {law["loss_factor"]:.3g} (dashed); {"the line" if law["better"] == "rayleigh" else "the dashed line"} fits better')
    strongest = max(m.amplitude for m in a.modes)
    for m in a.modes:
        panel.circle(m.frequency_Hz, m.damping_1_s, MARK, m.agrees, 2 + 4 * max(0.0, 1 + np.log10(m.amplitude / strongest) / 3))
    f = np.geomspace(low_Hz, high_Hz, 80)
    for curve, colour in ((damping.rayleigh(f, law["rayleigh_alpha_1_s"], law["rayleigh_beta_s"]), AGAIN),
                          (damping.constant_loss(f, law["loss_factor"]), f'{palette.GREEN}" stroke-dasharray="5 4')):
        inside = (curve >= panel.low) & (curve <= panel.high)
        panel.line(f[inside], curve[inside], colour, 1.5)
    return panel.out


def write(path, width, height, parts):
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="11">'
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join([head, '<rect width="100%" height="100%" fill="white"/>', *parts, "</svg>"]) + "\n")
    except OSError as e:
        raise Refusal(f"{path} cannot be written: {e.strerror}; give another file") from e


def draw_analysis(path, a, title):
    wide = 780
    parts = spectrum_panel((LEFT, 50, wide, 260), a, "spectrum; circles: modes, filled where ESPRIT and decay agree", True)
    parts += damping_panel((LEFT, 360, wide, 220), a)
    parts.append(f'<text x="{LEFT}" y="20" font-size="14" font-weight="bold">{escape(title)}</text>')
    write(path, LEFT + wide + RIGHT, 620, parts)


def draw_comparison(path, analysed):
    """analysed: [(title, Analysis)]; each row shows the recording with its modes on the left and the re-synthesis on the right."""
    wide, tall, gap = 400, 180, 70
    parts = []
    for i, (title, a) in enumerate(analysed):
        top = 50 + i * (tall + gap)
        original, again = compared(a)
        rest_dB = 10 * np.log10(((original - again) ** 2).sum() / (original ** 2).sum())
        parts += spectrum_panel((LEFT, top, wide, tall), a, "recording, modes marked", True)
        low_Hz, high_Hz = range_of(a)
        f, level = spectrum_dB(original, a.rate)
        f_again, level_again = spectrum_dB(again, a.rate)
        highest = 10 * np.ceil(level.max() / 10)
        panel = Panel((2 * LEFT + wide, top, wide, tall), (low_Hz, high_Hz), (highest - RANGE_DB, highest))
        panel.grid(np.arange(highest - RANGE_DB, highest + 1, 30), "dB", f"re-synthesis from {len(a.modes)} modes; residual: {rest_dB:.1f} dB")
        panel.line(*outlined(f_again, level_again, low_Hz, high_Hz), AGAIN)
        parts += panel.out
        parts.append(f'<text x="{LEFT}" y="{top - 22}" font-size="13" font-weight="bold">{escape(title)}</text>')
    write(path, 2 * (LEFT + wide) + RIGHT, 50 + len(analysed) * (tall + gap), parts)
