#!/usr/bin/env python3
"""The generator refuses tables that a node could not live with, and says where."""
import os
import subprocess
import sys
import tempfile
import unittest

TOOL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "cmake", "generate_settings.py")
GOOD = 'rate,Hz,50,1,100,Rate,design\nmode,fast|slow,fast,,,Mode,"Smith, 1999"\nname,text,,,,Name,design\nloud,bool,false,,,Loud,design\n'


class GenerateSettings(unittest.TestCase):
    def generate(self, rows, what="header", more_columns=""):
        with tempfile.TemporaryDirectory() as root:
            os.mkdir(os.path.join(root, "audio_node"))
            table, out = os.path.join(root, "audio_node", "settings.csv"), os.path.join(root, "out")
            with open(table, "w", encoding="utf-8") as file:
                file.write(f"name,unit,default,min,max,meaning,source{more_columns}\n" + rows)
            files = [table, out] if what == "header" else [out, table]
            done = subprocess.run([sys.executable, TOOL, what, *files], capture_output=True, text=True)
            text = ""
            if os.path.exists(out):
                with open(out, encoding="utf-8") as file:
                    text = file.read()
            return done.returncode, done.stderr, text

    def test_a_good_table_becomes_a_struct_with_units_in_its_names(self):
        code, err, text = self.generate(GOOD)
        self.assertEqual((0, ""), (code, err))
        for part in ("namespace tactus::audio", "double rate_Hz = 50;", 'std::string mode = "fast";',
                     "bool loud = false;", "Smith, 1999"):
            self.assertIn(part, text)

    def test_a_good_table_becomes_documentation(self):
        text = self.generate(GOOD, "markdown")[2]
        self.assertIn("| `rate` | Hz | 50 | 1 .. 100 | Rate | design |", text)
        self.assertIn("## audio_node", text)

    def test_a_bad_row_is_refused_with_its_place(self):
        for row in ("rate,Hz,50,1,100,Rate,", "rate,Hz,50,1,100,,design", "rate,,50,1,100,Rate,design",
                    "rate,Hz,500,1,100,Rate,design", "rate,Hz,fast,1,100,Rate,design", "rate,Hz,50,,,Rate,design",
                    "mode,fast|slow,medium,,,Mode,design", "loud,bool,maybe,,,Loud,design", "rate,Hz,50", "rate,Hz,50,1,100,Rate,design,max,yes"):
            with self.subTest(row=row):
                code, err, text = self.generate(GOOD + row.replace("rate", "other") + "\n")
                self.assertNotEqual(0, code)
                self.assertIn("settings.csv:6", err)
                self.assertEqual(1, len(err.strip().splitlines()))
                self.assertEqual("", text)

    def test_a_safety_limit_is_marked(self):
        rows = "heat,degC,42,34,43,Heat,design,max\ncold,degC,15,10,30,Cold,design,min\nrate,Hz,50,1,100,Rate,design\n"
        text = self.generate(rows, more_columns=",safety")[2]
        self.assertIn('"Heat", "design", "max", false}', text)
        self.assertIn('"Rate", "design", "", false}', text)
        text = self.generate(rows, "markdown", ",safety")[2]
        self.assertIn("| `heat` | degC | 42 | 34 .. 43; in a scene 34 .. 42 | Heat | design |", text)
        self.assertIn("| `cold` | degC | 15 | 10 .. 30; in a scene 15 .. 30 | Cold | design |", text)

    def test_a_live_setting_is_marked(self):
        rows = "gain,1,1,0,2,Gain,design,,yes\nheat,degC,42,34,43,Heat,design,max,yes\nrate,Hz,50,1,100,Rate,design\n"
        text = self.generate(rows, more_columns=",safety,live")[2]
        self.assertIn('"Gain", "design", "", true}', text)
        self.assertIn('"Rate", "design", "", false}', text)
        text = self.generate(rows, "markdown", ",safety,live")[2]
        self.assertIn("| `gain` | 1 | 1 | 0 .. 2; live | Gain | design |", text)
        self.assertIn("34 .. 43; in a scene 34 .. 42; live", text)
        self.assertNotEqual(0, self.generate("gain,1,1,0,2,Gain,design,,maybe\n", more_columns=",safety,live")[0])

    def test_an_unknown_mark_is_refused(self):
        for row in ("rate,Hz,50,1,100,Rate,design,up", "loud,bool,false,,,Loud,design,max", "name,text,,,,Name,design,min"):
            with self.subTest(row=row):
                code, err, text = self.generate(row + "\n", more_columns=",safety")
                self.assertNotEqual(0, code)
                self.assertIn("settings.csv:2", err)
                self.assertEqual("", text)

    def test_a_name_given_twice_is_refused(self):
        self.assertNotEqual(0, self.generate(GOOD + "rate,Hz,50,1,100,Rate,design\n")[0])


if __name__ == "__main__":
    unittest.main()
