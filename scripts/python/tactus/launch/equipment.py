"""What this machine lacks for what was asked for. A run goes on without it; this is said at its start and in its summary."""
import glob
import os
import shutil


def lacking(plan):
    """A sentence for each."""
    found = []
    if "visual_node" not in plan.without and not shutil.which("ffmpeg"):
        found.append("visual_node: ffmpeg is not installed, there will be no video.mp4; run scripts/setup")
    if plan.listen and "audio_node" not in plan.without and not has_sound_card():
        found.append("audio_node: --listen, but there is no sound card: nothing will be heard, audio.wav is written")
    return found


def has_sound_card():
    """As audio_node looks for one: ALSA's, or a sound server."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return bool(glob.glob("/dev/snd/pcm*p") or os.environ.get("PULSE_SERVER")
                or (runtime and os.path.exists(os.path.join(runtime, "pulse", "native"))))
