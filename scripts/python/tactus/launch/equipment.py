"""Missing equipment of this machine for a run. The run continues without it; its start and its summary report it."""
import glob
import os
import shutil

from tactus.launch import sound_server
from tactus.paths import packages_remedy


def missing_equipment(plan):
    """One sentence for each missing item."""
    found = []
    if "visual_node" not in plan.without and not shutil.which("ffmpeg"):
        found.append(f"visual_node: ffmpeg is not installed, so video.mp4 is not written; {packages_remedy('run')}")
    server = os.environ.get("PULSE_SERVER")
    if plan.listen and "audio_node" not in plan.without and sound_server.is_silent(server):
        found.append(f"audio_node: --listen, but the sound server of PULSE_SERVER ({server}) does not answer, so sound may only be written to audio.wav; "
                     "start the server, or unset the variable")
    elif plan.listen and "audio_node" not in plan.without and not has_sound_card():
        found.append("audio_node: --listen, but there is no sound card, so only audio.wav is written; connect a sound card or start a sound server")
    return found


def has_sound_card():
    """The same search as in audio_node: an ALSA device or a sound server."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return bool(glob.glob("/dev/snd/pcm*p") or os.environ.get("PULSE_SERVER")
                or (runtime and os.path.exists(os.path.join(runtime, "pulse", "native"))))
