"""Features of one sense that is rendered again from the log of a task, under a degradation or none."""
import pathlib
import tempfile

import numpy as np

from tactus.information import pictures, rendering, sound, touch
from tactus.paths import BIN
from tactus.refusal import Refusal
from tactus.rerender import render

SIZE = (320, 240)  # of pictures
SKIPPED = 4        # one pixel of four counts in each direction
DECIMALS = 5       # of kept features; far below the noise of every percept


def features(task, sense, folder, said, offset_ns):
    """[(values, standard deviations, confused share, name)] of the percepts of a rendering of one sense, window after window; of pictures all pixels that count."""
    if sense == "visual":
        looks = pictures.read(folder / "video.mp4", folder / "frames.csv", *SIZE, offset_ns + task.windows[0][0] * 1e9, offset_ns + task.windows[-1][1] * 1e9)
        return [(looks[:, ::SKIPPED, ::SKIPPED].reshape(-1).tolist(), [], 0.0, "pixels")]
    if sense == "audio":
        first_ns = render.facts(said)["first_sample_ns"]
        clock = np.array([[0.0, first_ns], [sound.read_channels(folder / "audio.wav")[1], first_ns + 1e9]])
        of_window = lambda begin, end: sound.features(sound.read(folder / "audio.wav", clock, offset_ns + begin * 1e9, offset_ns + end * 1e9))
    else:
        of_window = {"haptic": touch.Touch, "thermal": touch.Warmth}[sense](folder / f"{sense}.csv", offset_ns).features
    return [(np.round(values, DECIMALS).tolist(), list(sds), wrong, name) for window in task.windows for name, values, sds, wrong in of_window(*window)]


def rendered(task, sense, log, element, seed, offset_ns):
    """features() of a sense under an element of a profile; "": undegraded. seed: of the profile. offset_ns: host_offset_ns(). Raises Refusal."""
    with tempfile.TemporaryDirectory() as scratch:
        folder, profile = pathlib.Path(scratch), None
        if element:
            profile = str(folder / "profile.xml")
            pathlib.Path(profile).write_text(f'<profile seed="{seed}">{element}</profile>\n', encoding="utf-8")
        said = render_once(sense, log, scratch, profile)
        return features(task, sense, folder, said, offset_ns)


def render_once(sense, log, folder, profile):
    """The lines of output of a rendering. Raises Refusal."""
    try:
        return render.render(render.command(str(BIN), sense, str(log), str(folder), profile, None, {"visual": rendering.picture_settings(SIZE)}), lambda _: None)
    except render.Refused as refused:
        raise Refusal(str(refused)) from None


def host_offset_ns(log, folder):
    """Host time minus time of the world in a log, ns, from the ticks of touch. Raises Refusal."""
    render_once("haptic", log, folder, None)
    return touch.Touch(pathlib.Path(folder) / "haptic.csv").offset_ns()
