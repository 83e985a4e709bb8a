// Tests of publishing presentation reports.
#include "sync/bus/bus.h"
#include "sync/presentation/presentation_reporter.h"

#include <catch2/catch.hpp>
#include <map>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>

using namespace tactus;
using namespace tactus::sync;

namespace {

presentation_t presented_event(std::int64_t event_id, HostTime at) {
  presentation_t r{};
  r.event_id = event_id;
  r.part = presentation_t::WHOLE;
  r.scheduled_ns = r.presented_ns = to_ns(at);
  r.uncertainty_ns = 1;
  r.outcome = presentation_t::PRESENTED;
  return r;
}

}  // namespace

TEST_CASE("Each report is sent twice, at least 20 ms apart") {
  BusOptions memory;
  memory.memory = true;
  Bus bus(Identity::fresh("test", 1), memory);
  auto& inbox = bus.queue<presented_t>(channels::kPresented, 1000);
  PresentationReporter reporter("audio");
  std::map<std::int64_t, std::vector<HostTime>> seen;
  HostTime now = host_time(1);
  for (int ms = 0; ms < 100; ++ms, now += Nanoseconds(1'000'000)) {
    if (ms < 10)
      for (int i = 0; i < 45; ++i) reporter.report(presented_event(ms * 100 + i, now));
    reporter.publish(bus, now);
    bus.drain(now);
    while (const auto m = inbox.pop()) {
      CHECK(m->message.modality == "audio");
      for (const auto& r : m->message.reports) seen[r.event_id].push_back(now);
    }
  }
  CHECK(seen.size() == 450);
  for (const auto& [id, times] : seen) {
    REQUIRE(times.size() == 2);
    CHECK(times[1] - times[0] >= PresentationReporter::kRepeatAfter);
  }
  CHECK(bus.refused() == 0);
}

TEST_CASE("The number of pending reports is bounded, and dropped ones are counted") {
  PresentationReporter reporter("audio");
  for (int i = 0; i < 3000; ++i) reporter.report(presented_event(i, host_time(0)));
  CHECK(reporter.dropped() == 3000 - static_cast<int>(PresentationReporter::kMaxPending));
}
