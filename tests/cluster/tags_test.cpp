// Tests of tagged variables in a running cluster: sampled on request, and driving settings of other nodes.
#include <cmath>
#include <fstream>
#include <sstream>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "sync/node/tag_table.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

struct TagCluster : RunningCluster {
  sync::Queue<tag_list_t>& lists = monitor.bus().queue<tag_list_t>(channels::kTagList, 1024);
  sync::Queue<tag_values_t>& values = monitor.bus().queue<tag_values_t>(channels::kTagValues, 65536);
  sync::TagTable table;
  struct Series {
    std::string unit;
    std::vector<double> values;
    std::int64_t first_ns = 0, last_ns = 0;
  };
  std::map<std::string, Series> series;  // by "node.tag"
  std::int64_t messages = 0;

  // Receives for the given time; requests the pattern once per second.
  void receive_for(double seconds, const std::string& pattern = "") {
    for (double left = seconds; left > 0; left -= 0.5) {
      if (!pattern.empty()) {
        tag_request_t request{};
        request.header.sim_time_ns = -1;
        request.patterns = {pattern}, request.pattern_count = 1;
        monitor.bus().publish(channels::kTagRequest, request);
      }
      monitor.receive_for(0.5);
      while (const auto m = lists.pop()) table.push(m->message);
      while (const auto m = values.pop()) {
        ++messages;
        table.read(m->message,
                   [&](const sync::TagTable::List& list, const tag_def_t& tag, std::int64_t t, double value) {
                     Series& s = series[list.node + "." + tag.name];
                     s.unit = tag.unit;
                     if (s.values.empty()) s.first_ns = t;
                     s.last_ns = t;
                     s.values.push_back(value);
                   });
      }
    }
  }
  double rate_Hz(const std::string& name) {
    const Series& s = series[name];
    return s.values.size() < 2
               ? 0
               : static_cast<double>(s.values.size() - 1) / (static_cast<double>(s.last_ns - s.first_ns) * 1e-9);
  }
};

// The small scene with one more element in its world.
std::string scene_with(const Folder& folder, const std::string& element) {
  std::ifstream file(tapping_scene());
  std::stringstream text;
  text << file.rdbuf();
  std::string scene = text.str();
  scene.insert(scene.find("</world>"), element);
  const std::string path = folder.path() / "mapped.sdf";
  std::ofstream(path) << scene;
  return path;
}

}  // namespace

TEST_CASE("Every node publishes its requested variables at each of its ticks, and stops when no request is active") {
  TagCluster c;
  c.start();
  c.receive_for(2);
  CHECK(c.messages == 0);
  c.receive_for(4, "*");
  for (const std::string& node : kNodes) {
    INFO(node << "\n" << c.log_text());
    CHECK(c.series[node + ".work"].unit == "us");
    CHECK(c.series[node + ".work.decode"].values.size() > 100);
  }
  // Within a factor of two of their rates: the machine may be busy.
  CHECK(c.rate_Hz("sim_node.work.collision") > 500);
  CHECK(c.rate_Hz("haptic_node.force") > 500);
  CHECK(c.rate_Hz("thermal_node.skin") > 10);
  CHECK(c.rate_Hz("thermal_node.skin") < 100);
  CHECK(c.rate_Hz("visual_node.work.render") > 2);
  CHECK(c.series["haptic_node.force"].unit == "N");
  const auto max = [&](const std::string& name) {
    const auto& v = c.series[name].values;
    return v.empty() ? -1 : *std::max_element(v.begin(), v.end());
  };
  CHECK(max("haptic_node.force") > 1);  // the hand taps
  for (const char* phase : {"collision", "solve", "integrate", "decode", "other"}) {
    INFO(phase);
    CHECK(max(std::string("sim_node.work.") + phase) > 0);
  }
  // Phases are parts of the whole tick.
  const auto sum = [&](const std::string& name) {
    double total = 0;
    for (const double x : c.series[name].values) total += x;
    return total;
  };
  double parts = 0;
  for (const char* phase : {"collision", "solve", "integrate", "decode", "other"})
    parts += sum(std::string("sim_node.work.") + phase);
  const double whole = sum("sim_node.work");
  CHECK(parts > 0.8 * whole);
  CHECK(parts < 1.2 * whole);

  c.receive_for(4);
  const std::int64_t before = c.messages;
  c.receive_for(2);
  CHECK(c.messages == before);
}

TEST_CASE("One line of a scene makes the sound level weaken the felt vibration") {
  TagCluster c;
  // Each hit that sounded reduces the largest force by half a newton, down to half a newton.
  c.processes.start_all(scene_with(
      c.folder,
      "<tactus:map from='audio_node.hits' to='haptic_node.force_limit' gain='-0.5' offset='8N' low='0.5N'/>"));
  REQUIRE(c.monitor.wait_until([&] { return c.all_running(kNodes) && c.monitor.hits() > 0; }, kTimeout_s));
  const auto is_limited = [&] {
    c.receive_for(2, "*");
    const auto& forces = c.series["haptic_node.force"].values;
    const double max = *std::max_element(forces.end() - 1000, forces.end());
    return max > 0.4 && max <= 0.5 + 1e-6;
  };
  bool limited = false;
  for (int tries = 0; tries < 20 && !limited; ++tries) limited = is_limited();
  INFO(c.log_text());
  CHECK(limited);
  const auto& hits = c.series["audio_node.hits"].values;
  REQUIRE_FALSE(hits.empty());
  CHECK(hits.back() >= 15);  // 8 N - 15 * 0.5 N
}
