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

TEST_CASE("Every known frame keeps its grip in all of its workspace") {
  for (const std::string& name : known_frames()) CHECK_NOTHROW(check_frame(*known_frame(name)));
  CHECK_FALSE(known_frame("phantom"));
}

TEST_CASE("A frame of which no device can be made is refused in one sentence") {
  const auto refused = [](const StringFrame& f, const std::string& what) {
    CHECK_THROWS_WITH(check_frame(f), Contains("string frame \"") && Contains(what));
  };
  refused(changed("desktop", [](auto& f) { f.strings.pop_back(); }), "3 strings");
  refused(changed("desktop", [](auto& f) { f.strings.clear(); }), "0 strings");
  refused(changed("desktop", [](auto& f) { f.strings[1].anchor_m = f.strings[0].anchor_m; }), "from one place");
  refused(changed("desktop", [](auto& f) { f.strings[3].knot_m.x() = 0.01; }), "one point");
  refused(changed("desktop", [](auto& f) { f.strings[3].anchor_m.x() = NAN; }), "anchor");
  refused(changed("desktop",
                  [](auto& f) {
                    for (auto& s : f.strings) s.anchor_m.z() = 0.2;
                  }),
          "leave a direction free");
  refused(changed("desktop", [](auto& f) { f.workspace_radius_m = 0.2; }), "make the workspace smaller");
  refused(changed("desktop", [](auto& f) { f.workspace_radius_m = 2; }), "inside the workspace");
  refused(changed("desktop8",
                  [](auto& f) {
                    for (auto& s : f.strings) s.knot_m.setZero();
                  }),
          "leave a direction free");
  refused(changed("desktop8", [](auto& f) { f.workspace_tilt_rad = 1; }), "tilted by 1 rad");
  refused(changed("desktop8", [](auto& f) { f.max_tension_N = 0.1; }), "max_tension_N is 0.1");
  refused(changed("cave", [](auto& f) { f.min_tension_N = 0; }), "min_tension_N is 0;");
  refused(changed("cave", [](auto& f) { f.encoder_step_m = NAN; }), "encoder_step_m");
}

TEST_CASE("A frame is read from a file, and what is wrong with it is said in one sentence") {
  const StringFrame f = parse_frame(kFile, "mine.json");
  CHECK(f.size() == 4);
  CHECK(f.strings[1].anchor_m == Vector3d(-0.3, -0.3, 0.3));
  CHECK(f.max_tension_N == 20);
  CHECK(f.name == "mine.json");
  const auto refused = [](const std::string& text, const std::string& what) {
    CHECK_THROWS_WITH(parse_frame(text, "mine.json"), Contains("mine.json") && Contains(what));
  };
  refused("", "no JSON object");
  refused("[1, 2]", "no JSON object");
  refused(with("\"max_tension_N\": 20,", ""), "lacks \"max_tension_N\"");
  refused(with("max_tension_N", "max_force_N"), "no field \"max_force_N\"");
  refused(with("20", "\"strong\""), "\"max_tension_N\" is no number");
  refused(with("[0.3, 0.3, 0.3]", "[0.3, 0.3]"), "[x, y, z]");
  refused(with("\"anchor_m\": [0.3, 0.3, 0.3]", ""), "needs its \"anchor_m\"");
  refused(with("[0.3, 0.3, 0.3]}", "[0.3, 0.3, 0.3], \"colour\": 1}"), "no \"colour\"");
  refused(with("0.1", "1e308"), "workspace_radius_m");
  CHECK_THROWS_WITH(read_frame("/no/such.json"), Contains("no regular file"));
}
