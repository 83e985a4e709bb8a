// Extreme and impossible contacts through ears, loudspeakers and recordings.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>

#include "audio_node/excitation/impact.h"
#include "audio_node/signal/plausible.h"
#include "audio_node/mixer/renderer.h"
#include "audio_node/excitation/sampler.h"
#include "audio_node/excitation/sliding.h"
#include "audio_node/spatial/space_of.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/audio_node/support/sounds.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();
constexpr double kSpaceClick = 1e-3;  // -60 dBFS
constexpr double kSpaceCeiling = 0.9;

scene_t oak_scene() {
  scene_t s = struck_scene();
  s.materials[0] = rough();
  s.materials[0].name = "oak";
  s.materials[0].youngs_modulus_Pa = 1.1e10, s.materials[0].poissons_ratio = .25,
  s.materials[0].density_kg_m3 = 750;
  return s;
}

Settings with(const std::string& spatial, const std::string& method) {
  Settings s;
  s.spatial = spatial, s.method = method, s.layout_file = "cube";
  return s;
}

Database database() {
  Layers l;
  l.by_speed.push_back({1, 1, {{tone(500, 0.2, 0.5, 48000, 20), 0.5f, 0.2f}}});
  Database d;
  for (const Interaction i : {Interaction::kImpact, Interaction::kScrape, Interaction::kRoll})
    d.sounds[{pair_of("steel", "oak"), i}] = l;
  return d;
}

// The node without bus and card.
struct NodeBench {
  NodeBench(const std::string& spatial, const std::string& method) : settings(with(spatial, method)) {
    def.space = space_of(settings, kRate);
    renderer = std::make_unique<Renderer>(queues, def);
    queues.recorded.databases.push(1);
    sampler.set_database(&data, 1);
  }
  sync::HostTime now() const { return sync::host_time(kStart_ns + std::llround(frames * 1e9 / kRate)); }
  void hit(const contact_event_t& e) {
    Strike s = impacts.strike(e, now() + sync::from_seconds(0.01));
    sampler.add_recordings(s, e, impacts);
    queues.strikes.push(s);
  }
  void submit_contacts(const sync::Contacts& contacts) {
    const sync::HostTime at = now() + sync::from_seconds(0.01);
    for (const RecordedContact& r : sampler.recorded_contacts(contacts, at)) queues.recorded.contacts.push(r);
    for (Scrape s : sliding.scrapes(contacts, sync::SimTime{}, at, 128 / kRate)) {
      s.slide *= sampler.modal_gain(s.id, Interaction::kScrape),
          s.roll *= sampler.modal_gain(s.id, Interaction::kRoll);
      s.number = number++;
      queues.scrapes.push(s);
    }
  }
  void play() {
    std::vector<float> block(128 * static_cast<std::size_t>(renderer->channels()));
    renderer->render(block.data(), 128, {now(), sync::Nanoseconds(0), sync::Nanoseconds(0)});
    out.insert(out.end(), block.begin(), block.end());
    frames += 128;
    for (presentation_t r; queues.reports.pop(r);) continue;
  }

  Settings settings;
  scene_t scene = oak_scene();
  Database data = database();
  Impacts impacts{scene, [](std::int64_t) -> std::optional<Extent> { return std::nullopt; }, settings, kRate, 1};
  sync::BodyHistory bodies{1};
  Sliding sliding{scene, wavy_surfaces(), bodies, impacts, settings, kRate};
  Sampler sampler{scene, settings};
  CallbackQueues queues;
  RendererDef def;
  std::unique_ptr<Renderer> renderer;
  std::vector<float> out;
  std::int64_t number = 0;
  double frames = 0;
};

contact_event_t blow(std::int64_t id, int body) {
  contact_event_t e = RecordedRun::hit(id, 0, 0, body);
  e.material_a = 0, e.material_b = body;
  return e;
}

contact_t stroke(std::int64_t id, float speed_m_s, float force_N) {
  contact_t c{};
  c.contact_id = id, c.body_a = 0, c.body_b = 1, c.material_b = 1, c.tool = -1;
  c.normal.z = 1, c.normal_force_N = force_N, c.sliding_velocity_m_s.x = speed_m_s;
  c.point_count = 1, c.points.resize(1);
  return c;
}

struct Extremes {
  bool finite = true;
  double loudest = 0;
};
Extremes extremes_of(const std::vector<float>& x) {
  Extremes e;
  for (const float s : x) {
    e.finite &= std::isfinite(s);
    e.loudest = std::max(e.loudest, std::abs(static_cast<double>(s)));
  }
  return e;
}

