"""Copies a checkout into a folder: tracked files and new ones that git does not ignore. Times of files are kept, so that only changed
files are compiled again; files that have gone since the last copy are removed."""
import pathlib
import shutil
import subprocess

MANIFEST = ".copied"


def files_of(checkout):
    """Paths of the files to copy, relative to the checkout; without those that are deleted but still tracked."""
    listed = subprocess.run(["git", "-C", str(checkout), "ls-files", "-z", "--cached", "--others", "--exclude-standard"], capture_output=True, check=True).stdout
    names = sorted({name.decode() for name in listed.split(b"\0") if name})
    return [name for name in names if (checkout / name).is_symlink() or (checkout / name).is_file()]


def copy(checkout, folder):
    """Returns the number of files that were copied, because they are new or have another time or size."""
    checkout, folder = pathlib.Path(checkout), pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    names = files_of(checkout)
    manifest = folder / MANIFEST
    before = set(manifest.read_text(encoding="utf-8").splitlines()) if manifest.exists() else set()
    manifest.write_text("\n".join(sorted(before.union(names))) + "\n", encoding="utf-8")
    for name in before.difference(names):
        (folder / name).unlink(missing_ok=True)
    copied = 0
    for name in names:
        source, target = checkout / name, folder / name
        if same(source, target):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        shutil.copy2(source, target, follow_symlinks=False)
        copied += 1
    manifest.write_text("\n".join(names) + "\n", encoding="utf-8")
    return copied


def same(source, target):
    """Whether the copy has the kind, the time, the size and the permissions of its source."""
    if not target.is_symlink() and not target.exists():
        return False
    a, b = source.lstat(), target.lstat()
    return (a.st_mode, a.st_size, a.st_mtime_ns) == (b.st_mode, b.st_size, b.st_mtime_ns)
