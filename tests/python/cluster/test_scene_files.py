"""Tests that a cluster sends the files that a scene names, and no other file of the user."""
import io
import json
import os
import pathlib
import struct
import sys
import tarfile
import tempfile
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import deployment, scene_files
from tactus.paths import SCENES
from tactus.refusal import Refusal

SCENE = """<sdf version="1.9"><world name="w"><tactus:material name="planks" base="oak" bump="planks.png"/>
<tactus:tool name="hand" device="playback:motion/taps.csv,scale=2"/><tactus:shader name="s" fragment="look/s.frag"/>
<include><uri>model://chair</uri></include><include><uri>part.sdf</uri></include>
<model name="m"><link name="l"><visual name="v"><geometry><mesh><uri>bowl.obj</uri></mesh></geometry></visual>
<collision name="c"><geometry><mesh><uri>hull.gltf</uri></mesh></geometry></collision></link></model>%s</world></sdf>"""


class SceneFiles(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.home = pathlib.Path(kept.name) / "home"
        for name, text in {"planks.png": "", "motion/taps.csv": "", "look/s.frag": "", "part.sdf": '<sdf><model name="x"><uri>part/wheel.stl</uri></model></sdf>',
                           "part/wheel.stl": "", "models/chair/model.config": "<model><sdf>chair.sdf</sdf></model>",
                           "models/chair/chair.sdf": "<sdf><uri>seat.dae</uri></sdf>", "models/chair/seat.dae": "<COLLADA><init_from>wood.jpg</init_from></COLLADA>",
                           "models/chair/wood.jpg": "", "bowl.obj": "mtllib bowl.mtl\nv 0 0 0\n", "bowl.mtl": "newmtl a\nmap_Kd bowl.png\n", "bowl.png": "",
                           "hull.gltf": json.dumps({"buffers": [{"uri": "hull.bin"}], "images": [{"uri": "../secret.png"}, {"uri": "/etc/x.png"}]}), "hull.bin": "",
                           ".ssh/id_rsa": "key", ".ssh/look.png": "", "taxes.csv": "", "notes.txt": "", "picture.png": "", "other.sdf": ""}.items():
            (self.home / name).parent.mkdir(parents=True, exist_ok=True)
            (self.home / name).write_text(text, encoding="utf-8")
        (self.home.parent / "secret.png").touch()

    def scene(self, more=""):
        path = self.home / "scene.sdf"
        path.write_text(SCENE % more, encoding="utf-8")
        return path

    NAMED = {"scene.sdf", "planks.png", "motion/taps.csv", "look/s.frag", "part.sdf", "part/wheel.stl", "models/chair/model.config", "models/chair/chair.sdf",
             "models/chair/seat.dae", "models/chair/wood.jpg", "bowl.obj", "bowl.mtl", "bowl.png", "hull.gltf", "hull.bin"}

    def test_a_scene_in_the_home_folder_sends_what_it_names_and_nothing_else(self):
        self.assertEqual(self.NAMED, set(scene_files.files_of(self.scene())))

    def test_names_that_lead_elsewhere_send_nothing(self):
        (self.home / "linked.png").symlink_to(self.home.parent / "secret.png")
        os.mkfifo(self.home / "pipe.png")
        more = "".join(f"<uri>{name}</uri>" for name in ("../secret.png", ".ssh/id_rsa", ".ssh/look.png", "linked.png", "pipe.png", "notes.txt", "/etc/hostname",
                                                         "file:///etc/hostname", str(self.home.parent / "secret.png"), "motion", ".", "", "model://.ssh"))
        self.assertEqual(self.NAMED, set(scene_files.files_of(self.scene(more))))

    def test_a_circle_of_files_and_a_damaged_scene_end(self):
        (self.home / "part.sdf").write_text("<sdf><uri>scene.sdf</uri><uri>part.sdf</uri></sdf>", encoding="utf-8")
        self.assertEqual(self.NAMED - {"part/wheel.stl"}, set(scene_files.files_of(self.scene())))
        path = self.home / "damaged.sdf"
        for data in (b"", b"\xff\xfe", b"<sdf><uri>planks.png</uri", b'<?xml version="1.0" encoding="none"?><sdf/>'):
            path.write_bytes(data)
            self.assertLessEqual(set(scene_files.files_of(path)), {"damaged.sdf", "planks.png"})

    def test_a_binary_gltf_names_its_pictures(self):
        text = json.dumps({"images": [{"uri": "picture.png"}]}).encode()
        (self.home / "m.glb").write_bytes(struct.pack("<5I", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A) + text)
        self.assertIn("picture.png", scene_files.files_of(self.scene("<uri>m.glb</uri>")))

    def test_too_many_files_are_refused_with_one_sentence(self):
        limit, scene_files.MAX_FILES = scene_files.MAX_FILES, 5
        self.addCleanup(setattr, scene_files, "MAX_FILES", limit)
        with self.assertRaisesRegex(Refusal, "names more than 5 files"):
            scene_files.files_of(self.scene())

    def test_every_shipped_scene_names_its_files(self):
        self.assertEqual({"looks_bench.sdf", "bumpy_sphere.obj", "plain_ball.obj", "room.png", "stripes.frag", "tiled_ball.mtl", "tiled_ball.obj", "tiles.png",
                          "tiles_normal.png"}, set(scene_files.files_of(SCENES / "looks_bench.sdf")))

    def test_folders_that_the_user_allows_are_sent_at_their_places_and_only_with_their_named_files(self):
        models = self.home.parent / "models"
        for name, text in {"table/model.config": "<model><sdf>table.sdf</sdf></model>", "table/table.sdf": "<sdf><uri>../shared/wood.png</uri></sdf>",
                           "shared/wood.png": "", "shared/other.png": "", "table/.key": ""}.items():
            (models / name).parent.mkdir(parents=True, exist_ok=True)
            (models / name).write_text(text, encoding="utf-8")
        unused = self.home.parent / "unused"
        unused.mkdir()
        scene = self.scene("<include><uri>model://table</uri></include><uri>../models/shared/wood.png</uri>")
        self.assertEqual(self.NAMED, set(scene_files.files_of(scene)))
        from_models = {"models/table/model.config", "models/table/table.sdf", "models/shared/wood.png"}
        for folders in ([models], [models, unused]):
            plan = types.SimpleNamespace(scene=scene, scene_folders=folders, degrade=None, room="")
            data, there = deployment.run_files(types.SimpleNamespace(plan=plan, relays=None))
            with tarfile.open(fileobj=io.BytesIO(data)) as tar:
                names = {e.name for e in tar.getmembers()}
            self.assertEqual({f"scene/{name}" for name in (*(f"home/{n}" for n in self.NAMED), *from_models)}, names)
            self.assertEqual("@FILES@/scene/home", there[str(self.home)])
            self.assertEqual("@FILES@/scene/models", there[str(models)])
            self.assertNotIn(str(unused), there)
        # A scene of the build names a model of the user.
        plan = types.SimpleNamespace(scene=SCENES / "dark_room.sdf", scene_folders=[models], degrade=None, room="")
        texts_of = scene_files.texts_of
        with mock.patch.object(scene_files, "texts_of", lambda path: ["model://table"] if path == plan.scene else texts_of(path)):
            data, there = deployment.run_files(types.SimpleNamespace(plan=plan, relays=None))
        with tarfile.open(fileobj=io.BytesIO(data)) as tar:
            names = {e.name for e in tar.getmembers()}
        self.assertEqual({f"scene/{name.removeprefix('models/')}" for name in from_models}, names)
        self.assertEqual("@FILES@/scene", there[str(models)])

    def test_the_archive_for_the_hosts_holds_these_files_and_no_link(self):
        profile = self.home / "profile.xml"
        profile.symlink_to(self.home / "part.sdf")
        plan = types.SimpleNamespace(scene=self.scene(), scene_folders=[], degrade=profile, room="")
        data, there = deployment.run_files(types.SimpleNamespace(plan=plan, relays=None))
        with tarfile.open(fileobj=io.BytesIO(data)) as tar:
            entries = tar.getmembers()
        self.assertEqual({"profile.xml", *(f"scene/{name}" for name in self.NAMED)}, {e.name for e in entries})
        self.assertTrue(all(e.isreg() for e in entries))
        self.assertEqual("@FILES@/scene", there[str(self.home)])


if __name__ == "__main__":
    unittest.main()
