"""Tests that people with any colour vision distinguish the colours of figures: simulated by Machado, Oliveira and Fernandes 2009 (matrices of severity 1.0,
table 1, on linear RGB), differences by CIEDE2000."""
import itertools
import pathlib
import re
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus import palette
from tactus.rerender import colour

VISION = {
    "normal": np.eye(3),
    "protanopia": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
    "deuteranopia": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]),
    "tritanopia": np.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]])}
LEAST = 8.0  # CIEDE2000; design: several times the just noticeable difference of 1 of neighbouring areas


def seen(code, vision):
    """sRGB, 0 .. 255, of a colour as this vision perceives it."""
    srgb = np.array([int(code[i:i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
    linear = np.clip(VISION[vision] @ linear, 0, 1)
    return np.round(255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)).astype(np.uint8)


def nearest(codes):
    """(difference, vision, first, second) of the two most similar colours."""
    found = []
    for vision in VISION:
        for a, b in itertools.combinations(codes, 2):
            labs = [colour.lab_of(seen(c, vision).reshape(1, 1, 3)) for c in (a, b)]
            found.append((float(np.ravel(colour.ciede2000(*labs))[0]), vision, a, b))
    return min(found)


def strong_colours(svg):
    """The saturated colours of a picture: those of curves, bars and marks, but not of plates, grids and words."""
    codes = {code.lower() for code in re.findall(r"#[0-9a-fA-F]{6}", svg)}
    channels = {code: [int(code[i:i + 2], 16) for i in (1, 3, 5)] for code in codes}
    return sorted(code for code, rgb in channels.items() if max(rgb) - min(rgb) >= 80)


class Palettes(unittest.TestCase):
    def test_every_two_colours_of_a_picture_of_the_documentation_differ_for_any_colour_vision(self):
        pictures = sorted((ROOT / "docs").rglob("*.svg"))
        self.assertGreater(len(pictures), 10)
        for picture in pictures:
            colours = strong_colours(picture.read_text(encoding="utf-8"))
            with self.subTest(str(picture.relative_to(ROOT))):
                self.assertGreater(nearest(colours)[0] if len(colours) > 1 else LEAST + 1, LEAST)

    def test_every_two_colours_of_a_figure_differ_for_any_colour_vision(self):
        for name in ("MODALITY", "PHASE", "SERIES", "BANDS", "LIMIT"):
            colours = getattr(palette, name)
            with self.subTest(name):
                self.assertGreater(nearest(list(colours.values()) if isinstance(colours, dict) else colours)[0], LEAST)

    def test_red_and_green_of_equal_lightness_are_refused_by_this_test(self):
        self.assertLess(nearest(["#c2562b", "#a8871d", "#8a9a3a", "#7d8a1d"])[0], LEAST)

    def test_the_live_page_distinguishes_its_modalities_and_curves_in_every_contrast(self):
        sheet = (ROOT / "scripts" / "live" / "page" / "src" / "page.css").read_text(encoding="utf-8")
        blocks = re.findall(r"(?::root|body\[data-contrast=\w+\]) \{\n(.*?)\}", sheet, re.S)
        self.assertEqual(3, len(blocks))
        for block in blocks:
            values = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", block))
            with self.subTest(block[:40]):
                self.assertGreater(nearest([values[m] for m in ("haptic", "audio", "visual", "thermal", "other")])[0], LEAST)


if __name__ == "__main__":
    unittest.main()
