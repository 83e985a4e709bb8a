// No setting within its range, and no operator, makes the sound louder than its limits or not finite.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "audio_node/excitation/impact.h"
#include "audio_node/excitation/sliding.h"
#include "audio_node/mixer/renderer.h"
#include "audio_node/spatial/space_of.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/level_oracle.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// Every setting with a range is drawn from it, half of them at an end of it.
Settings any_settings(std::mt19937& random) {
  Settings settings;
  for (const auto& field : setting_fields()) {
    const std::string name = field.row.name;
    if (!(field.row.min < field.row.max)) continue;
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    double value = random() % 2 ? (random() % 2 ? field.row.min : field.row.max)
                                : field.row.min + share * (field.row.max - field.row.min);
    if (name == "sample_rate")
      value = std::vector<double>{8000, 22050, 44100, 48000}[random() % 4];  // others cost time
    if (std::string(field.row.unit) == "count" || name == "sample_rate") value = std::round(value);
    sync::set(settings, setting_fields(), name, std::to_string(value));
  }
  settings.spatial = random() % 2 ? "stereo" : "loudspeakers";
  settings.layout_file = "quad";
  return settings;
}

RendererDef def_of(const Settings& s) {
  RendererDef def;
  def.rate_Hz = s.sample_rate_Hz, def.period_frames = s.period_frames, def.ceiling = s.limiter_ceiling;
  def.level_limit = {.full_scale_dB = s.full_scale_level_dB, .limit_dB = s.level_limit_dB};
  def.late = late_policy(s.sample_rate_Hz, sync::from_seconds(s.late_limit_s));
  def.space = space_of(s, s.sample_rate_Hz);
  return def;
}

struct Scenery {
  scene_t scene = struck_scene();
  sync::BodyHistory bodies{1};
  Scenery() {
    const material_def_t oak = scene.materials[0];
    scene.materials[0] = rough();
    scene.materials[0].youngs_modulus_Pa = oak.youngs_modulus_Pa,
    scene.materials[0].poissons_ratio = oak.poissons_ratio;
    scene.materials[0].density_kg_m3 = oak.density_kg_m3;
  }
};

contact_t slide(std::mt19937& random) {
  contact_t c{};
  c.contact_id = static_cast<std::int64_t>(random() % 4), c.body_a = 0, c.body_b = 1, c.material_b = 1,
  c.tool = -1;
  c.normal.z = 1, c.normal_force_N = static_cast<float>(random() % 100),
  c.sliding_velocity_m_s.x = 0.01f * static_cast<float>(random() % 300);
  c.point_count = 1, c.points.resize(1);
  return c;
}

// Two seconds of blows up to the fastest plausible one, of strokes, and of drop-outs; all channels.
std::vector<float> play(const Settings& settings, const RendererDef& def, std::mt19937& random) {
  const Scenery scenery;
  const Impacts impacts(
      scenery.scene, [](std::int64_t) { return std::optional<Extent>(); }, settings, def.rate_Hz, 1);
  Sliding sliding(scenery.scene, wavy_surfaces(), scenery.bodies, impacts, settings, def.rate_Hz);
  auto queues = std::make_unique<CallbackQueues>();
  auto renderer = std::make_unique<Renderer>(*queues, def);
  std::vector<float> all;
  const auto channels = static_cast<std::size_t>(renderer->channels());
  const int period = settings.period_frames;
  std::int64_t id = 0, number = 0;
  while (all.size() < channels * static_cast<std::size_t>(2 * def.rate_Hz)) {
    const auto frames = static_cast<double>(all.size() / channels);
    const sync::HostTime first = sync::host_time(kStart_ns + std::llround(frames * 1e9 / def.rate_Hz));
    const sync::HostTime soon = first + sync::from_seconds(static_cast<double>(random() % 100) * 1e-3);
    for (auto left = random() % 6; left > 0; --left) {
      contact_event_t e =
          RecordedRun::hit(++id, 0, static_cast<int>(random() % 3), static_cast<int>(random() % 3));
      e.approach_speed_m_s = static_cast<float>(std::pow(10, static_cast<double>(random() % 500) * 1e-2 - 3));
      e.effective_mass_kg = static_cast<float>(std::pow(10, static_cast<double>(random() % 600) * 1e-2 - 3));
      queues->strikes.push(impacts.strike(e, soon));
    }
    for (Scrape s :
         sliding.scrapes({slide(random), slide(random)}, sync::SimTime{}, first, period / def.rate_Hz)) {
      s.number = number++;
      queues->scrapes.push(s);
    }
    if (random() % 20 == 0)
      queues->commands.push(
          {{static_cast<double>(random() % 200) * 1e-3, 0.3}, static_cast<int>(random() % 4) - 1});
    std::vector<float> block(channels * static_cast<std::size_t>(period));
    renderer->render(block.data(), period, {first, {}, {}, random() % 100 == 0});
    all.insert(all.end(), block.begin(), block.end());
  }
  return all;
}

}  // namespace

TEST_CASE("No setting in its range makes sound louder than its limits, or not finite") {
  std::mt19937 random(21);
  for (int trial = 0; trial < 40; ++trial) {
    const Settings settings = any_settings(random);
    const RendererDef def = def_of(settings);
    const std::vector<float> sound = play(settings, def, random);
    const auto ceiling = static_cast<float>(settings.limiter_ceiling);
    CAPTURE(trial, settings.gain, settings.limiter_ceiling, settings.level_limit_dB, settings.full_scale_level_dB,
            settings.sample_rate_Hz);
    CHECK(std::all_of(sound.begin(), sound.end(),
                      [&](float x) { return std::abs(x) <= ceiling; }));  // false for NaN
    const int channels = settings.spatial == "stereo" ? 2 : 4;
    CHECK(loudest_second_by_oracle_dBA(sound, channels, def.rate_Hz, settings.full_scale_level_dB, false) <=
          settings.level_limit_dB + 1e-3);
  }
}
