// Tests of tracking the offset of another clock: uncertainty, drift, slew and jumps.
#include "sync/clock_sync/offset_tracker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

using namespace tactus::sync;

namespace {

constexpr double kSecond = 1e9;
HostTime at(double ns) { return host_time(static_cast<std::int64_t>(ns)); }

// Another host: theirs(t) = t + offset(t). Probes have the delays of a network.
struct Network {
  std::mt19937 random{1};
  std::function<double(double)> offset = [](double) { return 5000 * kSecond; };
  double there_ns = 30e3, back_ns = 30e3, jitter_ns = 40e3;

  OffsetSample probe(double now) {
    std::exponential_distribution<double> jitter(1 / std::max(jitter_ns, 1.0));
    const double arrive = now + there_ns + jitter(random), reply = arrive + 20e3, back = reply + back_ns + jitter(random);
    return probe_sample(at(now), at(arrive + offset(arrive)), at(reply + offset(reply)), at(back));
  }
  // The smallest round trip of eight.
  OffsetSample wave(double now) {
    OffsetSample best = probe(now);
    for (int i = 1; i < 8; ++i)
      if (const OffsetSample s = probe(now + i * 64e6); s.half_width < best.half_width) best = s;
    return best;
  }
};

double value_at(const OffsetLine& line, double now) {
  return static_cast<double>(line.offset.count()) + line.drift * (now - static_cast<double>(to_ns(line.at)));
}
double uncertainty_at(const OffsetLine& line, double now) {
  return static_cast<double>(line.uncertainty.count()) +
         line.uncertainty_drift * std::abs(now - static_cast<double>(to_ns(line.at)));
}

struct Course {
  double worst_excess_ns = -1e18;   // part of the error that exceeds the uncertainty
  double worst_step_ns = 0;         // between two lines of one epoch
  double fastest_slew = 0;
  double last_uncertainty_ns = 0;
  OffsetTracker tracker;

  // Waves every 2 s, lines every 0.5 s, checked in between; `drop` selects the waves that are lost.
  void run(Network& network, double from_s, double to_s, const std::function<bool(int)>& drop = [](int) { return false; }) {
    std::optional<OffsetLine> line;
    for (int half = static_cast<int>(2 * from_s); half < static_cast<int>(2 * to_s); ++half) {
      const double now = half * 0.5 * kSecond;
      if (half % 4 == 0 && !drop(half / 4)) tracker.add(network.wave(now - 0.6 * kSecond));
      const OffsetLine next = tracker.line(at(now));
      if (line && line->epoch == next.epoch)
        worst_step_ns = std::max(worst_step_ns, std::abs(value_at(*line, now) - value_at(next, now)));
      line = next;
      fastest_slew = std::max(fastest_slew, std::abs(next.drift));
      for (double later = 0; later < 0.5 * kSecond; later += 0.1 * kSecond) {
        const double t = now + later;
        worst_excess_ns = std::max(worst_excess_ns, std::abs(value_at(next, t) - network.offset(t)) - uncertainty_at(next, t));
        last_uncertainty_ns = uncertainty_at(next, t);
      }
    }
  }
};

}  // namespace

TEST_CASE("The interval of a probe contains the true offset for any latency in either direction") {
  Network n;
  std::uniform_real_distribution<double> way(0, 20e6), drift(-200e-6, 200e-6);
  for (int i = 0; i < 20000; ++i) {
    n.there_ns = way(n.random), n.back_ns = way(n.random);
    const double rate = drift(n.random);
    n.offset = [&](double t) { return -700 * kSecond + rate * (t - 50 * kSecond); };
    const OffsetSample s = n.probe(100 * kSecond);
    const double error = static_cast<double>(s.offset.count()) - n.offset(static_cast<double>(to_ns(s.at)));
    REQUIRE(std::abs(error) <= static_cast<double>(s.half_width.count()));
  }
}

