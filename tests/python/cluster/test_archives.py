"""Tests of archives from hostile hosts: only regular files of this user arrive, below one folder, at most of a given size."""
import gzip
import io
import os
import pathlib
import random
import resource
import sys
import tarfile
import tempfile
import types
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import archives
from tactus.cluster.cluster_operator import Operator

LIMIT = 1_000_000
FILE = tarfile.REGTYPE


def archive(*entries):
    """A compressed tar of (name, type, content, mode, link)."""
    into = io.BytesIO()
    with tarfile.open(fileobj=into, mode="w:gz") as tar:
        for name, kind, data, mode, link in entries:
            entry = tarfile.TarInfo(name)
            entry.type, entry.size, entry.mode, entry.linkname, entry.uid, entry.gid = kind, len(data), mode, link, 4242, 4242
            tar.addfile(entry, io.BytesIO(data))
    return into.getvalue()


class Folders(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.tmp = pathlib.Path(kept.name)
        self.into = self.tmp / "results"

    def files(self):
        return {str(p.relative_to(self.tmp)): p for p in self.tmp.rglob("*") if not p.is_dir() or p.is_symlink()}


class Archives(Folders):
    def unpack(self, data, largest_bytes=LIMIT, **options):
        return archives.unpack(io.BytesIO(data), self.into, largest_bytes, **options)

    def refused(self, data, said, **options):
        with self.assertRaises(archives.Unsafe) as caught:
            self.unpack(data, **options)
        self.assertIn(said, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_regular_files_arrive_as_files_of_this_user_without_setuid(self):
        self.assertEqual(2, self.unpack(archive(("run.lcmlog", FILE, b"log", 0o6644, ""), ("logs/a.log", FILE, b"", 0o7777, ""), ("logs", tarfile.DIRTYPE, b"", 0o7777, ""))))
        self.assertEqual(b"log", (self.into / "run.lcmlog").read_bytes())
        for path in self.files().values():
            self.assertEqual((os.geteuid(), 0), (path.stat().st_uid, path.stat().st_mode & 0o7000))
        self.assertEqual(0, (self.into / "logs").stat().st_mode & 0o7000)

    def test_links_devices_and_pipes_refuse_the_archive(self):
        for kind in (tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.FIFOTYPE, tarfile.CHRTYPE, tarfile.BLKTYPE, tarfile.GNUTYPE_SPARSE, tarfile.CONTTYPE):
            with self.subTest(kind):
                self.refused(archive(("x", kind, b"", 0o777, "/etc/passwd"), ("x/y", FILE, b"1", 0o644, "")), "not a regular file")
                self.assertEqual({}, self.files())

    def test_paths_out_of_the_folder_refuse_the_archive(self):
        for name in ("/etc/x", "../x", "a/../../x", "..", "a/..", "a\x1bb", "a\nb", "x" * 2000):
            with self.subTest(name[:20]):
                self.refused(archive((name, FILE, b"1", 0o644, "")), "leads out of its folder or is not a path")
                self.assertEqual({}, self.files())

    def test_no_existing_file_is_replaced_and_no_folder_of_another_host_is_used(self):
        self.refused(archive(("x", FILE, b"1", 0o644, ""), ("x", FILE, b"2", 0o644, "")), "twice")
        self.assertEqual(b"1", (self.into / "x").read_bytes())
        self.refused(archive(("sound/x", FILE, b"1", 0o644, "")), "name of another host", reserved=("desk", "sound"))

    def test_bombs_stop_at_the_limit_without_memory(self):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        zeros = bytes(1 << 22)
        self.refused(archive(("x", FILE, bytes(2 * LIMIT), 0o644, "")), f"or {LIMIT} bytes")
        for kind in (b"x", b"g", b"L", b"K"):  # headers that tarfile reads into memory
            entry = tarfile.TarInfo("x")
            entry.type, entry.size = kind, 4 << 30
            self.refused(gzip.compress(entry.tobuf(tarfile.GNU_FORMAT) + zeros), "header")
        entry = tarfile.TarInfo("x")
        entry.size = 1 << 60
        self.refused(gzip.compress(entry.tobuf(tarfile.GNU_FORMAT) + zeros), "bytes")
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 100_000)  # kB
        self.assertLess(sum(p.stat().st_size for p in self.files().values()), LIMIT)

    def test_more_files_than_permitted_refuse_the_archive(self):
        limit, archives.MAX_FILES = archives.MAX_FILES, 20
        self.addCleanup(setattr, archives, "MAX_FILES", limit)
        self.refused(archive(*((f"{i}", FILE, b"", 0o644, "") for i in range(30))), "more than 20 files")

    def test_any_damage_is_one_sentence(self):
        whole = archive(*((f"f{i}", FILE, random.Random(i).randbytes(500), 0o644, "") for i in range(20)))
        chance = random.Random(3)
        for number in range(300):
            damaged = bytearray(gzip.decompress(whole) if number % 2 else whole)
            for _ in range(chance.randint(1, 5)):
                damaged[chance.randrange(len(damaged))] = chance.randrange(256)
            data = bytes(damaged[:chance.randint(0, len(damaged))])
            self.into = self.tmp / str(number)
            try:
                self.unpack(gzip.compress(data) if number % 2 else data)
            except archives.Unsafe as error:
                self.assertNotIn("\n", str(error))
        self.assertEqual(set(), {p for p in self.files().values() if p.is_symlink() or not p.is_file()})


class Results(Folders):
    """tactus cluster down with a hostile host among others."""

    def collect(self, sent):
        """The errors, and the files below the results; sent: {host: bytes of its archive}; the recorder runs on the first."""
        def request(host):
            return lambda *_, to, **__: to.write(sent[host]) and None
        cluster = types.SimpleNamespace(name="c", hosts={h: types.SimpleNamespace(reach="local", address=h, folder="", build="", name=h) for h in sent},
                                        nodes={"recorder": types.SimpleNamespace(host=next(iter(sent)))})
        operator = Operator(cluster, quiet=True)
        operator.connections = {h: types.SimpleNamespace(request=request(h)) for h in sent}
        return operator.collect_results(self.into, list(sent)), set(self.files())

    def test_a_hostile_host_neither_plants_links_nor_hinders_the_others(self):
        good = archive(("logs/a.log", FILE, b"1", 0o644, ""))
        bad = archive((".ssh", tarfile.SYMTYPE, b"", 0o777, "/root/.ssh"), (".ssh/authorized_keys", FILE, b"key", 0o644, ""))
        errors, files = self.collect({"desk": good, "sound": bad, "wall": good})
        self.assertEqual({"results/logs/a.log", "results/wall/logs/a.log"}, files)
        self.assertEqual(1, len(errors))
        self.assertTrue(errors[0].startswith("sound: the archive of its results holds '.ssh', which is not a regular file;"), errors)

    def test_the_host_of_the_recorder_cannot_write_results_of_another(self):
        errors, files = self.collect({"desk": archive(("sound/x", FILE, b"1", 0o644, "")), "sound": archive(("x", FILE, b"2", 0o644, ""))})
        self.assertEqual(({"results/sound/x"}, 1), (files, len(errors)))
        self.assertEqual(b"2", (self.into / "sound" / "x").read_bytes())


if __name__ == "__main__":
    unittest.main()
