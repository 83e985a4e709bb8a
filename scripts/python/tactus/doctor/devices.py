"""Checks sound card, renderer, processor, and the disk for logs."""
import ctypes
import glob
import os
import pathlib
import shutil
import tempfile
import time

from tactus.doctor.line import GOOD, MISSING, WEAK, Line

SURFACELESS = 0x31DD  # EGL_PLATFORM_SURFACELESS_MESA
LOG_MB_s = 2          # design: a cluster with all tagged variables writes less than 1 MB/s
CHUNK = 1 << 20


def sound(has_card):
    cards = pathlib.Path("/proc/asound/cards")
    names = [line.split("]:")[1].strip() for line in cards.read_text().splitlines() if "]:" in line] if cards.exists() else []
    if has_card:
        return Line("sound card", GOOD, ", ".join(names) or "by a sound server", figures={"cards": names})
    return Line("sound card", WEAK, "there is none: sound is only written to audio.wav",
                "connect one, or start the sound server of the desktop; then tactus run --listen", {"cards": names})


def renderer():
    """Name of the OpenGL renderer. Raises OSError."""
    egl, gl = ctypes.CDLL("libEGL.so.1"), ctypes.CDLL("libGL.so.1")
    address = egl.eglGetProcAddress
    address.restype, address.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
    of_platform = address(b"eglGetPlatformDisplayEXT")
    if not of_platform:
        raise OSError("this EGL has no platform extension")
    egl.eglCreateContext.restype = gl.glGetString.restype = ctypes.c_void_p
    handle = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p)(of_platform)(SURFACELESS, None, None)
    display = ctypes.c_void_p(handle)
    if not handle or not egl.eglInitialize(display, None, None) or not egl.eglBindAPI(0x30A2):  # EGL_OPENGL_API
        raise OSError("cannot open a display")
    wanted = (ctypes.c_int * 5)(0x3098, 3, 0x30FB, 3, 0x3038)  # version 3.3
    context = ctypes.c_void_p(egl.eglCreateContext(display, None, None, wanted))
    if not context or not egl.eglMakeCurrent(display, None, None, context):
        raise OSError("cannot create a context of OpenGL 3.3")
    gl.glGetString.argtypes = [ctypes.c_uint]
    name = ctypes.string_at(gl.glGetString(0x1F01)).decode(errors="replace")  # GL_RENDERER
    egl.eglMakeCurrent(display, None, None, None)
    egl.eglTerminate(display)
    return name


def renderer_advice():
    """The remedy that fits this machine: packages where they are missing, else the variables that choose another renderer."""
    folders = [*map(pathlib.Path, glob.glob("/usr/lib/*-linux-gnu*")), pathlib.Path("/usr/lib64"), pathlib.Path("/usr/lib")]
    installed = any((folder / "libEGL_mesa.so.0").exists() for folder in folders) and any((folder / "dri").is_dir() for folder in folders)
    if not installed:
        return "tactus setup run installs a software renderer (libegl-mesa0, libgl1-mesa-dri)"
    chosen = sorted(name for name in os.environ if name.startswith(("__EGL_", "EGL_PLATFORM", "LIBGL_", "MESA_GL_", "MESA_LOADER_", "GALLIUM_")))
    return ("a software renderer is installed; unset " + ", ".join(chosen)) if chosen else "a software renderer is installed; read the output of eglinfo (mesa-utils)"


def picture(find=renderer):
    try:
        name = find()
    except (OSError, AttributeError, ValueError) as error:
        return Line("pictures (EGL)", MISSING, f"rendering is impossible: {error}", renderer_advice())
    if "llvmpipe" in name or "softpipe" in name:
        return Line("pictures (EGL)", WEAK, f"{name}: software rendering, 60 frames a second of 640 x 480 on one free core",
                    "install a graphics card and its driver for larger frames", {"renderer": name})
    return Line("pictures (EGL)", GOOD, name, figures={"renderer": name})


def cores():
    count = len(os.sched_getaffinity(0))
    governors = {pathlib.Path(p).read_text().strip() for p in glob.glob("/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor")}
    load = os.getloadavg()[0]
    figures = {"cores": count, "governors": sorted(governors), "load": load}
    text = f"{count} cores" + (f", governor {' '.join(sorted(governors))}" if governors else "") + f", load {load:.1f}"
    if count < 2:
        return Line("processor", WEAK, text + ": all nodes share one core", "leave nodes out (--without), or distribute them over several hosts", figures)
    if load > count / 2:
        return Line("processor", WEAK, text + ": other programs run", "end them before a measurement", figures)
    if governors - {"performance", "schedutil"}:
        return Line("processor", WEAK, text + ": slow to wake up", "cpupower frequency-set -g performance", figures)
    return Line("processor", GOOD, text, figures=figures)


def disk(folder, megabytes=64):
    """Writes and removes a file of the size of about a minute of log, MB."""
    try:
        free = shutil.disk_usage(folder).free
        with tempfile.TemporaryFile(dir=folder) as file:
            block = os.urandom(CHUNK)
            begun = time.monotonic()
            for _ in range(min(megabytes, int(free / 2 // CHUNK))):
                file.write(block)
            file.flush()
            os.fsync(file.fileno())
            rate = file.tell() / 1e6 / (time.monotonic() - begun)
    except OSError as error:
        return Line("disk for logs", MISSING, f"{folder}: cannot be written ({error.strerror})", "choose another folder with --out", needed=True)
    hours = free / 1e6 / LOG_MB_s / 3600
    figures = {"folder": str(folder), "free_bytes": free, "MB_per_s": round(rate, 1)}
    text = f"{free / 1e9:.1f} GB free, {hours:.1f} h of logs; writes {rate:.0f} MB/s"
    if rate < 5 * LOG_MB_s:
        return Line("disk for logs", WEAK, text + ": logs may lose messages", "choose a faster disk with --out", figures)
    if hours < 1:
        return Line("disk for logs", WEAK, text, "free space, or choose another disk with --out", figures)
    return Line("disk for logs", GOOD, text, figures=figures)
