// Measured modes: the attribute of <tactus:material> that refers to them, and their transfer into the scene.
#include <string_view>
#include <tactus/material_def_t.hpp>

#include "sim_node/model/measured_modes.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

// Format of tactus analyse-modes; a cell is empty where one of its two methods found no value.
const std::string kTable =
    "frequency_Hz,damping_1_s,amplitude,decay_frequency_Hz,decay_damping_1_s,agrees\n"
    "900.25,5,0.4,,,0\r\n440.5,3.5,0.2,440.4,3.4,1\n";

SceneFile scene(const std::string& table, const std::string& materials =
                                              "<tactus:material name='bell' base='copper' modes='bell.csv'/>"
                                              "<tactus:material name='dark' base='bell' density='900'/>") {
  return SceneFile(world(materials), {{"bell.csv", {table.begin(), table.end()}}});
}

const material_def_t& material(const WorldDef& w, std::string_view name) {
  for (const auto& m : w.materials)
    if (m.name == name) return m;
  FAIL("no material " << name);
  return w.materials.front();
}

}  // namespace

TEST_CASE("A material has the measured modes of its table in ascending order") {
  SceneFile file = scene(kTable);
  const WorldDef w = file.load();
  for (const char* name : {"bell", "dark"}) {
    const material_def_t& m = material(w, name);
    REQUIRE(m.mode_count == 2);
    REQUIRE(m.modes.size() == 2);
    CHECK(m.modes[0].frequency_Hz == 440.5);
    CHECK(m.modes[0].damping_1_s == 3.5);
    CHECK(m.modes[0].amplitude == 0.2);
    CHECK(m.modes[1].frequency_Hz == 900.25);
  }
  CHECK(material(w, "copper").mode_count == 0);
}

TEST_CASE("An invalid table of modes is rejected with the line of the scene and its row") {
  const auto expect_rejection = [](const std::string& table, const std::string& because) {
    SceneFile file = scene(table);
    CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:3: ") &&
                                   Catch::Contains("modes \"bell.csv\", which cannot be read: " + because));
  };
  const std::string header = "frequency_Hz,damping_1_s,amplitude\n";
  expect_rejection("", "it has no modes");
  expect_rejection(header, "it has no modes");
  expect_rejection("frequency_Hz,amplitude\n440,1\n", "row 1: column damping_1_s is missing");
  expect_rejection(header + "440,3,1\n440,3\n", "row 3: amplitude is missing");
  expect_rejection(header + "440,3,loud\n", "row 2: amplitude: ");
  expect_rejection(header + "10,3,1\n", "row 2: frequency_Hz is not between 20 and 20000");
  expect_rejection(header + "440,-3,1\n", "row 2: damping_1_s is not above 0");
  expect_rejection(header + "440,3000,1\n", "row 2: damping_1_s is not above 0 and below critical damping");
  expect_rejection(header + "440,3,0\n", "row 2: amplitude is not above 0");
  expect_rejection(header + "nan,3,1\n", "row 2: frequency_Hz");
  std::string many = header;
  for (int i = 0; i < 129; ++i) many += "440,3,1\n";
  expect_rejection(many, "it has more than 128 modes");
  SceneFile absent(world("<tactus:material name='bell' base='copper' modes='nowhere.csv'/>"));
  CHECK_THAT(absent.load_error(), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("not found"));
}
