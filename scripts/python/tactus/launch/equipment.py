"""Missing equipment of this machine for a run. The run continues without it; its start and its summary report it."""
import glob
import os
import shutil


def missing_equipment(plan):
    """One sentence for each missing item."""
    found = []
    if "visual_node" not in plan.without and not shutil.which("ffmpeg"):
        found.append("visual_node: ffmpeg is not installed, so video.mp4 is not written; run scripts/setup")
    if plan.listen and "audio_node" not in plan.without and not has_sound_card():
        found.append("audio_node: --listen, but there is no sound card, so only audio.wav is written; connect a sound card or start a sound server")
    return found


def has_sound_card():
    """The same search as in audio_node: an ALSA device or a sound server."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return bool(glob.glob("/dev/snd/pcm*p") or os.environ.get("PULSE_SERVER")
                or (runtime and os.path.exists(os.path.join(runtime, "pulse", "native"))))
