// Impossible contacts are rejected, and other sounds are as if they had never arrived.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>

#include "audio_node/excitation/impact.h"
#include "audio_node/signal/plausible.h"
#include "audio_node/mixer/renderer.h"
#include "audio_node/excitation/sliding.h"
#include "lcmtypes/channels.h"
#include "sync/bus/inbox.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr double kClick = 1e-3;  // -60 dBFS
constexpr double kCeiling = 0.9;

float one_of(std::mt19937& random, std::initializer_list<float> values) {
  return values.begin()[random() % values.size()];
}

template <class Vector>
void poison(Vector& v, float value, std::mt19937& random) {
  (random() % 3 == 0 ? v.x : random() % 2 ? v.y : v.z) = value;
}

// One of its fields is impossible.
contact_event_t wild_event(std::int64_t id, std::mt19937& random) {
  contact_event_t e = RecordedRun::hit(id, 0, 0, 1);
  switch (random() % 7) {
    case 0: e.approach_speed_m_s = one_of(random, {kNan, kInf, -kInf, -1, 1e4f, 1e30f}); break;
    case 1: e.effective_mass_kg = one_of(random, {kNan, kInf, 0, -1, 1e12f}); break;
    case 2: e.curvature_1_m = one_of(random, {kNan, kInf, -5, 1e9f}); break;
    case 3: poison(e.point_m, one_of(random, {kNan, kInf, 1e30f, -1e7f}), random); break;
    case 4: poison(e.normal, one_of(random, {kNan, kInf, 1e5f}), random); break;
    case 5: e.body_b = e.body_a; break;
    default: e.body_a = -static_cast<int>(random() % 100) - 1;
  }
  return e;
}

contact_t slide(std::int64_t id, float speed_m_s, float force_N) {
  contact_t c{};
  c.contact_id = id, c.body_a = 0, c.body_b = 1, c.material_b = 1, c.tool = -1;
  c.normal.z = 1, c.normal_force_N = force_N, c.sliding_velocity_m_s.x = speed_m_s;
  c.point_count = 1, c.points.resize(1);
  return c;
}

contact_t wild_slide(std::int64_t id, std::mt19937& random) {
  contact_t c = slide(id, 0.2f, 5);
  switch (random() % 6) {
    case 0: poison(c.sliding_velocity_m_s, one_of(random, {kNan, kInf, 1e6f, -1e30f}), random); break;
    case 1: c.normal_force_N = one_of(random, {kNan, kInf, -3, 1e20f}); break;
    case 2: poison(c.normal, one_of(random, {kNan, kInf, 1e5f}), random); break;
    case 3: poison(c.points[0].a_body_m, one_of(random, {kNan, kInf, 1e30f}), random); break;
    case 4: poison(c.points[0].a_world_m, one_of(random, {kNan, -kInf, 1e7f}), random); break;
    default: c.body_b = c.body_a;
  }
  return c;
}

scene_t rough_scene() {
  scene_t s = struck_scene();
  s.materials[0] = rough();
  s.materials[0].youngs_modulus_Pa = 1.1e10, s.materials[0].poissons_ratio = .25,
  s.materials[0].density_kg_m3 = 750;
  return s;
}

std::optional<Extent> no_mesh(std::int64_t) { return std::nullopt; }

// Two seconds of blows and of a stroke over the board, with the given number of impossible ones in between.
std::vector<float> play(int wild, unsigned seed) {
  const scene_t scene = rough_scene();
  const Impacts impacts(scene, no_mesh, Settings{}, kRate, 1);
  const sync::BodyHistory bodies(1);
  Sliding sliding(scene, wavy_surfaces(), bodies, impacts, Settings{}, kRate);
  auto bench = std::make_unique<Bench>();
  std::mt19937 random(seed), wild_random(seed + 1);
  std::int64_t id = 0, wild_id = 1'000'000, number = 0;
  while (bench->left.size() < 2 * kRate) {
    const sync::HostTime at = sync::host_time(bench->time_ns(bench->left.size() + 200));
    if (random() % 40 == 0) bench->queues.strikes.push(impacts.strike(RecordedRun::hit(++id, 0, 0, 1), at));
    for (int i = 0; i < wild; ++i)
      bench->queues.strikes.push(impacts.strike(wild_event(++wild_id, wild_random), at));
    sync::Contacts contacts{slide(7, 0.1f, 2)};
    for (int i = 0; i < wild; ++i)
      // Also for the existing contact: a contradiction.
      contacts.push_back(wild_slide(wild_random() % 2 ? 7 : static_cast<std::int64_t>(++wild_id), wild_random));
    for (Scrape s : sliding.scrapes(contacts, sync::SimTime{}, at, 128 / kRate)) {
      s.number = number++;
      bench->queues.scrapes.push(s);
    }
    bench->play(128);
  }
  return bench->left;
}

}  // namespace

