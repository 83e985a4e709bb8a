// Cost of one tick of touch: a hand that moves and presses among the given number of planes, with a touch model that is fresh each tick,
// each millisecond, or once only. proxy: a ball, in three degrees of freedom; rigid: a tool with a shape, in six, surrounded by the
// planes.
//
//    bin/servo_bench [--ticks N] [--json FILE]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sync/node/node_options.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

enum class Fresh { kEachTick, kEachMs, kOnce };
constexpr const char* kName[] = {"each tick", "each ms", "once"};

// The tangent planes of a cup of 20 mm around a tool of 5 mm, about its pole: all are near, and the pressed ones change as the hand moves
// around. Half of them slide and rotate, as those of moving bodies do.
std::vector<touch_plane_t> cup(int count, bool rigid) {
  std::vector<touch_plane_t> planes;
  const double golden = M_PI * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double up = 1 - 0.9 * (i + 0.5) / count, r = std::sqrt(1 - up * up);
    const Vector3d n(r * std::cos(golden * i), r * std::sin(golden * i), up);
    touch_plane_t p = plane(i + 1, -0.02 * n, n, 0.3);
    if (i % 2 == 0) p.velocity_m_s.x = 0.01f, p.angular_velocity_rad_s.z = 0.1f;
    // With a shape: the same number of points as planes, on a ball of the same size that is a little longer than wide.
    if (rigid) p.tool_point_m = to_vec3f(Vector3d(-0.005 * n.x(), -0.005 * n.y(), -0.008 * n.z()));
    planes.push_back(p);
  }
  return planes;
}

struct Figures {
  double median_us = 0, p99_us = 0, mean_force_N = 0, mean_pressed = 0;
};

Figures measure(int planes, double rate_Hz, Fresh fresh, int ticks, bool rigid) {
  Settings settings;
  settings.rate_Hz = rate_Hz;
  scene_t with_tool = scene();
  if (rigid) with_tool.tools[0].shape = tool_def_t::MESH;
  Bench bench(settings, with_tool);
  std::vector<double> us;
  us.reserve(static_cast<std::size_t>(ticks));
  Figures out;
  touch_model_t m = model(0, cup(planes, rigid));
  const int warm_up = 200;
  int last_ms = -1;
  for (int i = 0; i < ticks + warm_up; ++i) {
    const double ms = 1000 * i / rate_Hz, angle = 2 * M_PI * ms * 1e-3;  // once around a second
    // 3 mm beyond the room that the cup leaves for the tool, so that the spring is stretched all the time.
    const Vector3d device = 0.018 * Vector3d(0.6 * std::cos(angle), 0.6 * std::sin(angle), -0.8);
    const bool new_model =
        i == 0 || fresh == Fresh::kEachTick || (fresh == Fresh::kEachMs && static_cast<int>(ms) != last_ms);
    last_ms = static_cast<int>(ms);
    if (new_model) m.header.sim_time_ns = static_cast<std::int64_t>(ms * 1e6);
    // Only the arrival time is renewed, because the model would count as lost otherwise.
    bench.arrival = host_ms(ms);
    const auto begin = std::chrono::steady_clock::now();
    TickInput in;
    if (rigid) in.device.orientation = Eigen::AngleAxisd(0.1 * std::sin(angle), Vector3d::UnitX());
    const TickOutput& tick = bench.tick(ms, device, new_model ? &m : nullptr, {}, in);
    const double took =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    if (i < warm_up) continue;
    us.push_back(took);
    out.mean_force_N += tick.force_N.norm() / ticks;
    out.mean_pressed += static_cast<double>(std::count_if(
                            tick.state.constraints.begin(), tick.state.constraints.end(),
                            [](const tool_constraint_t& c) { return to_eigen(c.force_N).norm() > 0; })) /
                        ticks;
  }
  std::sort(us.begin(), us.end());
  out.median_us = us[us.size() / 2];
  out.p99_us = us[us.size() * 99 / 100];
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json;
  int ticks = 20000;
  tactus::sync::Arguments app{"Cost of one tick of touch."};
  app.add_option("--ticks", ticks, "of each row").range(100, 10000000);
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "servo_bench", argc, argv);
  std::printf("%8s %8s %8s %12s %12s %12s %10s %10s\n", "tool", "planes", "Hz", "model", "median us", "p99 us",
              "force N", "pressed");
  nlohmann::json out = nlohmann::json::array();
  for (const bool rigid : {false, true})
    for (const int planes : {1, 3, 8, 20, 50})
      for (const double rate_Hz : {1000.0, 2000.0, 4000.0})
        for (const Fresh fresh : {Fresh::kEachTick, Fresh::kEachMs, Fresh::kOnce}) {
          if (rate_Hz == 1000 && fresh == Fresh::kEachMs) continue;  // the same as each tick
          const Figures f = measure(planes, rate_Hz, fresh, ticks, rigid);
          const char* name = kName[static_cast<int>(fresh)];
          std::printf("%8s %8d %8.0f %12s %12.2f %12.2f %10.2f %10.2f\n", rigid ? "rigid" : "proxy", planes,
                      rate_Hz, name, f.median_us, f.p99_us, f.mean_force_N, f.mean_pressed);
          out.push_back({{"rendering", rigid ? "rigid" : "proxy"},
                         {"planes", planes},
                         {"rate_Hz", rate_Hz},
                         {"model", name},
                         {"median_us", f.median_us},
                         {"p99_us", f.p99_us},
                         {"mean_force_N", f.mean_force_N},
                         {"mean_pressed", f.mean_pressed}});
        }
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return 0;
}
