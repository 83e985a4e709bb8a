"""The instruction set and the library versions, on which results depend besides the sources."""
import os
import re
import subprocess

# Packages whose version can change an output, by the start of their name.
PACKAGES = ("libode", "libassimp", "libgl1-mesa-dri", "libegl-mesa", "libllvm", "libc6", "libmysofa", "libx264-", "libavcodec",
            "libpng16", "libjpeg62", "libfreetype6", "libfcl", "libstdc++6", "ffmpeg")
MESA = "/usr/share/glvnd/egl_vendor.d/50_mesa.json"  # keeps a graphics card of the machine out of the pictures
# Instruction sets, widest last: {name: (flag in /proc/cpuinfo, settings of programs, environment)}.
# LP_NATIVE_VECTOR_WIDTH: width in bits that llvmpipe computes pixels with (Mesa, docs/gallium/drivers/llvmpipe.rst).
SETS = {
    "sse2": ("sse2", {"sim_node": ("isa=baseline",), "audio_node": ("instructions=sse2",)},
             {"LP_NATIVE_VECTOR_WIDTH": "128", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-AVX512F"}),
    "avx2": ("avx2", {"sim_node": ("isa=avx2",), "audio_node": ("instructions=avx2",)},
             {"LP_NATIVE_VECTOR_WIDTH": "256", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F"}),
    "avx512": ("avx512dq", {"sim_node": ("isa=avx512",), "audio_node": ("instructions=avx512",)}, {}),
}


def available(cpuinfo="/proc/cpuinfo"):
    """Names of the instruction sets that this processor has, widest last."""
    with open(cpuinfo, encoding="utf-8") as file:
        flags = set(re.search(r"^flags\s*:(.*)$", file.read(), re.MULTILINE).group(1).split())
    return [name for name, (flag, _, _) in SETS.items() if flag in flags]


def libraries():
    """{package: version} of the installed packages that results depend on."""
    try:
        listed = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev}\t${Package}\t${Version}\n"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return {}
    rows = [line.split("\t") for line in listed.splitlines()]
    return {package: version for status, package, version in rows
            if status.startswith("ii") and package.startswith(PACKAGES) and not package.endswith(("-dev", "-dbg", "-bin", "-i18n", "-i386"))}


def key(choice, cpuinfo="/proc/cpuinfo"):
    """Key of stored results. choice: "best" or the name of an instruction set to which programs are limited."""
    instructions = available(cpuinfo)[-1] if choice == "best" else choice
    return {"instructions": instructions, "forced": choice != "best", "libraries": libraries()}


def forced_settings(choice):
    return SETS[choice][1] if choice != "best" else {}


def of_programs(choice, home):
    """Environment variables of all programs: independent of the session of the caller."""
    found = {"PATH": "/usr/local/bin:/usr/bin:/bin", "HOME": home, "LC_ALL": "C.UTF-8", "TZ": "UTC", "LIBGL_ALWAYS_SOFTWARE": "1",
             "LP_NUM_THREADS": "1", "MESA_SHADER_CACHE_DISABLE": "true"}
    if os.path.exists(MESA):
        found["__EGL_VENDOR_LIBRARY_FILENAMES"] = MESA
    if choice != "best":
        found.update(SETS[choice][2])
    return found


def different_libraries(one, two):
    """A line for each package whose version differs."""
    names = sorted(one.keys() | two.keys())
    return [f"{name}: {two.get(name, 'none')} stored, {one.get(name, 'none')} here" for name in names if one.get(name) != two.get(name)]
