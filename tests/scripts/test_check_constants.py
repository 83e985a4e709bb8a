"""Tests of check_constants.py: it finds each inserted offence, and none in a sound tree."""
import contextlib
import csv
import io
import os
import tempfile
import unittest

import check_constants

SETTINGS = """name,unit,default,min,max,meaning,source
rate,Hz,50,10,100,Tick rate,design
heat,K,0.09,0,1,A threshold,"Kenshalo 1968, p. 11"
"""
MATERIALS = ("name,youngs_modulus_Pa,poissons_ratio,density_kg_m3,rayleigh_alpha_1_s,rayleigh_beta_s,friction_static,friction_dynamic,restitution,"
             "conductivity_W_mK,specific_heat_J_kgK,temperature_degC,elastic_source,damping_source,surface_source,thermal_source\n"
             "steel,2e11,0.29,7850,5,3e-8,0.7,0.5,0.6,60,434,23,Incropera,design,design: ground,design\n")
CPP = """// Heights of finishes by ISO 1302.
constexpr Finish kFinishes[] = {
    {2.0e11, 1.6e-6},  // steel
    {7.0e10, 0.8e-6},  // glass
};

// Design: steps of the picture.
constexpr std::array kSteps{1.0, 0.5, 0.25, 0.125};

constexpr int kOrder[] = {3, 1, 2, 0};
"""
STUDY = '<study><observer><parameter name="pss" value="19" source="Kaaresoja 2014"/><parameter name="guess" value="0" source="design"/></observer></study>'


class Checker(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        self.write("thermal_node/settings.csv", SETTINGS)
        self.write("sim_node/scenes/materials.csv", MATERIALS)
        self.write("audio_node/finish.cpp", CPP)
        self.write("scripts/studies/study.xml", STUDY)
        self.rows = [[t, c, v, "unverified", ""] for t, c, v, s in check_constants.constants(self.root) if not check_constants.is_own(s)]
        self.register()

    def write(self, path, text):
        path = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def register(self):
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([check_constants.COLUMNS, *self.rows])
        self.write("docs/constants.csv", text.getvalue())

    def check(self, *parts):
        found = check_constants.offences(self.root)
        self.assertEqual(len(parts), len(found), found)
        for part, offence in zip(parts, found):
            self.assertIn(part, offence)

    def test_a_sound_tree_is_clean_and_own_choices_need_no_entry(self):
        self.check()
        self.assertEqual([row[1] for row in self.rows], ["heat", "steel, elastic", "pss", "kFinishes"])

    def test_a_new_setting_with_an_unchecked_source_is_found(self):
        self.write("thermal_node/settings.csv", SETTINGS + "cold,K,0.05,0,1,A threshold,Jones 2009\n")
        self.check("cold = 0.05 has an unchecked source")

    def test_a_design_value_that_rests_on_a_citation_is_found(self):
        self.write("thermal_node/settings.csv", SETTINGS.replace("Tick rate,design", "Tick rate,design: below Vogels 2004"))
        self.check("rate = 50 has an unchecked source")

    def test_a_constant_without_a_source_is_found(self):
        self.write("thermal_node/settings.csv", SETTINGS + "cold,K,0.05,0,1,A threshold,\n")
        self.check("cold has no source")

    def test_a_changed_value_is_found(self):
        self.write("thermal_node/settings.csv", SETTINGS.replace("0.09", "0.07"))
        self.check("heat was checked as 0.09 and is 0.07")

    def test_a_changed_material_is_found(self):
        self.write("sim_node/scenes/materials.csv", MATERIALS.replace("0.29,7850", "0.28,7850"))
        self.check("steel, elastic was checked as 2e11 0.29 7850 and is 2e11 0.28 7850")

    def test_a_new_material_is_found_in_each_of_its_groups(self):
        self.write("sim_node/scenes/materials.csv", MATERIALS + "tin,5e10,0.36,7300,5,1e-7,0.7,0.5,0.4,67,227,23,Handbook,Rossing 1998,design,Incropera\n")
        self.check("tin, elastic", "tin, damping", "tin, thermal")

    def test_a_new_threshold_is_found(self):
        self.write("sync/presentation/thresholds.csv", "earlier,later,threshold_ms,what,situation,source\nhaptic,audio,24,noticed,tap,Adelstein 2003\n")
        self.check("haptic, audio, noticed, Adelstein 2003 = 24 has an unchecked source")

    def test_a_changed_table_in_c_is_found_and_a_comment_in_it_is_not(self):
        self.write("audio_node/finish.cpp", CPP.replace("// glass", "// float glass"))
        self.check()
        self.write("audio_node/finish.cpp", CPP.replace("0.8e-6", "0.9e-6"))
        self.check("kFinishes was checked as")

    def test_a_new_table_in_c_without_a_source_is_found(self):
        self.write("audio_node/roots.h", "constexpr double kRoots[4]{4.73, 7.85, 10.99, 14.13};\n")
        self.check("audio_node/roots.h: kRoots has no source")

    def test_a_new_parameter_of_a_study_is_found(self):
        self.write("scripts/studies/study.xml", STUDY.replace("</observer>", '<parameter name="sd" value="80" source="the same 2014"/></observer>'))
        self.check("sd = 80 has an unchecked source")

    def test_a_new_table_that_is_not_listed_is_found(self):
        self.write("visual_node/eyes.csv", "distance\n0.064\n")
        self.check("visual_node/eyes.csv: this table is not listed")

    def test_a_row_of_the_register_without_a_constant_is_found(self):
        self.rows.append(["thermal_node/settings.csv", "gone", "1", "unverified", ""])
        self.register()
        self.check("there is no constant gone")

    def test_a_status_that_does_not_exist_and_a_check_without_evidence_are_found(self):
        self.rows[0][3], self.rows[1][3] = "trusted", "read"
        self.register()
        self.check("the status 'trusted' is none of", "steel, elastic is read without evidence")

    def test_two_rows_of_one_constant_are_found(self):
        self.rows.append(self.rows[0])
        self.register()
        self.check("heat has two rows")

    def test_a_missing_register_is_found(self):
        os.remove(os.path.join(self.root, "docs/constants.csv"))
        self.check("docs/constants.csv: is missing")

    def test_the_list_names_what_needs_an_entry(self):
        text = io.StringIO()
        arguments, check_constants.sys.argv = check_constants.sys.argv, ["check_constants.py", self.root, "--list"]
        try:
            with contextlib.redirect_stdout(text):
                self.assertEqual(check_constants.main(), 0)
        finally:
            check_constants.sys.argv = arguments
        self.assertEqual([row[1] for row in csv.reader(text.getvalue().splitlines())], [row[1] for row in self.rows])


if __name__ == "__main__":
    unittest.main()
