// Cost of a sliding or rolling contact: of the audio callback per block of 64 frames, and of the node's loop per tick.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/mixer/scrapes.h"
#include "audio_node/excitation/sliding.h"
#include "lcmtypes/vectors.h"
#include "sync/node/node_options.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr double kRate_Hz = 48000;
constexpr int kFrames = kMaxBlock;

// A relief of 512 x 512 pixels of 0.2 mm, and a friction map of the same size.
HeightMap heights() {
  HeightMap map{512, 512, 65535, {}};
  for (int i = 0; i < 512 * 512; ++i) map.levels.push_back(static_cast<std::uint16_t>((i * 2654435761u) >> 16));
  return map;
}

struct Row {
  std::string what;
  int contacts;
  bool mapped, friction, rolls;
};

// Median and 99th percentile, us.
std::pair<double, double> figures(std::vector<double> us) {
  std::sort(us.begin(), us.end());
  return {us[us.size() / 2], us[us.size() * 99 / 100]};
}

scene_t floor_and_balls(int balls) {
  scene_t s{};
  s.materials.resize(1), s.material_count = 1;
  s.materials[0].friction_dynamic = 0.5;
  for (int i = 0; i <= balls; ++i) {
    body_def_t body{};
    body.id = i, body.tool = -1, body.is_static = i == 0, body.mass_kg = 1;
    body.pose = to_pose(Eigen::Isometry3d::Identity());
    shape_def_t shape{};
    shape.body = i, shape.kind = shape_def_t::BOX, shape.pose = body.pose;
    shape.size_m = i == 0 ? to_vec3({0.5, 0.5, 0.03}) : to_vec3({0.2, 0.03, 0.02});
    s.bodies.push_back(body), s.shapes.push_back(shape);
  }
  s.body_count = s.shape_count = balls + 1;
  s.listener = to_pose(Eigen::Isometry3d::Identity());
  return s;
}

// Relief and friction map of the surfaces, and the resonators of the bodies.
struct Sources {
  const ReliefLevels& relief;
  const FrictionMap& friction;
  const Impacts& impacts;
};

// The i-th contact of a row at a time t, s, from the start of the table.
Scrape scrape_of(const Row& row, int i, double t, sync::HostTime now, const Sources& sources) {
  Scrape s;
  s.id = i, s.at = now, s.cutoff_Hz = 3000;
  (row.rolls ? s.roll : s.slide) = 1e-4f;
  for (std::size_t k = 0; k < 2; ++k) {
    ScrapeSide& side = s.sides[k];
    const int body = k == 0 ? 0 : i + 1;
    side.voice = body, side.known = true;
    side.resonators = sources.impacts.resonators(body), side.gains = sources.impacts.gains(body, std::nullopt);
    if (row.mapped) side.relief = &sources.relief;
    if (row.friction && k == 0) side.friction = &sources.friction;
    side.roughness = {3e-6, row.mapped ? sources.relief.texel_m() : 0};
    const double speed = k == 0 || row.rolls ? 0.1 : 0;
    side.place_m.x() = speed * t + 0.01 * i, side.velocity_m_s.x() = speed;
    if (speed > 0) side.slide_vector.x() = side.roll_vector.x() = 1;
  }
  return s;
}

