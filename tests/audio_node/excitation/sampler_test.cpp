#include "audio_node/excitation/sampler.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/samples/loops.h"
#include "lcmtypes/vectors.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/sounds.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// A ball of steel above a floor of oak, and one of rubber.
scene_t balls(double radius_m = 0.05) {
  scene_t s{};
  s.listener = to_pose(Eigen::Isometry3d::Identity());
  for (const char* name : {"oak", "steel", "rubber"}) {
    material_def_t m{};
    m.name = name, m.youngs_modulus_Pa = 1e10, m.density_kg_m3 = 1000, m.poissons_ratio = 0.3;
    m.friction_dynamic = 0.5, m.restitution = 0.5;
    s.materials.push_back(m);
  }
  for (int i = 0; i < 3; ++i) {
    body_def_t b{};
    b.id = i, b.is_static = i == 0, b.mass_kg = 0.5;
    s.bodies.push_back(b);
    shape_def_t shape{};
    shape.body = i, shape.material = i, shape.kind = i == 0 ? shape_def_t::PLANE : shape_def_t::SPHERE;
    shape.size_m.x = radius_m;
    shape.pose = to_pose(Eigen::Isometry3d::Identity());
    s.shapes.push_back(shape);
  }
  s.material_count = s.body_count = s.shape_count = 3;
  return s;
}

contact_event_t hit(int body, double speed_m_s = 1, std::int64_t id = 7) {
  contact_event_t e{};
  e.event_id = id, e.kind = contact_event_t::HIT;
  e.body_a = 0, e.body_b = body, e.material_a = 0, e.material_b = body;
  e.point_m.x = 1, e.normal.z = 1;
  e.approach_speed_m_s = static_cast<float>(speed_m_s), e.effective_mass_kg = 0.1f, e.curvature_1_m = 20;
  return e;
}

Recording recording(double level = 0.5) {
  return {tone(500, 0.2, level, 48000, 20), static_cast<float>(level), 0.2f};
}

Database database() {
  Database d;
  Layers l;
  l.by_speed.push_back({1, 1, {recording()}});
  d.sounds[{pair_of("steel", "oak"), Interaction::kImpact}] = l;
  d.sounds[{pair_of("", "oak"), Interaction::kImpact}] = l;
  d.sounds[{pair_of("steel", "oak"), Interaction::kScrape}] = l;
  return d;
}

Settings with(const std::string& method, double mix = 0.5) {
  Settings s;
  s.method = method, s.mix = mix;
  return s;
}

struct World {
  scene_t scene = balls();
  Database data = database();
  Settings settings;
  Impacts impacts;
  Sampler sampler;
  explicit World(const Settings& s, double radius_m = 0.05)
      : scene(balls(radius_m)), settings(s), impacts(scene, {}, s, 48000, 1), sampler(scene, s) {
    sampler.set_database(&data, 5);
  }
  Strike strike(const contact_event_t& e) {
    Strike s = impacts.strike(e, sync::HostTime{});
    sampler.add_recordings(s, e, impacts);
    return s;
  }
};

// Root mean square of the rendered strike, left channel.
double rms_of(Strike s) {
  auto bench = std::make_unique<Bench>();
  s.scheduled = sync::host_time(kStart_ns + 1'000'000);
  bench->queues.strikes.push(s);
  for (int i = 0; i < 20; ++i) bench->play(480);
  double sum = 0;
  for (const float x : bench->left) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum / static_cast<double>(bench->left.size()));
}

contact_t sliding(double slide_m_s, double roll_m_s, double force_N) {
  contact_t c{};
  c.contact_id = 11, c.body_a = 0, c.body_b = 1, c.material_a = 0, c.material_b = 1;
  c.normal_force_N = static_cast<float>(force_N);
  c.sliding_velocity_m_s.x = static_cast<float>(slide_m_s);
  c.rolling_velocity_m_s.x = static_cast<float>(roll_m_s);
  c.point_count = 1, c.points.resize(1);
  return c;
}

// Left channel of blows by these methods, one after another, 20 ms apart.
std::vector<float> blows_by(const std::vector<std::string>& methods) {
  World w(with("modal"));
  auto bench = std::make_unique<Bench>();
  std::int64_t at = kStart_ns + 2'000'000;
  for (const std::string& method : methods) {
    w.sampler.configure(with(method));
    if (method != "none") {
      Strike s = w.strike(hit(1, 0.2));
      s.scheduled = sync::host_time(at);
      REQUIRE(bench->queues.strikes.push(s));
    }
    at += 20'000'000;
    for (int i = 0; i < 15; ++i) bench->play(64);
  }
  for (int i = 0; i < 100; ++i) bench->play(64);
  return bench->left;
}

}  // namespace