// A blow every fifth of a second and a stroke, with `wild` impossible contacts in between.
std::vector<float> play(const std::string& spatial, const std::string& method, int wild) {
  auto bench = std::make_unique<NodeBench>(spatial, method);
  std::int64_t id = 0, wild_id = 1'000'000;
  const float bad[] = {kNotANumber, kInfinite, -kInfinite, 1e30f, -1e30f};
  for (int block = 0; block < 400; ++block) {
    if (block % 75 == 0) bench->hit(blow(++id, 1));
    sync::Contacts contacts{stroke(7, 0.1f, 2)};
    for (int i = 0; i < wild; ++i) {
      const float value = bad[(block + i) % 5];
      contact_event_t e = blow(++wild_id, 1);
      if (block % 4 == 2)
        e.point_m.x = double{value};
      else
        (block % 4 == 0   ? e.approach_speed_m_s
         : block % 4 == 1 ? e.effective_mass_kg
                          : e.normal.y) = value;
      bench->hit(e);
      // Also for the existing contact: a contradiction.
      contact_t c = stroke(i % 2 ? 7 : ++wild_id, 0.1f, 2);
      c.normal.x = value;
      if (block % 3 == 2)
        c.points[0].a_world_m.z = double{value};
      else
        (block % 3 == 0 ? c.sliding_velocity_m_s.x : c.normal_force_N) = value;
      contacts.push_back(c);
    }
    bench->submit_contacts(contacts);
    bench->play();
  }
  return bench->out;
}

}  // namespace

TEST_CASE("Many extreme contacts at once give samples below the ceiling in any space by any method") {
  const std::string spatial = GENERATE("hrtf", "stereo", "loudspeakers"),
                    method = GENERATE("modal", "samples", "both");
  CAPTURE(spatial, method);
  auto bench = std::make_unique<NodeBench>(spatial, method);
  std::mt19937 random(6);
  std::int64_t id = 0;
  for (int block = 0; block < 200; ++block) {
    for (int i = 0; i < 8; ++i) {
      contact_event_t e = blow(++id, 1 + static_cast<int>(random() % 2));
      e.approach_speed_m_s = static_cast<float>(kMaxPlausibleSpeed_m_s);
      e.effective_mass_kg = static_cast<float>(random() % 2 ? kMaxPlausibleMass_kg : 1e-6);
      e.curvature_1_m = static_cast<float>(random() % 2 ? kMaxPlausibleCurvature_1_m : 0);
      if (random() % 4 == 0) e.point_m.x = static_cast<float>(kMaxPlausiblePosition_m);
      REQUIRE(plausible(e));
      bench->hit(e);
    }
    sync::Contacts contacts;
    for (int i = 0; i < 30; ++i) {
      contact_t c = stroke(i, static_cast<float>(kMaxPlausibleSpeed_m_s), static_cast<float>(kMaxPlausibleForce_N));
      c.rolling_velocity_m_s.y = static_cast<float>(random() % 2 ? kMaxPlausibleSpeed_m_s : 0);
      REQUIRE(plausible(c));
      contacts.push_back(c);
    }
    bench->submit_contacts(contacts);
    bench->play();
  }
  const Extremes e = extremes_of(bench->out);
  CAPTURE(e.loudest);
  CHECK(e.finite);
  CHECK(e.loudest > 0.05);
  CHECK(e.loudest <= static_cast<double>(static_cast<float>(kSpaceCeiling)));
  // The decay after it is finite too.
  for (int block = 0; block < 20; ++block) bench->submit_contacts({}), bench->play();
  CHECK(extremes_of(bench->out).finite);
}

TEST_CASE("Impossible contacts make no click through ears or loudspeakers by any method") {
  const std::string spatial = GENERATE("hrtf", "loudspeakers"), method = GENERATE("modal", "samples", "both");
  const std::vector<float> without = play(spatial, method, 0), with = play(spatial, method, 3);
  REQUIRE(with.size() == without.size());
  double click = 0;
  for (std::size_t n = 0; n < with.size(); ++n)
    click = std::max(click, std::abs(static_cast<double>(with[n]) - static_cast<double>(without[n])));
  const Extremes e = extremes_of(with);
  CAPTURE(spatial, method, click, e.loudest);
  CHECK(e.finite);
  CHECK(e.loudest > 0.01);  // something sounds
  CHECK(e.loudest <= kSpaceCeiling);
  CHECK(click < kSpaceClick);
}
