"""Copies compiled shaders between hosts on request, so that a moved visual_node starts without compiling them. Mesa names each file by
source, driver and build of the driver, so a host with another processor or Mesa ignores them. A compiled shader is a program that the
other host runs: only shaders of a host that is trusted like the others may be copied."""
import contextlib
import io
import os
import pathlib
import re
import tarfile

from tactus.cluster import archives

FOLDERS = ("mesa_shader_cache", "mesa_shader_cache_db")  # Mesa up to 24.0, and since
LARGEST_BYTES = 64_000_000
NAME = re.compile(r"mesa_shader_cache(_db)?(/[A-Za-z0-9_.-]+){1,3}")


def folder():
    """Folder of the shader caches of Mesa for the current user (documentation of Mesa, environment variables)."""
    own = os.environ.get("MESA_SHADER_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return pathlib.Path(own).expanduser()


def packed(root, largest_bytes=LARGEST_BYTES):
    """A tar of the shaders, newest first, at most largest_bytes; skips files that are being written, which have another name."""
    files = [p for name in FOLDERS for p in (root / name).rglob("*") if p.is_file() and not p.is_symlink() and p.suffix != ".tmp" and p.name != "index"]
    into, left = io.BytesIO(), largest_bytes
    with tarfile.open(fileobj=into, mode="w:gz", compresslevel=1) as tar:
        for path in sorted(files, key=lambda p: -p.stat().st_mtime):
            data = path.read_bytes()
            left -= len(data)
            if left < 0:
                break
            entry = tarfile.TarInfo(str(path.relative_to(root)))
            entry.size = len(data)
            tar.addfile(entry, io.BytesIO(data))
    return into.getvalue()


def unpack(data, root, largest_bytes=LARGEST_BYTES):
    """Stores missing shaders, up to the first invalid entry; returns their number. Accepts only regular files in the folders of Mesa, and
    never replaces an existing one."""
    count = 0
    with contextlib.suppress(archives.Unsafe):
        with archives.reading():
            for path, entry, content in archives.entries(io.BytesIO(data), largest_bytes):
                if NAME.fullmatch(str(path)) and not (root / path).exists():
                    (root / path).parent.mkdir(parents=True, exist_ok=True, mode=0o700)
                    fresh = (root / path).with_name(f"{path.name}.{os.getpid()}.tmp")
                    archives.write(fresh, entry, content)
                    fresh.rename(root / path)
                    count += 1
    return count
