"""Sends a request to a process and reads its answer, both with limits on time and size: the other side may be a hostile host."""
import os
import selectors
import subprocess
import time

LARGEST_ERROR_BYTES = 1 << 16
CHUNK = 1 << 16


class TooLong(Exception):
    """The answer is longer than permitted."""


class TooSlow(Exception):
    """The answer is not complete in time."""


def exchange(process, data, patience_s, largest_bytes, to=None):
    """(answer, text of stderr) of a process with three pipes, which has then ended. to: file for the answer, which is then b"". Kills the
    process and raises TooLong or TooSlow. Of stderr only the end is kept."""
    out, error = bytearray(), bytearray()
    begin, left, received = time.monotonic(), memoryview(data), 0
    with selectors.DefaultSelector() as ready:
        for stream, events in ((process.stdin, selectors.EVENT_WRITE), (process.stdout, selectors.EVENT_READ), (process.stderr, selectors.EVENT_READ)):
            os.set_blocking(stream.fileno(), False)
            ready.register(stream, events)
        try:
            while ready.get_map():
                rest_s = begin + patience_s - time.monotonic()
                if rest_s <= 0:
                    raise TooSlow
                for key, _ in ready.select(rest_s):
                    if key.fileobj is process.stdin:
                        left = sent(process.stdin, left)
                        if not left:
                            ready.unregister(process.stdin)
                            close(process.stdin)
                        continue
                    read = os.read(key.fd, CHUNK)
                    if not read:
                        ready.unregister(key.fileobj)
                    elif key.fileobj is process.stderr:
                        error = (error + read)[-LARGEST_ERROR_BYTES:]
                    else:
                        received += len(read)
                        if received > largest_bytes:
                            raise TooLong
                        to.write(read) if to is not None else out.extend(read)
            wait(process, max(0.0, begin + patience_s - time.monotonic()))
        except BaseException:
            process.kill()
            process.wait()
            raise
        finally:
            for stream in (process.stdin, process.stdout, process.stderr):
                close(stream)
    return bytes(out), error.decode("utf-8", "replace")


def sent(stream, left):
    """The rest of the data after one write; nothing when the process does not read any more."""
    try:
        return left[os.write(stream.fileno(), left[:CHUNK]):]
    except BlockingIOError:
        return left
    except BrokenPipeError:
        return left[:0]


def wait(process, patience_s):
    try:
        process.wait(patience_s + 1)
    except subprocess.TimeoutExpired:
        raise TooSlow from None


def close(stream):
    try:
        stream.close()
    except OSError:
        pass  # its reader has ended