TEST_CASE("The uncertainty bounds the true offset at any drift and with lost waves, without steps") {
  for (const double ppm : {-200.0, -100.0, -20.0, 0.0, 1.0, 50.0, 200.0}) {
    for (unsigned seed = 1; seed < 6; ++seed) {
      Network n;
      n.random.seed(seed);
      n.offset = [&](double t) { return 5000 * kSecond + ppm * 1e-6 * t; };
      Course c;
      c.run(n, 10, 200, [&](int wave) { return wave > 5 && std::hash<unsigned>()(seed * 977 + unsigned(wave)) % 3 == 0; });
      INFO(ppm << " ppm, seed " << seed);
      CHECK(c.worst_excess_ns <= 0);
      CHECK(c.worst_step_ns <= 2);  // rounding
      CHECK(c.fastest_slew <= OffsetTracker::kMaxDrift + OffsetTracker::kMaxSlew);
      CHECK(c.tracker.epoch() == 0);
    }
  }
}

TEST_CASE("On an idle network the uncertainty is below 200 us once the rate has been measured") {
  Network n;
  n.offset = [](double t) { return 3 * kSecond + 80e-6 * t; };
  Course c;
  c.run(n, 10, 40);
  CHECK(c.last_uncertainty_ns < 200e3);
}

TEST_CASE("An asymmetric latency increases the uncertainty") {
  Network n;
  n.back_ns += 2e6;
  Course c;
  c.run(n, 10, 60);
  CHECK(c.worst_excess_ns <= 0);
  CHECK(c.last_uncertainty_ns > 1e6);
  CHECK(c.last_uncertainty_ns < 1.5e6);
}

TEST_CASE("A change of the clock rate is tracked without a new epoch") {
  Network n;
  n.offset = [](double t) { return 9 * kSecond + (t < 60 * kSecond ? 0 : 150e-6 * (t - 60 * kSecond)); };
  Course c;
  c.run(n, 10, 60);
  c.worst_excess_ns = -1e18;
  c.run(n, 64, 120);  // from the second wave after the change on
  CHECK(c.worst_excess_ns <= 0);
  CHECK(c.worst_step_ns <= 2);
  CHECK(c.tracker.epoch() == 0);
}

TEST_CASE("A clock that jumps by 2 ms or more is acquired again with the next wave") {
  for (const double jump : {-3600 * kSecond, -0.5 * kSecond, -2e6, 2e6, 0.5 * kSecond, 3600 * kSecond}) {
    Network n;
    Course c;
    c.run(n, 10, 60);
    n.offset = [&](double) { return 5000 * kSecond + jump; };
    CHECK(c.tracker.add(n.wave(60 * kSecond)) == OffsetTracker::Outcome::kJumped);
    CHECK(c.tracker.epoch() == 1);
    c.worst_excess_ns = -1e18;
    c.run(n, 62, 90);
    CHECK(c.worst_excess_ns <= 0);
    CHECK(c.worst_step_ns <= 2);
  }
}

TEST_CASE("The uncertainty grows while probes are lost and recovers with the next replies") {
  Network n;
  n.offset = [](double t) { return kSecond + 30e-6 * t; };
  Course c;
  c.run(n, 10, 60);
  const double before = c.last_uncertainty_ns;
  c.run(n, 60, 90, [](int) { return true; });
  CHECK(c.last_uncertainty_ns > before + 30 * 15e3);  // 30 s at 15 ppm
  c.run(n, 90, 120);
  CHECK(c.last_uncertainty_ns < 200e3);
  CHECK(c.worst_excess_ns <= 0);
  CHECK(c.worst_step_ns <= 2);
  CHECK(c.tracker.epoch() == 0);
}

TEST_CASE("An offset error is slewed, so that the map stays continuous and monotone") {
  OffsetTracker tracker;
  tracker.add({at(10 * kSecond), Nanoseconds(0), Nanoseconds(5'000'000)});
  CHECK(tracker.line(at(10 * kSecond)).offset == Nanoseconds(0));
  tracker.add({at(12 * kSecond), Nanoseconds(4'000'000), Nanoseconds(100'000)});
  OffsetLine line = tracker.line(at(12 * kSecond));
  CHECK(std::abs(line.offset.count()) < 1000);
  CHECK(line.uncertainty > Nanoseconds(4'000'000));  // the reported uncertainty covers the remaining error
  for (int i = 1; i <= 40; ++i) {
    const OffsetLine next = tracker.line(at((12 + 0.5 * i) * kSecond));
    REQUIRE(next.offset >= line.offset - Nanoseconds(1));
    REQUIRE(1 + next.drift > 0);
    line = next;
  }
  CHECK(std::abs(line.offset.count() - 4'000'000) < 300'000);
}
