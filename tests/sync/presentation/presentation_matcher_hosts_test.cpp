// Tests of matching presentations of hosts with different clocks.
#include "sync/presentation/presentation_matcher.h"

#include <catch2/catch.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presented_t.hpp>

#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

// audio_node runs on a host whose clock (2) is an hour ahead of the matcher's (1).
struct TwoHosts {
  static constexpr std::int64_t kAhead = 3'600'000'000'000;
  MatcherFixture f;
  ClockMaps maps{MatcherFixture::kRun};

  TwoHosts() { f.matcher = PresentationMatcher(OwnClock(MatcherFixture::kRun, 1, &maps)); }
  template <class Message>
  Message here(Message m) const {
    m.header.clock = 1;
    return m;
  }
  template <class Message>
  Message there(Message m) const {
    m.header.clock = 2;
    m.header.publish_time_ns += kAhead;
    return m;
  }
  void map(double ms) {
    clock_map_t m{};
    m.header = header_of("sync_node", 1, 0, to_ns(f.at(ms)), MatcherFixture::kRun);
    m.of_clock = 2, m.to_clock = m.header.clock = 1;
    m.at_ns = to_ns(f.at(ms)), m.offset_ns = kAhead, m.uncertainty_ns = 40'000, m.uncertainty_drift = 20e-6;
    maps.observe(m, f.at(ms));
  }
  void run(double from, double to) {
    for (double ms = from; ms <= to; ms += 100) {
      f.matcher.observe(here(f.health_message("visual_node", "visual", kHit, ms)), f.at(ms));
      f.matcher.observe(there(f.health_message("audio_node", "audio", kHit, ms)), f.at(ms + 0.2));
    }
  }
  void both_present(std::int64_t id, double ms) {
    f.matcher.observe(here(f.event_message(id, ms, contact_event_t::HIT, 100)), f.at(ms + 1));
    presented_t seen = here(f.presented_message("visual_node", "visual", id, ms + 10));
    seen.reports[0].uncertainty_ns = 500'000;
    f.matcher.observe(seen, f.at(ms + 11));
    presented_t heard = there(f.presented_message("audio_node", "audio", id, ms + 20));
    heard.reports[0].presented_ns += kAhead;
    heard.reports[0].uncertainty_ns = 100'000;
    f.matcher.observe(heard, f.at(ms + 21));
  }
};

}  // namespace

TEST_CASE("Presentation times of another host are mapped with the uncertainty of the map") {
  TwoHosts t;
  t.map(500);
  t.run(0, 5000);
  t.both_present(1, 1000);
  t.f.matcher.advance(t.f.at(2500));
  CHECK(t.f.tally("audio").presented == 1);
  const auto& pair = t.f.matcher.pairs().at({"audio", "visual"});
  CHECK(static_cast<double>(pair.quantile(0.5).count()) * 1e-6 == Approx(-10).margin(0.1));
  // 500 us of the picture, 100 us of the sound, 40 us of the map and its drift in half a second.
  CHECK(pair.uncertainty() >= Nanoseconds(640'000));
  CHECK(pair.uncertainty() < Nanoseconds(660'000));
}

TEST_CASE("Without a clock map of its host a modality has outcomes but no asynchronies") {
  TwoHosts t;
  t.run(0, 5000);
  t.both_present(1, 1000);
  t.f.matcher.advance(t.f.at(2500));
  CHECK(t.f.tally("audio").presented == 1);
  CHECK(t.f.tally("audio").lost == 0);
  CHECK(t.f.matcher.pairs().empty());
}
