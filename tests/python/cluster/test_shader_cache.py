"""Tests that complete compiled shaders, and no other files, are copied between hosts."""
import io
import pathlib
import sys
import tarfile
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import shader_cache


class ShaderCache(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.here, self.there = pathlib.Path(folder.name) / "here", pathlib.Path(folder.name) / "there"
        self.there.mkdir()

    def write(self, name, data=b"x"):
        (self.here / name).parent.mkdir(parents=True, exist_ok=True)
        (self.here / name).write_bytes(data)

    def files(self):
        return sorted(str(p.relative_to(self.there)) for p in self.there.rglob("*") if p.is_file())

    def test_missing_shaders_are_copied_and_existing_ones_kept(self):
        for name, data in (("mesa_shader_cache/ab/cdef", b"shader"), ("mesa_shader_cache/index", b"of here"), ("mesa_shader_cache/ab/half.tmp", b""),
                           ("mesa_shader_cache_db/part0/mesa_cache.db", b"db"), ("other/file", b"")):
            self.write(name, data)
        (self.there / "mesa_shader_cache_db/part0").mkdir(parents=True)
        (self.there / "mesa_shader_cache_db/part0/mesa_cache.db").write_bytes(b"its own")
        self.assertEqual(1, shader_cache.unpack(shader_cache.packed(self.here), self.there))
        self.assertEqual(["mesa_shader_cache/ab/cdef", "mesa_shader_cache_db/part0/mesa_cache.db"], self.files())
        self.assertEqual(b"shader", (self.there / "mesa_shader_cache/ab/cdef").read_bytes())
        self.assertEqual(b"its own", (self.there / "mesa_shader_cache_db/part0/mesa_cache.db").read_bytes())

    def test_a_host_without_shaders_sends_none(self):
        self.assertEqual(0, shader_cache.unpack(shader_cache.packed(self.here), self.there))

    def test_the_size_limit_is_kept(self):
        for i in range(10):
            self.write(f"mesa_shader_cache/ab/{i}", bytes(1000))
        self.assertEqual(4, shader_cache.unpack(shader_cache.packed(self.here, 4500), self.there))
        self.assertEqual(2, shader_cache.unpack(shader_cache.packed(self.here), self.there / "b", 2500))

    def test_files_outside_the_folders_of_mesa_are_refused(self):
        into = io.BytesIO()
        with tarfile.open(fileobj=into, mode="w:gz") as tar:
            for name in ("/etc/x", "../x", "mesa_shader_cache/../../x", "mesa_shader_cache/../x", ".bashrc", "mesa_shader_cache", "mesa_shader_cache/a/b/c/d"):
                entry = tarfile.TarInfo(name)
                entry.size = 1
                tar.addfile(entry, io.BytesIO(b"x"))
            for kind in (tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.FIFOTYPE, tarfile.DIRTYPE):
                entry = tarfile.TarInfo(f"mesa_shader_cache/link{kind.decode()}")
                entry.type, entry.linkname = kind, "/etc/passwd"
                tar.addfile(entry)
        self.assertEqual(0, shader_cache.unpack(into.getvalue(), self.there))
        self.assertEqual([], [p.name for p in self.there.parent.rglob("*") if p.name != "there"])


if __name__ == "__main__":
    unittest.main()
