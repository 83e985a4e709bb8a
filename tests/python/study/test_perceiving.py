"""A simulated participant perceives the presented signals and not the reports."""
import base64
import collections
import io
import pathlib
import sys
import tempfile
import types
import unittest

import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.log import marker
from tactus.study import flash_detector, simulated, sound_detector, vibration_detector

EVENT = 5589537784101601287
FRAME_NS = 16_666_667


def lead_of(**kept):
    """A TrialRunnerClient that has received all its messages."""
    return types.SimpleNamespace(wait_for=lambda condition, _: bool(condition()), pulses=collections.deque(), pictures=collections.deque(), media={}, **kept)


def row(number, event):
    """Cells of the marker, as in visual_node/frame/marker.h."""
    data = number.to_bytes(3, "big") + (event & 0xFFFFFFFF).to_bytes(4, "big")
    bits = np.unpackbits(np.frombuffer(data + bytes([marker._crc8(data)]), np.uint8))
    return np.concatenate([[1, 0, 1, 0], bits])


def picture(number, events=(), width=320, height=240, seed=0):
    """Luma of a picture with content and the marker at its lower edge."""
    luma = np.random.default_rng(seed).integers(60, 120, (height, width)).astype(np.uint8)
    for k, event in enumerate(events or (0,)):
        luma[height - 4 * (k + 1):height - 4 * k, :4 * 68] = np.repeat(255 * row(number, event), 4)
    return luma


def jpeg(luma):
    file = io.BytesIO()
    Image.fromarray(luma).convert("RGB").save(file, "JPEG", quality=75)
    return base64.b64encode(file.getvalue()).decode()


class TheEye(unittest.TestCase):
    def stream(self, first_frame, shows_from, count=12):
        return [(k * FRAME_NS, jpeg(picture((first_frame + k) % flash_detector.FRAMES, (EVENT, 8) if k >= shows_from else (8,), seed=k))) for k in range(count)]

    def seen_ns(self, pictures, expected_ns):
        runner = lead_of()
        runner.pictures.extend(pictures)
        return flash_detector.FlashDetector(runner).onset_ns(EVENT, expected_ns)

    def test_a_hit_is_seen_in_the_first_frame_that_shows_it_regardless_of_reports(self):
        for shows_from in (3, 4, 5):
            self.assertEqual(shows_from * FRAME_NS, self.seen_ns(self.stream(900, shows_from), 4 * FRAME_NS))

    def test_frame_numbers_repeat_after_24_bits(self):
        self.assertEqual(4 * FRAME_NS, self.seen_ns(self.stream(flash_detector.FRAMES - 4, 4), 4 * FRAME_NS))

    def test_without_the_preceding_frame_the_onset_is_unknown(self):
        pictures = self.stream(900, 4)
        del pictures[3]
        self.assertIsNone(self.seen_ns(pictures, 4 * FRAME_NS))

    def test_an_event_in_no_frame_and_an_invalid_picture_are_not_seen(self):
        self.assertIsNone(self.seen_ns(self.stream(900, 99), 4 * FRAME_NS))
        self.assertIsNone(self.seen_ns([(at_ns, "/9j/nonsense") for at_ns, _ in self.stream(900, 4)], 4 * FRAME_NS))
        self.assertIsNone(self.seen_ns([], 4 * FRAME_NS))


class TheSkin(unittest.TestCase):
    def test_the_tick_nearest_to_the_expected_one_is_felt(self):
        runner = lead_of()
        runner.pulses.extend([(0, 0.3), (96_000_000, 0.4), (140_000_000, 0.2)])
        self.assertEqual(96_000_000, vibration_detector.VibrationDetector(runner).onset_ns(100_000_000))
        self.assertIsNone(vibration_detector.VibrationDetector(runner).onset_ns(50_000_000))


class TheEar(unittest.TestCase):
    RATE = 48000

    def heard_ns(self, onset, expected_ns, at_ns=1_000_000_000, name="audio.wav"):
        samples = np.zeros(self.RATE, "<f4")
        if onset is not None:
            samples[onset:onset + 2000] = 0.2 * np.sin(0.5 + 0.2 * np.arange(2000)) * np.exp(-np.arange(2000) / 400)
        stereo = np.repeat(samples, 2).tobytes()
        form = (3).to_bytes(2, "little") + (2).to_bytes(2, "little") + self.RATE.to_bytes(4, "little") + (8 * self.RATE).to_bytes(4, "little") + bytes([8, 0, 32, 0])
        with tempfile.TemporaryDirectory() as folder:
            body = b"fmt " + len(form).to_bytes(4, "little") + form + b"data" + len(stereo).to_bytes(4, "little") + stereo
            (pathlib.Path(folder) / name).write_bytes(b"RIFF" + (4 + len(body)).to_bytes(4, "little") + b"WAVE" + body)
            runner = lead_of()
            runner.media["audio.wav"] = collections.deque([(0, at_ns - 9_000_000_000)])
            runner.media[name] = collections.deque([(0, at_ns)])
            return sound_detector.SoundDetector(folder, runner).onset_ns(expected_ns)

    def test_a_hit_is_heard_at_its_first_sample_regardless_of_reports(self):
        for report_ns in (-15_000_000, 0, 12_000_000):
            heard_ns = self.heard_ns(24000, 1_500_000_000 + report_ns)
            self.assertAlmostEqual(1_500_000_000, heard_ns, delta=1e9 / self.RATE)

    def test_after_a_restart_the_newer_file_is_used(self):
        self.assertAlmostEqual(1_500_000_000, self.heard_ns(24000, 1_500_000_000, name="audio.2.wav"), delta=1e9 / self.RATE)

    def test_silence_is_not_heard(self):
        self.assertIsNone(self.heard_ns(None, 1_500_000_000))


class AParticipant(unittest.TestCase):
    def test_perceived_asynchrony_is_returned_and_a_missing_percept_is_named(self):
        study = types.SimpleNamespace()
        runner = lead_of()
        runner.pulses.append((30_000_000, 0.4))
        runner.pictures.extend((k * FRAME_NS, jpeg(picture(900 + k, (EVENT,) if k >= 4 else ()))) for k in range(12))
        with tempfile.TemporaryDirectory() as folder:
            participant = simulated.Participant(study, "P01", 1, folder, runner)
            observed = types.SimpleNamespace(event=str(EVENT), times_ns={"haptic": 32_000_000, "visual": 70_000_000})
            self.assertEqual((4 * FRAME_NS * 1e-6 - 30, ""), participant.perceived_ms(observed))
            warm = types.SimpleNamespace(event=str(EVENT), times_ns={"haptic": 32_000_000, "thermal": 70_000_000})
            self.assertEqual((40, ""), participant.perceived_ms(warm))
            for sense in ("haptic", "visual", "audio"):
                lost = types.SimpleNamespace(event="99", times_ns={"thermal": 0, sense: 500_000_000})
                self.assertEqual((None, simulated.UNPERCEIVED[sense]), participant.perceived_ms(lost))


if __name__ == "__main__":
    unittest.main()
