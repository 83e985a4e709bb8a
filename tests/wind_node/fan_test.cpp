// Tests of the fan model.
#include "tests/wind_node/fan.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kMs = 1'000'000;
const wind::Settings kSettings;

HostTime host(std::int64_t ms) { return host_time(ms * kMs); }

contact_event_t hit() {
  contact_event_t e{};
  e.event_id = 7;
  e.kind = contact_event_t::HIT;
  e.approach_speed_m_s = 1;
  return e;
}

}  // namespace

TEST_CASE("A hit starts a gust in its tick, is reported as presented, and decays") {
  wind::Fan fan;
  const presentation_t report = fan.blow(kSettings, hit(), host(43), host(60));
  CHECK(report.event_id == 7);
  CHECK(report.outcome == presentation_t::PRESENTED);
  CHECK(report.scheduled_ns == to_ns(host(43)));
  CHECK(report.presented_ns == to_ns(host(60)));
  CHECK(fan.gust == Approx(0.5));  // 1 m/s of 2
  fan.step(kSettings, 0);
  CHECK(fan.gust == Approx(0.5 * std::exp(-0.020 / 0.15)));
  CHECK(fan.share == fan.gust);
}

TEST_CASE("A late gust is reported as late, and a gust beyond the limit is dropped") {
  wind::Fan fan;
  CHECK(fan.blow(kSettings, hit(), host(730), host(900)).outcome == presentation_t::LATE);
  fan.gust = 0;
  const presentation_t report = fan.blow(kSettings, hit(), host(830), host(2000));
  CHECK(report.outcome == presentation_t::DROPPED_LATE);
  CHECK(report.presented_ns == -1);
  CHECK(fan.gust == 0);
}

TEST_CASE("Gusts add up to at most the full speed") {
  wind::Fan fan;
  for (int i = 0; i < 5; ++i) fan.blow(kSettings, hit(), host(0), host(0));
  CHECK(fan.gust == 1);
}

TEST_CASE("A slowed fan follows with its time constant") {
  wind::Fan fan;
  fan.gust = 1;
  fan.step(kSettings, 0.02);
  CHECK(fan.share == Approx((1 - std::exp(-1.0)) * fan.gust).epsilon(1e-6));
}
