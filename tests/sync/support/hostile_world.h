// A random world with a known truth, published as sim_node does, over a wire that loses, repeats, reorders and delays, to a host with
// another clock.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <random>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/world_state_t.hpp>
#include <variant>
#include <vector>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/clocks/clock_maps.h"
#include "sync/time/time.h"
#include "tests/times.h"

namespace tactus::hostile {

using test::kMs;

inline constexpr std::int64_t kRun = 7;
inline constexpr std::int32_t kOurClock = 1, kTheirClock = 2;
inline constexpr int kTool = 0, kToolBody = 50;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::int64_t whole(std::int64_t min, std::int64_t max) {
    return std::uniform_int_distribution<std::int64_t>(min, max)(engine_);
  }
  double real(double min, double max) { return std::uniform_real_distribution<double>(min, max)(engine_); }
  bool chance(double p) { return real(0, 1) < p; }

 private:
  std::mt19937_64 engine_;
};

// A contact from begin to just before end. Its force grows or falls linearly, so that linear interpolation is exact.
struct TrueContact {
  contact_t shown{};
  int group = 0;
  std::int64_t begin_ns = 0, end_ns = 0;
  double force_N = 0, slope_N_ms = 0;

  bool alive(std::int64_t t) const { return begin_ns <= t && t < end_ns; }
  float force(std::int64_t t) const {
    return static_cast<float>(force_N + slope_N_ms * static_cast<double>(t - begin_ns) / kMs);
  }
  contact_t at(std::int64_t t) const {
    contact_t c = shown;
    c.normal_force_N = force(t);
    c.area_m2 = 1e-5f * c.normal_force_N;
    return c;
  }
};

// A body on a cubic, which Hermite interpolation reproduces, with constant rotation about z.
struct TrueBody {
  Eigen::Vector3d a[4];
  double turn_rad_s = 0;

  Eigen::Vector3d position(double s) const { return a[0] + s * (a[1] + s * (a[2] + s * a[3])); }
  Eigen::Vector3d velocity(double s) const { return a[1] + s * (2 * a[2] + 3 * s * a[3]); }
};

// One incarnation of the simulation.
struct Life {
  std::int64_t incarnation = 0;
  std::int64_t begin_ns = 0;  // simulated time 0, on the sender's clock
  std::int64_t length_ns = 0;
  std::vector<TrueContact> contacts;
  std::vector<contact_event_t> events;  // in order of time
  std::vector<TrueBody> bodies;
};

struct Clocks {
  std::int64_t offset_ns = 0;  // sender's minus receiver's, at the receiver's 0
  double drift = 0;
  std::int64_t to_receiver(std::int64_t sender_ns) const {
    return static_cast<std::int64_t>(static_cast<long double>(sender_ns - offset_ns) /
                                     (1 + static_cast<long double>(drift)));
  }
};

struct Wire {
  double loss = 0, burst = 1, twice = 0;
  std::int64_t least_ns = 0, jitter_ns = 0;
};

struct Packet {
  std::int64_t arrival_ns = 0;  // on the receiver's clock
  std::int64_t latency_ns = 0;
  std::size_t life = 0;
  std::variant<contact_events_t, contact_frame_t, world_state_t> message;
};

struct World {
  std::vector<Life> lives;
  Clocks clocks;
  Wire wire;
  std::vector<Packet> packets;  // in order of arrival
};

inline contact_event_t event_of(const TrueContact& c, std::int8_t kind, std::int64_t time_ns, std::int64_t id,
                                Random& random) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = c.shown.contact_id;
  e.kind = kind;
  e.time_ns = time_ns;
  e.body_a = c.shown.body_a, e.body_b = c.shown.body_b;
  e.material_a = c.shown.material_a, e.material_b = c.shown.material_b;
  e.tool = c.shown.tool;
  e.normal.z = 1;
  e.approach_speed_m_s = static_cast<float>(random.real(0.01, 2));
  e.effective_mass_kg = static_cast<float>(random.real(0.01, 1));
  return e;
}

