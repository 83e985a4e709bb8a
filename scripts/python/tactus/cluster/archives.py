"""Archives (tar, compressed with gzip) that another host sends: only regular files, below one new folder, at most of a given total size.

The sender may be hostile. Links, devices, absolute paths and paths with .. refuse the whole archive. The permissions and the owner in the
archive are ignored, except that a file may be executable.
"""
import contextlib
import gzip
import os
import pathlib
import tarfile
import zlib

LARGEST_READ = 1 << 20  # design: longest header of an entry; tarfile reads a header in one piece
MAX_FILES = 100_000
LONGEST_NAME = 1000     # bytes
HEADERS_BYTES = 1024 * MAX_FILES  # of a header and the padding of each file
CHUNK = 1 << 18


class Unsafe(Exception):
    """The archive holds something else than regular files, or too much; one sentence."""


class Limited(gzip.GzipFile):
    """The uncompressed bytes of an archive; raises Unsafe beyond largest_bytes, so that a small archive cannot fill memory or disk."""

    def __init__(self, file, largest_bytes):
        super().__init__(fileobj=file, mode="rb")
        self.largest_bytes = largest_bytes

    def seek(self, offset, whence=os.SEEK_SET):
        self.check(offset if whence == os.SEEK_SET else 0)
        return super().seek(offset, whence)

    def read(self, size=-1):
        if not 0 <= size <= LARGEST_READ:
            raise Unsafe(f"has a header of more than {LARGEST_READ} bytes")
        self.check(self.tell())
        return super().read(size)

    def check(self, end):
        if end > self.largest_bytes:
            raise Unsafe(f"holds more than {self.largest_bytes} bytes")


def entries(file, largest_bytes):
    """Yields (path, TarInfo, file with the content) of each file of an archive. Raises Unsafe and the errors of tarfile."""
    with Limited(file, largest_bytes + HEADERS_BYTES) as plain, tarfile.open(fileobj=plain, mode="r:") as tar:
        count = total = 0
        while (entry := tar.next()) is not None:
            tar.members = []  # it would keep all of them
            count, total = count + 1, total + entry.size
            if count > MAX_FILES or total > largest_bytes:
                raise Unsafe(f"holds more than {MAX_FILES} files or {largest_bytes} bytes")
            if entry.isdir():
                continue  # folders are made for their files
            yield checked_path(entry), entry, tar.extractfile(entry)


def checked_path(entry):
    """Path of a regular file, relative to the folder of the archive. Raises Unsafe."""
    shown = entry.name[:80]
    if entry.type not in (tarfile.REGTYPE, tarfile.AREGTYPE) or entry.issparse():
        raise Unsafe(f"holds {shown!r}, which is not a regular file")
    path = pathlib.PurePosixPath(entry.name)
    valid = 0 < len(os.fsencode(entry.name)) <= LONGEST_NAME and not path.is_absolute() and path.parts and ".." not in path.parts
    if not valid or any(ord(c) < 32 for c in entry.name):
        raise Unsafe(f"holds the path {shown!r}, which leads out of its folder or is not a path")
    return path


@contextlib.contextmanager
def reading():
    """Turns the errors of a damaged archive into Unsafe."""
    try:
        yield
    except gzip.BadGzipFile as error:
        raise Unsafe(f"is not an archive ({error})") from None
    except (EOFError, zlib.error, tarfile.TarError, ValueError) as error:
        raise Unsafe(f"is damaged ({error})") from None
    except FileExistsError as error:
        raise Unsafe(f"holds {pathlib.Path(error.filename).name[:80]!r} twice") from None


def unpack(file, into, largest_bytes, reserved=()):
    """Unpacks an archive into a folder of this user in which no other user can write; existing files are not replaced. reserved: names in the
    folder that the archive may not use. Returns the number of files. Raises Unsafe, and OSError when a file cannot be written; the files
    before the fault then exist."""
    into = pathlib.Path(into)
    into.mkdir(mode=0o700, parents=True, exist_ok=True)
    count = 0
    with reading():
        for path, entry, content in entries(file, largest_bytes):
            if path.parts[0] in reserved:
                raise Unsafe(f"holds {str(path)[:80]!r}, which is a name of another host")
            write(into / path, entry, content)
            count += 1
    return count


def write(path, entry, content):
    """Writes one new file. Raises OSError, EOFError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    mode = 0o777 if entry.mode & 0o100 else 0o666  # reduced by the umask; never setuid
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, mode)
    with open(descriptor, "wb") as out:
        while data := content.read(CHUNK):
            out.write(data)
        if out.tell() != entry.size:
            raise EOFError("it ends within a file")
