"""Perceived colour difference of two images: CIEDE2000 (CIE 142-2001) as in Sharma, Wu and Dalal 2005, whose equations are numbered here, on
arrays; tests/visual_node/golden/colour_difference.h does the same for single pixels."""
import numpy as np

# sRGB to CIE XYZ (IEC 61966-2-1), white D65.
XYZ_OF_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.9505, 1.0, 1.089])
LINEAR = np.array([e / 12.92 if e <= 0.04045 else ((e + 0.055) / 1.055) ** 2.4 for e in np.arange(256) / 255])


def lab_of(rgb):
    """CIE 1976 L*a*b* of sRGB bytes (..., 3)."""
    t = LINEAR[rgb] @ XYZ_OF_RGB.T / WHITE
    f = np.where(t > 216 / 24389, np.cbrt(t), (24389 / 27 * t + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def ciede2000(one, two):
    """CIEDE2000 of two arrays of L*a*b* (..., 3)."""
    seventh = lambda c: np.sqrt(c**7 / (c**7 + 25.0**7))
    cosine = lambda degrees: np.cos(np.radians(degrees))
    mean_chroma = (np.hypot(one[..., 1], one[..., 2]) + np.hypot(two[..., 1], two[..., 2])) / 2  # (3)
    stretch = 1.5 - 0.5 * seventh(mean_chroma)  # 1 + G, (4)
    hue = lambda lab: np.degrees(np.arctan2(lab[..., 2], stretch * lab[..., 1])) % 360  # (7)
    c1, c2 = np.hypot(stretch * one[..., 1], one[..., 2]), np.hypot(stretch * two[..., 1], two[..., 2])  # (6)
    h1, h2 = hue(one), hue(two)
    grey = c1 * c2 == 0
    dh = np.where(grey, 0, (h2 - h1 + 180) % 360 - 180)  # (10)
    far = np.abs(h1 - h2) > 180
    mean_hue = np.where(grey, h1 + h2, (h1 + h2 + np.where(far, np.where(h1 + h2 < 360, 360, -360), 0)) / 2)  # (14)
    dl, dc = two[..., 0] - one[..., 0], c2 - c1  # (8), (9)
    dhh = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(dh / 2))  # (11)
    lightness, chroma = (one[..., 0] + two[..., 0]) / 2, (c1 + c2) / 2  # (12), (13)
    t = (1 - 0.17 * cosine(mean_hue - 30) + 0.24 * cosine(2 * mean_hue) + 0.32 * cosine(3 * mean_hue + 6)
         - 0.20 * cosine(4 * mean_hue - 63))  # (15)
    sl = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)  # (18)
    sc, sh = 1 + 0.045 * chroma, 1 + 0.015 * chroma * t  # (19), (20)
    turned = 30 * np.exp(-(((mean_hue - 275) / 25) ** 2))  # (16)
    rt = -2 * seventh(chroma) * np.sin(np.radians(2 * turned))  # (17), (21)
    x, y, z = dl / sl, dc / sc, dhh / sh
    return np.sqrt(np.maximum(0, x * x + y * y + z * z + rt * y * z))  # (22)
