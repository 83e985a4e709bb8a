// The sound of lasting contacts depends on the world, and not on the phase of the ticks, which a log does not contain.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "tests/audio_node/support/offline_program.h"
#include "tests/audio_node/support/recorded_run.h"

using namespace tactus;
using namespace tactus::audio::test;

namespace {

constexpr int kRate = 48000, kWindow = kRate / 20;

// The ball slides over the board at a speed that rises and falls, under a force that varies.
contact_t sliding_at(double t) {
  contact_t c{};
  c.contact_id = 5, c.kind = contact_t::SURFACE;
  c.body_a = 0, c.body_b = 2, c.material_a = 0, c.material_b = 2, c.tool = -1;
  c.normal.z = 1;
  c.normal_force_N = static_cast<float>(2 + std::sin(5 * t));
  c.sliding_velocity_m_s.x = static_cast<float>(0.2 + 0.1 * std::sin(3 * t));
  contact_point_t p{};
  const auto x = static_cast<float>(-0.2 + 0.2 * t + 0.1 / 3 * (1 - std::cos(3 * t)));  // its integral
  p.a_body_m.x = p.a_world_m.x = p.b_world_m.x = x;
  p.b_body_m.z = -0.05f;
  c.points = {p}, c.point_count = 1;
  return c;
}

// A run of which each message came this much later than the time of the world.
void record(const std::string& path, std::int64_t later_ns) {
  scene_t scene = struck_scene();
  for (material_def_t& m : scene.materials) m.friction_static = m.friction_dynamic = 0.4;
  RecordedRun run(std::make_unique<sync::FileSink>(path), scene);
  for (int ms = 0; ms < 2000; ++ms) {
    contact_frame_t m{};
    const std::int64_t sim_ns = std::int64_t{ms} * 1'000'000, host_ns = kLogBegins_ns + sim_ns + later_ns;
    m.header = {sim_ns, host_ns, 4711, 7, 9, 21, ms};
    m.clock = {sim_ns, host_ns, 1};
    m.pages = 1, m.count = 1, m.contacts = {sliding_at(ms * 1e-3)};
    run.write_raw(static_cast<double>(sim_ns + later_ns) * 1e-9, channels::kContacts, sync::encode(m));
  }
  run.finish();
}

double rms(const float* x, const float* minus, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += std::pow(static_cast<double>(x[i]) - (minus ? static_cast<double>(minus[i]) : 0), 2);
  return std::sqrt(sum / n);
}

}  // namespace

// Whole samples apart, so that both sounds have the same sampling instants: 18 samples are 0.375 of a tick, and not a multiple of
// a block.
TEST_CASE("A scraping sound does not depend on the phase of the ticks") {
  const Folder folder;
  std::vector<float> sounds[2];
  for (const int i : {0, 1}) {
    const std::string log = folder.file("run" + std::to_string(i) + ".lcmlog"), wav = folder.file("a" + std::to_string(i) + ".wav");
    record(log, i * 375'000);
    const Done done = render(folder, {"--log", log, "--wav", wav, "--set", "spatial=stereo", "--set", "instructions=sse2"});
    CAPTURE(done.message);
    REQUIRE(done.status == 0);
    sounds[i] = mono_of(wav);
  }
  REQUIRE(sounds[1].size() >= sounds[0].size());
  int windows = 0;
  double level = 0, difference = 0;
  // From 0.3 s on: the begin of a contact follows its place within some 20 ms.
  for (int at = 3 * kRate / 10; at + kWindow < 19 * kRate / 10; at += kWindow, ++windows) {
    const float *x = sounds[0].data() + at, *y = sounds[1].data() + at + 18;
    const double one = rms(x, nullptr, kWindow), other = rms(y, nullptr, kWindow);
    REQUIRE(one > 1e-5);
    level = std::max(level, std::abs(one - other) / one);
    difference = std::max(difference, rms(x, y, kWindow) / one);
  }
  CAPTURE(windows, level, difference);
  CHECK(level < 0.02);
  CHECK(difference < 0.03);
}