inline Life make_life(Random& random, std::size_t number, std::int64_t begin_ns) {
  Life life;
  life.incarnation = 1000 + static_cast<std::int64_t>(number);
  life.begin_ns = begin_ns;
  life.length_ns = random.whole(60, 180) * kMs;
  const std::int64_t prefix = life.incarnation << 40;
  const auto contacts = random.whole(1, 9);
  for (std::int64_t i = 0; i < contacts; ++i) {
    TrueContact c{};
    c.group = random.chance(0.6) ? 0 : random.chance(0.5) ? 1 : 2;
    c.shown.contact_id = prefix + i;
    c.shown.tool = c.group == 0 ? random.chance(0.8) ? kTool : 1 : -1;
    c.shown.body_a = static_cast<std::int32_t>(i), c.shown.body_b = kToolBody + std::max(0, c.shown.tool);
    c.shown.material_a = static_cast<std::int32_t>(10 + i), c.shown.material_b = 3;
    c.shown.normal.z = 1;
    c.shown.point_count = 1;
    c.shown.points.resize(1);
    c.begin_ns = random.whole(0, life.length_ns);
    // Some contacts end before any snapshot shows them, some outlast the simulation.
    c.end_ns =
        c.begin_ns + (random.chance(0.4) ? random.whole(10'000, 5 * kMs) : random.whole(5 * kMs, 200 * kMs));
    c.force_N = random.real(1, 5);
    c.slope_N_ms = random.real(-0.004, 0.01);
    life.events.push_back(event_of(c, contact_event_t::BEGIN, c.begin_ns, 0, random));
    for (auto hits = random.whole(0, 2); hits > 0; --hits)
      life.events.push_back(event_of(c, contact_event_t::HIT, random.whole(c.begin_ns, c.end_ns - 1), 0, random));
    life.events.push_back(event_of(c, contact_event_t::END, c.end_ns, 0, random));
    life.contacts.push_back(c);
  }
  std::stable_sort(life.events.begin(), life.events.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  for (std::size_t i = 0; i < life.events.size(); ++i)
    life.events[i].event_id = prefix + static_cast<std::int64_t>(i);
  life.bodies.resize(static_cast<std::size_t>(random.whole(1, 5)));
  for (TrueBody& b : life.bodies) {
    for (auto& a : b.a) a = Eigen::Vector3d(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    b.turn_rad_s = random.real(-10, 10);
  }
  return life;
}

// The messages of sim_node in one incarnation, each delivered or lost.
class LifePublisher {
 public:
  LifePublisher(World& world, std::size_t life, Random& random)
      : world_(world), life_(world.lives[life]), number_(life), random_(random) {}

  void publish() {
    std::int64_t frame = 0;
    for (std::int64_t k = 0; k * kMs <= life_.length_ns; ++k) {
      step_ns_ = k * kMs;
      send_ns_ = life_.begin_ns + step_ns_ + random_.whole(0, 300'000);
      publish_events();
      publish_contacts(0, step_ns_);
      // Visual step n begins at tick ceil(1000 n / 60) and is published one step ahead, with its time to come; so are the contacts of the
      // group AHEAD.
      if (k != (1000 * frame + 59) / 60) continue;
      const std::int64_t next_ns = (1000 * (frame + 1) + 59) / 60 * kMs;
      if (frame == 0) publish_contacts(2, 0), publish_bodies(0);
      publish_contacts(1, step_ns_);
      publish_contacts(2, next_ns);
      publish_bodies(next_ns);
      ++frame;
    }
  }

 private:
  template <class Message>
  Message stamped(std::int64_t sim_ns, std::size_t page, std::size_t pages) {
    Message m{};
    m.header.sim_time_ns = sim_ns;
    m.header.publish_time_ns = send_ns_ += 2'000;
    m.header.run_id = kRun;
    m.header.clock = kTheirClock;
    m.header.incarnation = life_.incarnation;
    m.header.seq = seq_++;
    m.clock = {step_ns_, life_.begin_ns + step_ns_, 1};
    m.page = static_cast<std::int32_t>(page), m.pages = static_cast<std::int32_t>(pages);
    return m;
  }
  // Pages of at most the given number of elements; at least one page, which may be empty.
  template <class Element, class PublishPage>
  void publish_in_pages(const std::vector<Element>& elements, std::size_t max_per_page, const PublishPage& publish_page) {
    const std::size_t pages = std::max<std::size_t>(1, (elements.size() + max_per_page - 1) / max_per_page);
    for (std::size_t p = 0; p < pages; ++p)
      publish_page(p, pages,
           std::vector<Element>(
               elements.begin() + static_cast<std::ptrdiff_t>(p * max_per_page),
               elements.begin() + static_cast<std::ptrdiff_t>(std::min(elements.size(), (p + 1) * max_per_page))));
  }

  void publish_events() {
    std::vector<contact_event_t> young;
    for (const contact_event_t& e : life_.events)
      if (e.time_ns <= step_ns_ && e.time_ns > step_ns_ - 50 * kMs) young.push_back(e);
    publish_in_pages(young, 3, [&](std::size_t page, std::size_t pages, std::vector<contact_event_t> part) {
      auto m = stamped<contact_events_t>(step_ns_, page, pages);
      m.count = static_cast<std::int32_t>(part.size());
      m.events = std::move(part);
      send(std::move(m));
    });
  }
  void publish_contacts(int group, std::int64_t sim_ns) {
    std::vector<contact_t> alive;
    for (const TrueContact& c : life_.contacts)
      if (c.group == group && c.alive(sim_ns)) alive.push_back(c.at(sim_ns));
    publish_in_pages(alive, 2, [&](std::size_t page, std::size_t pages, std::vector<contact_t> part) {
      auto m = stamped<contact_frame_t>(sim_ns, page, pages);
      m.group = static_cast<std::int8_t>(group);
      m.count = static_cast<std::int32_t>(part.size());
      m.contacts = std::move(part);
      send(std::move(m));
    });
  }
  void publish_bodies(std::int64_t sim_ns) {
    const double s = static_cast<double>(sim_ns) * 1e-9;
    std::vector<body_state_t> bodies;
    for (std::size_t i = 0; i < life_.bodies.size(); ++i) {
      const TrueBody& truth = life_.bodies[i];
      body_state_t b{};
      b.body = static_cast<std::int32_t>(i);
      b.position_m = to_vec3(truth.position(s));
      b.velocity_m_s = to_vec3f(truth.velocity(s));
      b.orientation.w = static_cast<float>(std::cos(truth.turn_rad_s * s / 2));
      b.orientation.z = static_cast<float>(std::sin(truth.turn_rad_s * s / 2));
      b.angular_velocity_rad_s.z = static_cast<float>(truth.turn_rad_s);
      bodies.push_back(b);
    }
    publish_in_pages(bodies, 2, [&](std::size_t page, std::size_t pages, std::vector<body_state_t> part) {
      auto m = stamped<world_state_t>(sim_ns, page, pages);
      m.group = sim_ns > step_ns_ ? world_state_t::AHEAD : world_state_t::NOW;
      m.count = static_cast<std::int32_t>(part.size());
      m.bodies = std::move(part);
      send(std::move(m));
    });
  }

  // Loss in bursts: Gilbert's chain.
  template <class Message>
  void send(Message m) {
    const Wire& w = world_.wire;
    bad_ = random_.chance(bad_ ? 1 - 1 / w.burst : w.loss / (w.burst * (1 - w.loss)));
    if (bad_) return;
    for (int copies = random_.chance(w.twice) ? 2 : 1; copies > 0; --copies) {
      const std::int64_t latency_ns = w.least_ns + random_.whole(0, w.jitter_ns);
      world_.packets.push_back(
          {world_.clocks.to_receiver(m.header.publish_time_ns) + latency_ns, latency_ns, number_, m});
    }
  }

  World& world_;
  const Life& life_;
  std::size_t number_;
  Random& random_;
  std::int64_t step_ns_ = 0, send_ns_ = 0, seq_ = 0;
  bool bad_ = false;
};

inline World make_world(Random& random, bool other_clock) {
  World w;
  if (other_clock) w.clocks = {random.whole(-3'600'000, 3'600'000) * kMs, random.real(-100e-6, 100e-6)};
  w.wire.loss = random.chance(0.2) ? 0 : random.real(0, 0.6);
  w.wire.burst = 1 + w.wire.loss / (1 - w.wire.loss) + random.real(0, 8);
  w.wire.twice = random.chance(0.5) ? 0 : 0.3;
  w.wire.least_ns = random.whole(20'000, 2 * kMs);
  w.wire.jitter_ns = random.chance(0.3) ? 0 : random.whole(0, 25 * kMs);
  std::int64_t begin_ns = 10'000'000 * kMs;
  const auto lives = random.whole(1, 2);
  for (std::int64_t i = 0; i < lives; ++i) {
    w.lives.push_back(make_life(random, static_cast<std::size_t>(i), begin_ns));
    begin_ns += w.lives.back().length_ns + random.whole(102, 160) * kMs;  // longer than kTakeOver and the jitter
  }
  for (std::size_t i = 0; i < w.lives.size(); ++i) LifePublisher(w, i, random).publish();
  std::stable_sort(w.packets.begin(), w.packets.end(),
                   [](const Packet& a, const Packet& b) { return a.arrival_ns < b.arrival_ns; });
  return w;
}

}  // namespace tactus::hostile