// Durations of the callback's work for each block of a row, us.
std::vector<double> callback_us(const Row& row, int blocks, const Sources& sources) {
  auto scrapes = std::make_unique<Scrapes>(kRate_Hz);
  auto voices = std::make_unique<Voices>(64, kRate_Hz, ring(available_instructions().back()));
  std::vector<double> took_us;
  for (int b = 0; b < blocks; ++b) {
    const double t = b * kFrames / kRate_Hz;
    const sync::HostTime now = sync::host_time(static_cast<std::int64_t>(1e9 * (1 + t)));
    for (int i = 0; i < row.contacts; ++i) scrapes->update(scrape_of(row, i, t, now, sources));
    float stereo[2 * kFrames] = {};
    const auto begin = std::chrono::steady_clock::now();
    scrapes->render(0, kFrames, now);
    scrapes->drive(*voices, kFrames);
    voices->render(stereo, kFrames);
    took_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  return took_us;
}

// Contacts that slide, at a tick of 1 ms.
sync::Contacts sliding_contacts(int count, int tick) {
  sync::Contacts contacts;
  for (int i = 0; i < count; ++i) {
    contact_t c{};
    c.contact_id = i, c.body_b = i % Scrapes::kMax + 1, c.tool = -1, c.kind = contact_t::SURFACE;
    c.normal.z = 1, c.normal_force_N = 1, c.sliding_velocity_m_s.x = 0.1f;
    c.points.resize(1), c.point_count = 1;
    c.points[0].a_body_m.x = c.points[0].a_world_m.x = 1e-4f * static_cast<float>(tick);
    contacts.push_back(c);
  }
  return contacts;
}

// Durations of each tick of the node's loop with these contacts, us.
std::vector<double> loop_us(int count, int ticks, const scene_t& scene, const Impacts& impacts) {
  auto surfaces = std::make_shared<AudioSurfaces>();
  const sync::BodyHistory bodies(1);
  Sliding sliding(scene, surfaces, bodies, impacts, Settings{}, kRate_Hz);
  std::vector<double> took_us;
  for (int tick = 0; tick < ticks; ++tick) {
    const sync::Contacts contacts = sliding_contacts(count, tick);
    const auto begin = std::chrono::steady_clock::now();
    sliding.scrapes(contacts, sync::sim_time(1'000'000LL * tick), sync::host_time(1'000'000LL * tick), 0.001);
    took_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  return took_us;
}

// The table of the callback, printed and added to the rows of the JSON file.
void callback_table(int blocks, const Sources& sources, nlohmann::json& rows) {
  const double period_us = 1e6 * kFrames / kRate_Hz;
  std::printf("%-34s %9s %12s %12s %12s\n", "callback, block of 64", "contacts", "median us", "p99 us",
              "% / contact");
  for (const Row& row :
       {Row{"none", 0, false, false, false}, Row{"scrape, roughness", 1, false, false, false},
        Row{"scrape, relief", 1, true, false, false}, Row{"scrape, relief and friction map", 1, true, true, false},
        Row{"roll, relief", 1, true, false, true}, Row{"scrape, relief", 16, true, false, false},
        Row{"scrape, relief and friction map", 16, true, true, false}}) {
    const auto [median, p99] = figures(callback_us(row, blocks, sources));
    const double share = row.contacts ? 100 * median / period_us / row.contacts : 0;
    std::printf("%-34s %9d %12.2f %12.2f %12.2f\n", row.what.c_str(), row.contacts, median, p99, share);
    rows.push_back({{"of", "callback"},
                    {"what", row.what},
                    {"contacts", row.contacts},
                    {"median_us", median},
                    {"p99_us", p99},
                    {"period_us", period_us},
                    {"percent_a_contact", share}});
  }
}

// The table of the node's loop, printed and added to the rows of the JSON file.
void loop_table(int ticks, const scene_t& scene, const Impacts& impacts, nlohmann::json& rows) {
  std::printf("%-34s %9s %12s %12s\n", "loop, tick of 1 ms", "contacts", "median us", "p99 us");
  for (const int count : {1, 16, 50}) {
    const auto [median, p99] = figures(loop_us(count, ticks, scene, impacts));
    std::printf("%-34s %9d %12.2f %12.2f\n", "contacts that slide", count, median, p99);
    rows.push_back({{"of", "loop"}, {"contacts", count}, {"median_us", median}, {"p99_us", p99}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string json;
  int blocks = 4000;
  tactus::sync::Arguments app{"Cost of sliding and rolling contacts in the audio callback and in the loop of its node."};
  app.add_option("--blocks", blocks, "of 64 frames, of each row").range(100, 1'000'000);
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "scrape_table", argc, argv);
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // denormal numbers are 0, as in the callback
#endif
  material_def_t m{};
  m.bump_size_u_m = m.bump_size_v_m = m.friction_size_u_m = m.friction_size_v_m = 0.1024;
  m.bump_height_m = 1e-4, m.friction_black = 0.5, m.friction_white = 2;
  const ReliefLevels relief(make_relief(heights(), m));
  const FrictionMap friction(heights(), m);
  const scene_t scene = floor_and_balls(Scrapes::kMax);
  const Impacts impacts(
      scene, [](std::int64_t) { return std::nullopt; }, Settings{}, kRate_Hz, 1);
  nlohmann::json rows = nlohmann::json::array();
  callback_table(blocks, {relief, friction, impacts}, rows);
  loop_table(blocks, scene, impacts, rows);
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
}
