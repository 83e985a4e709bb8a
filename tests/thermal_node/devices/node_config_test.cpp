#include "thermal_node/devices/node_config.h"

#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/setting_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "tests/thermal_node/support/node_config.h"

using namespace tactus;

namespace {
scene_t scene_with(std::vector<std::string> tools) {
  scene_t scene{};
  for (const std::string& name : tools) {
    tool_def_t tool{};
    tool.name = name;
    tool.body = 10 + static_cast<int>(scene.tools.size());
    scene.tools.push_back(tool);
  }
  scene.tool_count = static_cast<int>(tools.size());
  return scene;
}
}  // namespace

TEST_CASE("The first tool is selected unless another is named") {
  scene_t scene = scene_with({"hand", "foot"});
  CHECK(thermal::resolve_config(scene, "", {}).tool == 0);
  CHECK(thermal::resolve_config(scene, "foot", {}).tool == 1);
  CHECK(thermal::resolve_config(scene, "foot", {}).tool_body == 11);
  SECTION("The command line overrides the tool of the scene") {
    setting_t s{};
    s.node = "thermal_node", s.name = "tool", s.value = "foot";
    scene.settings = {s};
    CHECK(thermal::resolve_config(scene, "", {}).tool == 1);
    CHECK(thermal::resolve_config(scene, "hand", {}).tool == 0);
  }
}

TEST_CASE("An unknown tool is reported with a remedy") {
  const auto none = thermal::resolve_config(scene_with({}), "", {});
  CHECK(none.tool == -1);
  CHECK_FALSE(none.problem.empty());
  const auto other = thermal::resolve_config(scene_with({"hand", "foot"}), "nose", {});
  CHECK(other.tool == -1);
  CHECK(other.problem.find("hand, foot") != std::string::npos);
}

TEST_CASE("A scene cannot widen the skin-safe range or the slew limit, the command line can") {
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"temperature_min", "10"}, {"temperature_max", "43"}, {"slew_max", "300"}}) {
    INFO(name);
    scene_t scene = scene_with({"hand"});
    setting_t s{};
    s.node = "thermal_node", s.name = name, s.value = value;
    scene.settings = {s};
    const auto config = thermal::resolve_config(scene, "", {});
    const auto rejected = thermal::rejected_settings(scene, {});
    REQUIRE(rejected.size() == 1);
    CHECK(rejected[0].find("only tighten") != std::string::npos);
    CHECK(config.settings.temperature_min_degC == 15);
    CHECK(config.settings.temperature_max_degC == 42);
    CHECK(config.settings.slew_max_K_s == 20);
    CHECK(thermal::rejected_settings(scene_with({"hand"}), {name + "=" + value}).empty());
  }
}

TEST_CASE("Settings come from the scene and the command line, and invalid ones are rejected with a sentence") {
  scene_t scene = scene_with({"hand"});
  setting_t s{};
  s.node = "thermal_node", s.name = "rate", s.value = "100 Hz";
  scene.settings = {s};
  CHECK(thermal::resolve_config(scene, "", {}).settings.rate_Hz == 100);
  CHECK(thermal::resolve_config(scene, "", {"rate=20"}).settings.rate_Hz == 20);
  for (const char* wrong : {"rate=5000", "rate=fast", "colour=red", "temperature_max=60", "temperature_min=-5"}) {
    const auto config = thermal::resolve_config(scene, "", {wrong});
    INFO(wrong);
    CHECK(thermal::rejected_settings(scene, {wrong}).size() == 1);
    CHECK(config.settings.rate_Hz == 100);
    CHECK(config.settings.temperature_max_degC == 42);
  }
}