TEST_CASE("The method selects modes, recordings, or both with the same total power") {
  World modal(with("modal")), samples(with("samples")), both(with("both", 0.25));
  const Strike m = modal.strike(hit(1)), s = samples.strike(hit(1)), b = both.strike(hit(1));
  CHECK(m.recorded.database == 0);
  CHECK(m.sides[1].voice >= 0);
  CHECK(s.recorded.database == 5);
  CHECK(s.sides[0].voice == -1);
  CHECK(s.sides[1].voice == -1);
  CHECK(b.recorded.database == 5);
  const double modes = static_cast<double>(b.sides[1].impulse / m.sides[1].impulse);
  const double recordings = static_cast<double>(b.recorded.shots[0].gain / s.recorded.shots[0].gain);
  CHECK(modes * modes + recordings * recordings == Approx(1).epsilon(1e-5));
  CHECK(recordings == Approx(std::sin(0.25 * M_PI / 2)).epsilon(1e-5));
}

TEST_CASE("The level of a recorded blow is its impulse, in proportion or compressed by loudness_exponent") {
  Settings settings = with("samples");
  settings.loudness_exponent = GENERATE(1.0, 0.6);
  World w(settings);
  const double once = rms_of(w.strike(hit(1, 0.5)));
  REQUIRE(once > 0);
  // One layer, so that the speed changes nothing else; the limiter changes nothing below 0.9. Single precision.
  for (const double factor : {0.1, 0.5, 2.0, 4.0})
    CHECK(rms_of(w.strike(hit(1, 0.5 * factor))) / once == Approx(std::pow(factor, settings.loudness_exponent)).epsilon(1e-4));
  // More than 12 dB above its recording it does not grow.
  CHECK(recorded_blow_level(1e6, w.settings) == 4);
  CHECK(recorded_blow_level(-1, w.settings) == 0);
}

TEST_CASE("A body of half the size sounds an octave higher, which is the maximum shift") {
  for (const auto& [radius, pitch] :
       std::vector<std::pair<double, double>>{{0.05, 1}, {0.04, 1.25}, {0.025, 2}, {0.01, 2}, {0.5, 0.5}}) {
    World w(with("samples"), radius);
    // The smaller of ball and floor gives the size.
    CHECK(static_cast<double>(w.strike(hit(1)).recorded.shots[0].step) == Approx(pitch).epsilon(1e-5));
  }
}

TEST_CASE("A missing recording of a pair is replaced by those of its materials or by modes, and reported once") {
  World w(with("samples"));
  w.strike(hit(1));
  CHECK(w.sampler.take_messages().empty());
  const Strike rubber = w.strike(hit(2));
  CHECK(rubber.recorded.database == 5);  // oak alone
  CHECK(rubber.recorded.shots[0].recording ==
        &w.data.sounds.at({{"", "oak"}, Interaction::kImpact}).by_speed[0].takes[0]);
  auto messages = w.sampler.take_messages();
  REQUIRE(messages.size() == 1);
  CHECK(messages[0] == "oak on rubber: no recording of this impact; that of oak alone is played");
  w.strike(hit(2));
  CHECK(w.sampler.take_messages().empty());
  contact_event_t unknown = hit(2);
  unknown.material_a = unknown.body_a = 1;
  const Strike computed = w.strike(unknown);
  CHECK(computed.recorded.database == 0);
  CHECK(computed.sides[1].voice >= 0);
  CHECK(computed.sides[1].impulse == w.impacts.strike(unknown, {}).sides[1].impulse);
  messages = w.sampler.take_messages();
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("it is computed"));
}

TEST_CASE("Sliding contacts play their scrape recording, and the computed sound is reduced") {
  World w(with("samples"));
  auto lasting = [&, ms = 0](const contact_t& c) mutable {
    std::vector<RecordedContact> contacts;
    for (int i = 0; i < 100; ++i) contacts = w.sampler.recorded_contacts({c}, sync::host_time(1'000'000 * ++ms));
    return contacts;
  };
  const auto contacts = lasting(sliding(0.2, 0, 4));
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].database == 5);
  CHECK(contacts[0].speed_m_s == Approx(0.2));
  // The root of the friction power: 0.5 * 4 N * 0.2 m/s.
  CHECK(static_cast<double>(contacts[0].level) ==
        Approx(Settings{}.recorded_scrape_level * std::sqrt(0.4)).epsilon(1e-6));
  CHECK(w.sampler.modal_gain(11, Interaction::kScrape) == 0);
  CHECK(w.sampler.modal_gain(12, Interaction::kScrape) == 1);
  // No recording of rolling: it is computed.
  CHECK(lasting(sliding(0, 0.3, 4)).empty());
  CHECK(w.sampler.modal_gain(11, Interaction::kRoll) == 1);
  w.sampler.configure(with("modal"));
  CHECK(lasting(sliding(0.2, 0, 4)).empty());
  CHECK(w.sampler.modal_gain(11, Interaction::kScrape) == 1);
}

TEST_CASE("A contact that rests under load and jitters does not scrape, recorded or computed") {
  World w(with("samples"));
  for (int ms = 1; ms < 2000; ++ms) {
    // 2 mm/s back and forth, 50 times a second: it never moves 20 um away.
    const auto& contacts =
        w.sampler.recorded_contacts({sliding(ms / 10 % 2 ? 0.002 : -0.002, 0, 50)}, sync::host_time(1'000'000 * ms));
    REQUIRE(contacts.empty());
    REQUIRE(w.sampler.modal_gain(11, Interaction::kScrape) == 0);
  }
}

