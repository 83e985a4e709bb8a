#include "haptic_node/devices/spidar/string_frame.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "haptic_node/devices/spidar/frame_file.h"

using namespace tactus::haptic;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

StringFrame changed(const char* name, const std::function<void(StringFrame&)>& change) {
  StringFrame f = *known_frame(name);
  change(f);
  return f;
}

const char* const kFile = R"({"min_tension_N": 0.5, "max_tension_N": 20, "encoder_step_m": 3e-5,
  "winding_speed_m_s": 4, "tension_time_s": 0.0005, "workspace_radius_m": 0.1,
  "strings": [{"anchor_m": [0.3, 0.3, 0.3]}, {"anchor_m": [-0.3, -0.3, 0.3]},
              {"anchor_m": [-0.3, 0.3, -0.3]}, {"anchor_m": [0.3, -0.3, -0.3]}]})";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kFile;
  text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace

TEST_CASE("Every known frame holds its grip in its whole workspace") {
  for (const std::string& name : known_frames()) CHECK_NOTHROW(check_frame(*known_frame(name)));
  CHECK_FALSE(known_frame("phantom"));
}

TEST_CASE("An unusable frame is rejected in one sentence") {
  const auto rejected = [](const StringFrame& f, const std::string& what) {
    CHECK_THROWS_WITH(check_frame(f), Contains("string frame \"") && Contains(what));
  };
  rejected(changed("desktop", [](auto& f) { f.strings.pop_back(); }), "3 strings");
  rejected(changed("desktop", [](auto& f) { f.strings.clear(); }), "0 strings");
  rejected(changed("desktop", [](auto& f) { f.strings[1].anchor_m = f.strings[0].anchor_m; }), "have one anchor");
  rejected(changed("desktop", [](auto& f) { f.strings[3].knot_m.x() = 0.01; }), "one point");
  rejected(changed("desktop", [](auto& f) { f.strings[3].anchor_m.x() = NAN; }), "anchor");
  rejected(changed("desktop",
                   [](auto& f) {
                     for (auto& s : f.strings) s.anchor_m.z() = 0.2;
                   }),
           "leave a direction free");
  rejected(changed("desktop", [](auto& f) { f.workspace_radius_m = 0.2; }), "make the workspace smaller");
  rejected(changed("desktop", [](auto& f) { f.workspace_radius_m = 2; }), "inside the workspace");
  rejected(changed("desktop8",
                   [](auto& f) {
                     for (auto& s : f.strings) s.knot_m.setZero();
                   }),
           "leave a direction free");
  rejected(changed("desktop8", [](auto& f) { f.workspace_tilt_rad = 1; }), "tilted by 1 rad");
  rejected(changed("desktop8", [](auto& f) { f.max_tension_N = 0.1; }), "max_tension_N is 0.1");
  rejected(changed("cave", [](auto& f) { f.min_tension_N = 0; }), "min_tension_N is 0;");
  rejected(changed("cave", [](auto& f) { f.encoder_step_m = NAN; }), "encoder_step_m");
}

TEST_CASE("A frame is read from a file, and an error is reported in one sentence") {
  const StringFrame f = parse_frame(kFile, "mine.json");
  CHECK(f.size() == 4);
  CHECK(f.strings[1].anchor_m == Vector3d(-0.3, -0.3, 0.3));
  CHECK(f.max_tension_N == 20);
  CHECK(f.name == "mine.json");
  const auto rejected = [](const std::string& text, const std::string& what) {
    CHECK_THROWS_WITH(parse_frame(text, "mine.json"), Contains("mine.json") && Contains(what));
  };
  rejected("", "not a JSON object");
  rejected("[1, 2]", "not a JSON object");
  rejected(with("\"max_tension_N\": 20,", ""), "lacks \"max_tension_N\"");
  rejected(with("max_tension_N", "max_force_N"), "no field \"max_force_N\"");
  rejected(with("20", "\"strong\""), "\"max_tension_N\" is not a number");
  rejected(with("[0.3, 0.3, 0.3]", "[0.3, 0.3]"), "[x, y, z]");
  rejected(with("\"anchor_m\": [0.3, 0.3, 0.3]", ""), "needs its \"anchor_m\"");
  rejected(with("[0.3, 0.3, 0.3]}", "[0.3, 0.3, 0.3], \"colour\": 1}"), "no \"colour\"");
  rejected(with("0.1", "1e308"), "workspace_radius_m");
  CHECK_THROWS_WITH(read_frame("/no/such.json"), Contains("does not exist"));
}