TEST_CASE("Impossible contacts make no click and leave other sounds unchanged") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<float> without = play(0, seed), with = play(3, seed);
    REQUIRE(with.size() == without.size());
    double click = 0, loudest = 0;
    bool finite = true;
    for (std::size_t n = 0; n < with.size(); ++n) {
      finite &= std::isfinite(with[n]);
      loudest = std::max(loudest, std::abs(static_cast<double>(with[n])));
      click = std::max(click, std::abs(static_cast<double>(with[n]) - static_cast<double>(without[n])));
    }
    CAPTURE(seed, click, loudest);
    CHECK(finite);
    CHECK(loudest > 0.01);  // something sounds
    CHECK(loudest <= kCeiling);
    CHECK(click < kClick);
  }
}

TEST_CASE("Random contacts, valid or not, give samples below the ceiling") {
  const scene_t scene = rough_scene();
  const Impacts impacts(scene, no_mesh, Settings{}, kRate, 1);
  const sync::BodyHistory bodies(1);
  Sliding sliding(scene, wavy_surfaces(), bodies, impacts, Settings{}, kRate);
  auto bench = std::make_unique<Bench>();
  std::mt19937 random(9);
  // Also random bits of a float: NaNs, infinities, denormal and huge numbers.
  const auto any = [&] {
    const auto bits = static_cast<std::uint32_t>(random());
    float x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return random() % 2 ? x : std::abs(std::fmod(std::isfinite(x) ? x : 1.f, 50.f));
  };
  int expected_reports = 0;
  std::int64_t number = 0;
  while (bench->left.size() < 2 * kRate) {
    const sync::HostTime at = sync::host_time(bench->time_ns(bench->left.size() + 100));
    for (int i = 0; i < 4; ++i, ++expected_reports) {
      contact_event_t e =
          RecordedRun::hit(expected_reports, 0, static_cast<int>(random() % 5) - 1, static_cast<int>(random() % 5));
      if (random() % 2) e.approach_speed_m_s = any();
      if (random() % 2) e.effective_mass_kg = any();
      if (random() % 2) e.curvature_1_m = any();
      if (random() % 3 == 0) e.point_m = {any(), any(), any()};
      if (random() % 3 == 0) e.normal = {any(), any(), any()};
      e.material_a = static_cast<int>(random() % 9) - 4;
      REQUIRE(bench->queues.strikes.push(impacts.strike(e, at)));
    }
    sync::Contacts contacts;
    for (int i = 0; i < 4; ++i) {
      contact_t c = slide(static_cast<std::int64_t>(random() % 30), any(), any());
      if (random() % 3 == 0) c.points[0].a_body_m = {any(), any(), any()};
      if (random() % 3 == 0) c.normal = {any(), any(), any()};
      contacts.push_back(c);
    }
    for (Scrape s : sliding.scrapes(contacts, sync::SimTime{}, at, static_cast<double>(any()))) {
      s.number = number++;
      bench->queues.scrapes.push(s);
    }
    bench->play(128);
  }
  bool below = true;
  for (const float x : bench->left) below &= std::abs(x) <= static_cast<float>(kCeiling);  // false for NaN
  CHECK(below);
  SECTION("each strike is reported") {
    bench->play(4800);
    CHECK(static_cast<int>(bench->reports.size()) == expected_reports);
  }
}

TEST_CASE("A contact event with a value that is not finite is rejected on receipt and counted") {
  sync::Queue<contact_events_t> inbox(channels::kContactEvents, 16);
  const auto arrive = [&](const contact_event_t& e) {
    contact_events_t m{};
    m.header = {0, 1, 1, 7, 9, 21, 0};
    m.clock = {0, 1, 1};
    m.pages = 1, m.count = 1, m.events = {e};
    const auto bytes = sync::encode(m);
    inbox.accept(bytes.data(), bytes.size(), sync::host_time(1));
  };
  arrive(RecordedRun::hit(1, 0, 0, 1));
  REQUIRE(inbox.count().bad == 0);
  int bad = 0;
  for (const auto& spoil : std::initializer_list<std::function<void(contact_event_t&)>>{
           [](auto& e) { e.approach_speed_m_s = kNan; }, [](auto& e) { e.effective_mass_kg = kInf; },
           [](auto& e) { e.curvature_1_m = kNan; }, [](auto& e) { e.point_m.y = kNan; },
           [](auto& e) { e.normal.z = kNan; }, [](auto& e) { e.approach_speed_m_s = -1; }}) {
    contact_event_t e = RecordedRun::hit(2, 0, 0, 1);
    spoil(e);
    arrive(e);
    CHECK(inbox.count().bad == ++bad);
  }
  CHECK(inbox.pop());
  CHECK_FALSE(inbox.pop());
}