TEST_CASE("A recorded contact that ends or comes to rest ends once") {
  World w(with("samples"));
  int ms = 0;
  const auto update = [&](const sync::Contacts& all) {
    return w.sampler.recorded_contacts(all, sync::host_time(1'000'000 * ++ms));
  };
  const auto scrape = [&] {
    for (int i = 0; i < 100; ++i) update({sliding(0.2, 0, 4)});
  };
  const auto ends_in = [&](const sync::Contacts& all) {
    const auto ended = update(all);
    REQUIRE(ended.size() == 1);
    CHECK(ended[0].ends);
    CHECK(ended[0].contact == 11);
    CHECK(ended[0].database == 5);
    CHECK(update(all).empty());
  };
  scrape();
  ends_in({});
  scrape();
  ends_in({sliding(0, 0, 4)});
}

TEST_CASE("The loudest contacts are played, and contacts beyond the maximum number are computed") {
  World w(with("samples"));
  std::vector<RecordedContact> contacts;
  for (int ms = 1; ms < 100; ++ms) {
    sync::Contacts all;
    for (int i = 0; i < 2 * Loops::kMax; ++i) {
      contact_t c = sliding(0.2, 0, 1 + i);
      c.contact_id = i;
      all.push_back(c);
    }
    contacts = w.sampler.recorded_contacts(all, sync::host_time(1'000'000 * ms));
  }
  REQUIRE(contacts.size() == Loops::kMax);
  for (const RecordedContact& r : contacts) CHECK(r.contact >= Loops::kMax);
  CHECK(w.sampler.modal_gain(0, Interaction::kScrape) == 1);
  CHECK(w.sampler.modal_gain(2 * Loops::kMax - 1, Interaction::kScrape) == 0);
}

TEST_CASE("Invalid events and contacts play finite sound") {
  World w(with("samples"));
  for (const float v :
       {0.f, 1e30f, -1e30f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    contact_event_t e = hit(1);
    e.approach_speed_m_s = v, e.effective_mass_kg = v;
    CAPTURE(v);
    CHECK(std::isfinite(rms_of(w.strike(e))));
    for (const RecordedContact& r :
         w.sampler.recorded_contacts({sliding(static_cast<double>(v), static_cast<double>(v), static_cast<double>(v))}, {}))
      CHECK(std::isfinite(r.level));
  }
}

TEST_CASE("A change of the method leaves sounding bodies unchanged and makes no click") {
  const auto together = blows_by({"modal", "samples", "both", "modal"});
  const auto first = blows_by({"modal", "none", "none", "none"}),
             second = blows_by({"none", "samples", "none", "none"});
  const auto third = blows_by({"none", "none", "both", "none"}),
             fourth = blows_by({"none", "none", "none", "modal"});
  float most = 0;
  for (std::size_t n = 0; n < together.size(); ++n) {
    most = std::max(most, std::abs(together[n]));
    // Below the limiter everything is linear; single precision, and a voice ends at -100 dBFS.
    REQUIRE(together[n] == Approx(first[n] + second[n] + third[n] + fourth[n]).margin(2e-5));
  }
  CHECK(most > 0.05f);
  CHECK(most < 0.9f);
}

TEST_CASE("A scraping contact crossfades when the method changes") {
  World w(with("samples"));
  Layers smooth;
  Recording wave{{}, 0.5f, 0.35f};
  for (int n = 0; n < 24000; ++n)
    wave.samples.push_back(static_cast<float>(0.5 * std::sin(2 * M_PI * 200 * n / kRate)));
  smooth.by_speed.push_back({1, 1, {wave}});
  w.data.sounds[{pair_of("steel", "oak"), Interaction::kScrape}] = smooth;
  auto bench = std::make_unique<Bench>();
  for (int i = 0; i < 1000; ++i) {
    w.sampler.configure(with(i / 100 % 2 ? "modal" : "samples"));
    for (const RecordedContact& r : w.sampler.recorded_contacts({sliding(1, 0, 8)}, sync::host_time(bench->time_ns(bench->left.size()))))
      bench->queues.recorded.contacts.push(r);
    bench->play(48);
  }
  float steepest = 0, most = 0;
  for (std::size_t n = 1; n < bench->left.size(); ++n) {
    steepest = std::max(steepest, std::abs(bench->left[n] - bench->left[n - 1]));
    most = std::max(most, std::abs(bench->left[n]));
  }
  REQUIRE(most > 0.01f);
  // The slope of the wave, at most an octave up, and 1/240 of it a sample, the ramp of its level.
  CHECK(steepest <= most * (2 * M_PI * 200 / kRate + 1.0 / 240) * 1.01);
  CHECK(std::abs(bench->left.back()) < 1e-4f);  // the last 100 ms were modal: nothing is computed here
}
