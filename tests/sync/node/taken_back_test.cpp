// Tests of body samples that are published ahead and then withdrawn, over a wire that loses, repeats and reorders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tactus/body_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/resampling/body_history.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

struct PublishedPage {
  std::int64_t now_ms = 0, time_ms = 0, seq = 0;
  std::int8_t group = world_state_t::NOW;
  std::vector<int> bodies;
};

world_state_t message(const PublishedPage& published) {
  world_state_t m{};
  m.header.sim_time_ns = published.time_ms * kMs;
  m.header.publish_time_ns = (published.now_ms + 1'000) * kMs + published.seq;
  m.header.run_id = m.header.incarnation = 1;
  m.header.seq = published.seq;
  m.clock = {published.now_ms * kMs, (published.now_ms + 1'000) * kMs, 1};
  m.group = published.group;
  m.pages = 1;
  for (const int body : published.bodies) {
    body_state_t b{};
    b.body = body;
    b.position_m.x = static_cast<double>(published.seq);  // marks the sample with its sequence number
    b.orientation.w = 1;
    b.velocity_m_s.x = 1;
    m.bodies.push_back(b);
  }
  m.count = static_cast<int>(m.bodies.size());
  return m;
}

HostTime at(std::int64_t ms) { return host_time((ms + 1'000) * kMs); }

// A correct simulation: bodies are published ahead when a visual step begins, every 17 ms, and withdrawn at any time.
std::vector<PublishedPage> publish_randomly(std::mt19937& random, int bodies, std::int64_t length_ms) {
  std::vector<PublishedPage> all;
  std::vector<char> ahead(static_cast<std::size_t>(bodies), 0);
  const auto which = [&](bool wanted) {
    std::vector<int> list;
    for (int b = 0; b < bodies; ++b)
      if ((ahead[static_cast<std::size_t>(b)] != 0) == wanted) list.push_back(b);
    return list;
  };
  const auto publish = [&](std::int64_t now, std::int64_t time, std::int8_t group, std::vector<int> list) {
    if (!list.empty()) all.push_back({now, time, static_cast<std::int64_t>(all.size()), group, std::move(list)});
  };
  for (std::int64_t now = 0; now < length_ms; ++now) {
    std::vector<int> promoted;
    for (const int b : which(true))
      if (random() % 25 == 0) promoted.push_back(b);
    for (const int b : promoted) ahead[static_cast<std::size_t>(b)] = 0;
    publish(now, now, world_state_t::PROMOTED, promoted);
    if (now % 17 != 0) continue;
    publish(now, now, world_state_t::NOW, which(false));
    for (const int b : which(false))
      if (random() % 2 == 0 && std::find(promoted.begin(), promoted.end(), b) == promoted.end())
        ahead[static_cast<std::size_t>(b)] = 1;
    publish(now, now + 17, world_state_t::AHEAD, which(true));
  }
  return all;
}

// Valid samples of each body among those received, by their time; the rule of world_state_t to the letter.
std::map<std::int64_t, PublishedPage> that_hold(const std::vector<PublishedPage>& arrived, int body) {
  std::map<std::int64_t, PublishedPage> out;
  const auto contains_body = [body](const PublishedPage& s) {
    return std::find(s.bodies.begin(), s.bodies.end(), body) != s.bodies.end();
  };
  for (const PublishedPage& s : arrived) {
    if (!contains_body(s)) continue;
    const bool foreseen = s.group == world_state_t::AHEAD;
    const bool taken_back =
        foreseen && std::any_of(arrived.begin(), arrived.end(), [&](const PublishedPage& n) {
          return contains_body(n) && n.group != world_state_t::AHEAD && n.seq > s.seq && n.time_ms <= s.time_ms;
        });
    if (!taken_back) out.try_emplace(s.time_ms, s);
  }
  return out;
}

}  // namespace

TEST_CASE("A retracted pose never returns when pages are lost, repeated and reordered") {
  int voided = 0, compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    constexpr int kBodies = 5;
    const std::vector<PublishedPage> published = publish_randomly(random, kBodies, 300);
    const unsigned loss = random() % 40, jitter_ms = 1 + random() % 60;
    std::vector<std::pair<std::int64_t, PublishedPage>> wire;
    for (const PublishedPage& s : published) {
      if (random() % 100 < loss) continue;
      for (int copies = random() % 4 == 0 ? 2 : 1; copies > 0; --copies)
        wire.emplace_back(s.now_ms * kMs + static_cast<std::int64_t>(random() % (jitter_ms * kMs)), s);
    }
    std::stable_sort(wire.begin(), wire.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    BodyHistory history(1);
    std::vector<PublishedPage> arrived;
    for (std::size_t i = 0; i < wire.size(); ++i) {
      history.push(message(wire[i].second), host_time(wire[i].first + 1'000 * kMs));
      arrived.push_back(wire[i].second);
      if (i % 7 != 0 && i + 1 != wire.size()) continue;
      for (int body = 0; body < kBodies; ++body) {
        const auto hold = that_hold(arrived, body);
        for (const auto& [time_ms, sample] : hold) {
          const auto pose = history.pose(body, sim_time(time_ms * kMs));
          REQUIRE(pose.status == SampleStatus::kExact);
          REQUIRE(pose.value.position.x() == static_cast<double>(sample.seq));
          ++compared;
        }
        // The history holds valid samples only.
        for (const PublishedPage& s : arrived) {
          if (hold.contains(s.time_ms)) continue;
          const auto status = history.pose(body, sim_time(s.time_ms * kMs)).status;
          REQUIRE(status != SampleStatus::kExact);
          ++voided;
        }
      }
    }
    REQUIRE(history.refused() == 0);
  }
  CHECK(compared > 10'000);
  CHECK(voided > 1'000);
}

TEST_CASE("The path of a body is continuous after its poses ahead are retracted") {
  BodyHistory history(1);
  const auto push = [&](std::int64_t now, std::int64_t time, std::int64_t seq, std::int8_t group, double x,
                        float v) {
    world_state_t m = message({now, time, seq, group, {3}});
    m.bodies[0].position_m.x = x;
    m.bodies[0].velocity_m_s.x = v;
    history.push(m, at(now));
  };
  push(0, 0, 0, world_state_t::NOW, 0, 1);
  push(0, 17, 1, world_state_t::AHEAD, 0.017, 1);
  const auto x = [&](std::int64_t ns) { return history.pose(3, sim_time(ns)).value.position.x(); };
  const double just_before = x(6 * kMs);
  push(6, 6, 2, world_state_t::PROMOTED, 0.006, 1);
  CHECK(x(6 * kMs) == Approx(just_before));
  push(17, 17, 3, world_state_t::NOW, 0.006, -1);  // a collision stopped it and threw it back
  CHECK(history.pose(3, sim_time(17 * kMs)).value.position.x() == Approx(0.006));
  double last = x(0);
  for (std::int64_t ns = 0; ns <= 30 * kMs; ns += 100'000) {
    CHECK(std::abs(x(ns) - last) < 2.1e-4);  // 100 us at 2 m/s, the larger of the two speeds
    last = x(ns);
  }
}

TEST_CASE("Poses 40 ms ahead are accepted, and poses 1.1 s ahead are rejected") {
  BodyHistory history(1);
  history.push(message({0, 0, 0, world_state_t::NOW, {0}}), at(0));
  history.push(message({0, 40, 1, world_state_t::AHEAD, {0}}), at(0));
  CHECK(history.refused() == 0);
  CHECK(history.pose(0, sim_time(40 * kMs)).status == SampleStatus::kExact);
  history.push(message({0, 1'100, 2, world_state_t::AHEAD, {0}}), at(0));
  CHECK(history.refused() == 1);
  // A forged number beyond those of all honest pages.
  history.push(message({1, 1, std::int64_t{1} << 60, world_state_t::NOW, {0}}), at(1));
  for (std::int64_t ms = 17, seq = 3; ms < 2'000; ms += 17, ++seq)
    history.push(message({ms, ms + 17, seq, world_state_t::AHEAD, {0}}), at(ms));
  CHECK(history.pose(0, sim_time(1'700 * kMs)).status == SampleStatus::kExact);
}

TEST_CASE("A resting body starts to move within the last snapshot interval") {
  BodyHistory history(1);
  const auto push = [&](std::int64_t now, std::int64_t seq, double x, float v) {
    world_state_t m = message({now, now, seq, world_state_t::NOW, {0}});
    m.rate_Hz = 60;
    m.bodies[0].position_m.x = x;
    m.bodies[0].velocity_m_s.x = v;
    history.push(m, at(now));
  };
  push(0, 0, 5, 0);
  push(900, 1, 5.016, 1);
  for (std::int64_t ms = 0; ms <= 883; ++ms) CHECK(history.pose(0, sim_time(ms * kMs)).value.position.x() == 5);
  for (std::int64_t ms = 883; ms <= 900; ++ms) {
    CHECK(history.pose(0, sim_time(ms * kMs)).value.position.x() > 5 - 1e-9);
    CHECK(history.pose(0, sim_time(ms * kMs)).value.position.x() < 5.016 + 1e-9);
  }
}
