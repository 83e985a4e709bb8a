"""Copies compiled shaders between hosts, so that a moved visual_node starts without compiling them. Mesa names each file by
content, driver and build of the driver, so a host with another processor or Mesa ignores them."""
import io
import os
import pathlib
import re
import tarfile

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
    """Stores shaders that are missing; returns their number. Accepts only regular files in the folders of Mesa."""
    count = 0
    with tarfile.open(fileobj=io.BytesIO(data), mode="r:gz") as tar:
        for entry in tar:
            largest_bytes -= entry.size
            if largest_bytes < 0:
                break
            into = root / entry.name
            if not entry.isreg() or not NAME.fullmatch(entry.name) or ".." in entry.name.split("/") or into.exists():
                continue
            into.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            fresh = into.with_name(f"{into.name}.{os.getpid()}.tmp")
            fresh.write_bytes(tar.extractfile(entry).read())
            fresh.rename(into)
            count += 1
    return count
