// Tests of a degradation profile in a running cluster.
#include <algorithm>
#include <fstream>
#include <sstream>
#include <tactus/presentation_t.hpp>

#include "tests/cluster/support/profiles.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

int count_outcomes(const ClusterMonitor& monitor, const std::string& modality, std::int8_t outcome) {
  const auto reports = monitor.presented().find(modality);
  if (reports == monitor.presented().end()) return 0;
  return static_cast<int>(std::count_if(reports->second.begin(), reports->second.end(),
                                        [&](const auto& r) { return r.second.outcome == outcome; }));
}

}  // namespace

TEST_CASE("A profile put in force in a running cluster degrades only its modality, and can be removed") {
  RunningCluster c;
  c.start();
  const auto before = c.rates(1);
  CHECK(put_in_force(c, "<degrade modality=\"audio\" off=\"true\"/>").find("audio_node") != std::string::npos);

  CHECK(c.monitor.wait_until([&] { return count_outcomes(c.monitor, "audio", presentation_t::DROPPED_BY_PROFILE) >= 3; },
                         kTimeout_s));
  for (const std::string& other : std::vector<std::string>{"haptic", "visual"})
    CHECK(count_outcomes(c.monitor, other, presentation_t::DROPPED_BY_PROFILE) == 0);
  // A gap that the profile commands is no loss, and the node itself is healthy.
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
  c.check_rates_hold(before, 2);

  put_in_force(c, "");
  const int presented = count_outcomes(c.monitor, "audio", presentation_t::PRESENTED);
  CHECK(
      c.monitor.wait_until([&] { return count_outcomes(c.monitor, "audio", presentation_t::PRESENTED) > presented; }, kTimeout_s));
}

TEST_CASE("The profile of a scene degrades the modality that it names and no other, until a user removes it") {
  RunningCluster c;
  std::stringstream text;
  text << std::ifstream(tapping_scene()).rdbuf();
  std::string scene = text.str();
  scene.insert(
      scene.find("<gravity>"),
      "<tactus:profile name=\"silence\"><tactus:degrade modality=\"audio\" off=\"true\"/></tactus:profile>\n");
  const std::string file = c.folder.path() / "silent.sdf";
  std::ofstream(file) << scene;
  c.processes.start_all(file);
  const auto dropped = [&] { return count_outcomes(c.monitor, "audio", presentation_t::DROPPED_BY_PROFILE); };
  const auto presented = [&] { return count_outcomes(c.monitor, "audio", presentation_t::PRESENTED); };
  CHECK(c.monitor.wait_until(
      [&] { return dropped() >= 3 && count_outcomes(c.monitor, "haptic", presentation_t::PRESENTED) >= 3; }, kTimeout_s));
  INFO(c.log_text());
  CHECK(presented() == 0);
  CHECK(count_outcomes(c.monitor, "visual", presentation_t::DROPPED_BY_PROFILE) == 0);
  put_in_force(c, "");
  CHECK(c.monitor.wait_until([&] { return presented() > 0; }, kTimeout_s));
}
