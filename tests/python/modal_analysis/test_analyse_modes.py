"""tactus analyse-modes finds the modes of synthetic sounds, and refuses invalid recordings with one sentence."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree as etree

import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.modal_analysis import analysis, damping, decay, esprit

RATE = 44100
BELOW_HZ = 8000  # above the highest of the modes; half the bands, half the time
# A pair 3 Hz apart, which 136 ms of sound are too short to show as a beat, and four alone.
FREQUENCY_HZ = np.array([440.0, 443.0, 1213.0, 2376.0, 3930.0, 6100.0])
DAMPING_1_S = np.array([8.0, 9.0, 15.0, 20.0, 30.0, 45.0])
AMPLITUDE = np.array([1.0, 0.8, 0.6, 0.7, 0.4, 0.5])
ALONE = slice(2, None)


def ringing(count, snr_dB=None, seed=0, frequency_Hz=FREQUENCY_HZ, damping_1_s=DAMPING_1_S, amplitude=AMPLITUDE):
    """Damped sines, and white noise at a given distance below their mean power."""
    t = np.arange(count)[:, None] / RATE
    x = (amplitude * np.exp(-damping_1_s * t) * np.cos(2 * np.pi * frequency_Hz * t + np.arange(len(amplitude)))).sum(axis=1)
    if snr_dB is not None:
        x = x + np.random.default_rng(seed).standard_normal(count) * np.sqrt(np.mean(x ** 2)) * 10 ** (-snr_dB / 20)
    return x


def errors(found, frequency_Hz=FREQUENCY_HZ, damping_1_s=DAMPING_1_S):
    """Errors of the nearest found mode to each: Hz, and share of the damping."""
    distance = np.abs(found[:, 0] - frequency_Hz[:, None]) + 0.1 * np.abs(found[:, 1] - damping_1_s[:, None])
    nearest = found[np.argmin(distance, axis=1)]
    return np.abs(nearest[:, 0] - frequency_Hz), np.abs(nearest[:, 1] / damping_1_s - 1)


class Esprit(unittest.TestCase):
    # Bounds: results of a full-band ESPRIT of 512 rows in C++ on the same modes and length (design).
    def errors_at(self, snr_dB):
        of = [errors(esprit.find_poles(ringing(6000, snr_dB, seed), RATE, BELOW_HZ)) for seed in range(3)]
        return np.max([e[0] for e in of], axis=0), np.max([e[1] for e in of], axis=0)

    def test_finds_six_modes_at_60_dB(self):
        hertz, share = self.errors_at(60)
        self.assertLess(hertz.max(), 0.01)
        self.assertLess(share.max(), 0.006)

    def test_finds_six_modes_at_40_dB(self):
        hertz, share = self.errors_at(40)
        self.assertLess(hertz.max(), 0.07)
        self.assertLess(share.max(), 0.03)

    def test_finds_six_modes_at_20_dB_the_close_pair_with_poor_dampings(self):
        hertz, share = self.errors_at(20)
        self.assertLess(hertz.max(), 0.3)
        self.assertLess(share[ALONE].max(), 0.025)
        self.assertLess(share.max(), 0.67)  # 9 -> 15 1/s

    def test_is_exact_without_noise_wherever_a_mode_lies_in_its_band(self):
        # Also at the common edge of two bands, and only once there. 1e-4: the filter passes 10^-4.5 of its stop band.
        frequency = np.array([999.5, 1700.0, 2000.0, 3003.0])
        found = esprit.find_poles(ringing(6000, None, 0, frequency, DAMPING_1_S[:4], AMPLITUDE[:4]), RATE, 8000)
        hertz, share = errors(found, frequency, DAMPING_1_S[:4])
        self.assertLess(hertz.max(), 1e-3)
        self.assertLess(share.max(), 1e-3)
        for f in frequency:
            self.assertEqual(np.sum(np.abs(found[:, 0] - f) < 0.5), 1)


class Analysis(unittest.TestCase):
    def test_finds_exactly_the_six_modes_at_any_level_of_noise(self):
        for snr_dB in (None, 60, 40, 20):
            with self.subTest(snr_dB=snr_dB):
                modes = analysis.analyse(ringing(RATE // 2, snr_dB), RATE, below_Hz=BELOW_HZ).modes
                self.assertEqual(len(modes), 6)
                np.testing.assert_allclose([m.amplitude for m in modes], AMPLITUDE, rtol=0.05)

    def test_both_methods_agree_on_isolated_modes_and_not_on_a_beating_pair(self):
        modes = analysis.analyse(ringing(RATE // 2, 60), RATE, below_Hz=BELOW_HZ).modes
        self.assertEqual([m.agrees for m in modes][ALONE], [True] * 4)
        self.assertFalse(all(m.agrees for m in modes[:2]))

    def test_decay_finds_frequency_and_damping_of_isolated_modes(self):
        peaks = decay.find_peaks(ringing(RATE // 2, 60), RATE, 8000)
        hertz, share = errors(peaks[:, :2])
        self.assertLess(hertz[ALONE].max(), 0.1)  # a parabola through bins of 2.9 Hz errs by 0.02 of them
        self.assertLess(share[ALONE].max(), 0.02)

    def test_leaves_out_modes_60_dB_below_the_strongest(self):
        amplitude = np.array([1.0, 2e-3, 5e-4])
        modes = analysis.analyse(ringing(RATE // 2, None, 0, np.array([500.0, 1500.0, 2500.0]), np.array([10.0, 10.0, 10.0]), amplitude),
                                 RATE, below_Hz=BELOW_HZ).modes
        np.testing.assert_allclose([m.frequency_Hz for m in modes], [500.0, 1500.0], atol=0.01)

    def test_a_growing_sine_is_no_mode(self):
        x = ringing(RATE // 4, 80, 0, np.array([500.0, 1500.0]), np.array([10.0, -4.0]), np.array([1.0, 0.3]))
        modes = analysis.analyse(np.concatenate([np.zeros(2000), x]), RATE, below_Hz=BELOW_HZ).modes
        np.testing.assert_allclose([m.frequency_Hz for m in modes], [500.0], atol=0.01)

    def test_begins_after_the_blow_and_gives_the_amplitude_at_the_onset(self):
        silence, blow = np.zeros(RATE // 5), 3 * np.random.default_rng(2).standard_normal(88)  # 2 ms
        x = ringing(RATE // 2, 60)
        x[:88] += blow
        modes = analysis.analyse(np.concatenate([silence, x]), RATE, below_Hz=BELOW_HZ).modes
        self.assertEqual(len(modes), 6)
        # The onset is found within 2 ms: 2 ms * 45 1/s = 9 %.
        np.testing.assert_allclose([m.amplitude for m in modes], AMPLITUDE, rtol=0.12)

    def test_the_resynthesis_equals_the_analysed_sound(self):
        a = analysis.analyse(ringing(RATE // 2), RATE, below_Hz=BELOW_HZ)
        again = analysis.resynthesis(a, RATE // 4)
        original = a.samples[a.begins:a.begins + RATE // 4]
        self.assertLess(((again - original) ** 2).sum(), 1e-6 * (original ** 2).sum())


class Damping(unittest.TestCase):
    frequency = np.geomspace(200, 9000, 12)
    amplitude = np.geomspace(1, 0.05, 12)

    def test_rayleigh_damping_is_recovered(self):
        law = damping.fit(self.frequency, damping.rayleigh(self.frequency, 6, 1e-7), self.amplitude)
        self.assertAlmostEqual(law["rayleigh_alpha_1_s"], 6, delta=1e-6)
        self.assertAlmostEqual(law["rayleigh_beta_s"], 1e-7, delta=1e-13)
        self.assertEqual(law["better"], "rayleigh")

    def test_a_loss_factor_is_recovered(self):
        law = damping.fit(self.frequency, damping.constant_loss(self.frequency, 0.004), self.amplitude)
        self.assertAlmostEqual(law["loss_factor"], 0.004, delta=1e-9)
        self.assertEqual(law["better"], "loss factor")

    def test_damping_that_falls_with_frequency_gives_no_negative_beta(self):
        law = damping.fit(self.frequency, 20 - self.frequency / 1000, self.amplitude)
        self.assertGreaterEqual(law["rayleigh_beta_s"], 0)
        self.assertGreater(law["rayleigh_alpha_1_s"], 0)

    def test_is_found_in_a_sound(self):
        f = np.array([300.0, 830.0, 1620.0, 2680.0, 4000.0, 5600.0])
        x = ringing(RATE // 2, 50, 1, f, damping.rayleigh(f, 12, 4e-8), AMPLITUDE)
        law = analysis.analyse(x, RATE, below_Hz=BELOW_HZ).law
        # Dampings have an error of 1 % at 50 dB, and alpha depends on the lowest mode.
        self.assertAlmostEqual(law["rayleigh_alpha_1_s"], 12, delta=0.24)
        self.assertAlmostEqual(law["rayleigh_beta_s"], 4e-8, delta=1.2e-9)


def wav(samples, bits=16, kind=1, channels=1, rate=RATE):
    if kind == 3:
        body = samples.astype(f"<f{bits // 8}").tobytes()
    elif bits == 24:
        whole = np.round(samples * (2 ** 23 - 1)).astype("<i4")
        body = b"".join(int(v & 0xFFFFFF).to_bytes(3, "little") for v in whole.ravel())
    else:
        body = np.round(samples * (2 ** (bits - 1) - 1)).astype(f"<i{bits // 8}").tobytes()
    size = channels * bits // 8
    form = b"".join(v.to_bytes(n, "little") for v, n in ((kind, 2), (channels, 2), (rate, 4), (rate * size, 4), (size, 2), (bits, 2)))
    chunks = b"WAVEfmt " + len(form).to_bytes(4, "little") + form + b"data" + len(body).to_bytes(4, "little") + body
    return b"RIFF" + len(chunks).to_bytes(4, "little") + chunks


class TheProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name, content=None):
        path = os.path.join(self.folder, name)
        if content is not None:
            with open(path, "wb") as file:
                file.write(content)
        return path

    def run_it(self, *words):
        return subprocess.run([SCRIPTS / "tactus", "analyse-modes", *words, "--max-frequency", str(BELOW_HZ)], capture_output=True, text=True, timeout=120)

    def refused(self, *words):
        done = self.run_it(*words)
        self.assertEqual(done.returncode, 1, done.stderr)
        lines = done.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("analyse-modes: "), lines[0])
        return lines[0]

    def test_refuses_invalid_recordings(self):
        cases = {"empty.wav": b"", "text.wav": b"This is not a sound.\n" * 40, "silence.wav": wav(np.zeros(RATE)),
                 "nan.wav": wav(np.where(np.arange(RATE) == 99, np.nan, 0.1), 32, 3), "short.wav": wav(0.5 * np.ones(50)),
                 "cut.wav": wav(ringing(RATE) / 4)[:30], "header.wav": b"RIFF\xff\xff\xff\xffWAVE",
                 "noise.wav": wav(0.1 * np.random.default_rng(0).standard_normal(RATE // 2)),
                 "bits.wav": wav(ringing(RATE) / 4).replace((16).to_bytes(2, "little") + b"data", (12).to_bytes(2, "little") + b"data")}
        for name, content in cases.items():
            with self.subTest(name):
                self.assertIn(name, self.refused(self.path(name, content)))
        self.assertIn("nowhere.wav", self.refused(self.path("nowhere.wav")))

    def test_refuses_samples_whose_squares_are_no_numbers(self):
        for name, size in (("loud.wav", 1e200), ("faint.wav", 1e-200)):
            with self.subTest(name):
                self.assertIn(name, self.refused(self.path(name, wav(size * ringing(RATE), 64, 3))))

    def test_any_name_of_a_recording_is_shown_in_its_picture(self):
        for name in (b"gl\xffass", b"a\nb\x01", "<鐘> & $\\frac{".encode()):
            picture = self.path("picture.svg")
            with self.subTest(name):
                done = self.run_it(self.path(os.fsdecode(name + b".wav"), wav(ringing(RATE // 2) / 4)), "--picture", picture)
                self.assertEqual((0, ""), (done.returncode, done.stderr))
                etree.parse(picture)
        self.assertIn("must be UTF-8", self.refused(self.path("good.wav", wav(ringing(RATE // 2) / 4)), "--material", "bell", "--base", "copper",
                                                    "--out", self.path(os.fsdecode(b"\xff.xml"))))

    def test_an_output_never_replaces_the_recording(self):
        sound = self.path("bell.wav", wav(ringing(RATE // 2) / 4))
        size = os.path.getsize(sound)
        self.assertIn("is the input itself", self.refused(sound, "--picture", sound))
        self.assertIn("is the input itself", self.refused(sound, "--json", sound))
        self.assertEqual(size, os.path.getsize(sound))

    def test_refuses_contradictory_options(self):
        good = self.path("good.wav", wav(ringing(RATE // 2) / 4))
        self.refused()
        self.refused(good, "--modes", "0")
        self.refused(good, "--out", "modes.txt")
        self.refused("--compare", good)
        self.assertIn("--base", self.refused(good, "--out", self.path("new.xml"), "--material", "my bell"))
        self.assertIn("butter", self.refused(good, "--out", self.path("new.xml"), "--material", "bell", "--base", "butter"))
        self.refused(good, "--json", os.path.join(self.folder, "no", "such.json"))

    def test_refuses_modes_above_the_limit_of_a_scene(self):
        done = subprocess.run([SCRIPTS / "tactus", "analyse-modes", "x.wav", "--max-frequency", "20001"], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("20000 Hz", done.stderr)

    def test_reads_mono_and_stereo_of_16_24_and_32_bits_alike(self):
        x = ringing(RATE // 3) / 4
        both = np.stack([x, x], axis=1)
        cases = {"16": wav(x), "24": wav(x, 24), "float": wav(x, 32, 3), "stereo": wav(both, 16, 1, 2),
                 "against each other": wav(np.stack([x, -x], axis=1), 24, 1, 2)}
        for name, content in cases.items():
            with self.subTest(name):
                table = self.path("modes.csv")
                done = self.run_it(self.path("sound.wav", content), "--out", table)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(table, newline="", encoding="utf-8") as file:
                    rows = list(csv.DictReader(file))
                np.testing.assert_allclose([float(r["frequency_Hz"]) for r in rows], FREQUENCY_HZ, atol=0.05)

    @unittest.skipUnless(shutil.which("ffmpeg"), "needs ffmpeg")
    def test_reads_flac(self):
        flac = self.path("sound.flac")
        subprocess.run(["ffmpeg", "-v", "error", "-i", self.path("sound.wav", wav(ringing(RATE // 3) / 4)), flac], check=True)
        self.assertEqual(self.run_it(flac).returncode, 0)

    def test_writes_a_material_with_its_table_of_modes_a_picture_and_json(self):
        sound, xml, svg, text = (self.path(n) for n in ("bell.wav", "bell.xml", "bell.svg", "bell.json"))
        self.path("bell.wav", wav(ringing(RATE // 2) / 4))
        done = self.run_it(sound, "--out", xml, "--base", "copper", "--picture", svg, "--json", text)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(xml, encoding="utf-8") as file:
            self.assertRegex(file.read(), r'^<tactus:material name="bell" base="copper" rayleigh_alpha="[\d.]+" '
                                          r'rayleigh_beta="[\d.e-]+" modes="bell.modes.csv"/>$')
        with open(self.path("bell.modes.csv"), encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 6)
        with open(svg, encoding="utf-8") as file:
            self.assertEqual(file.read().count("<circle"), 12)  # each mode in both panels
        with open(text, encoding="utf-8") as file:
            self.assertEqual(len(json.load(file)["modes"]), 6)


if __name__ == "__main__":
    unittest.main()
