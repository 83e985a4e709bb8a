// Tests of publishing presentation reports.
#include "sync/bus/bus.h"
#include "sync/presentation/presentation_reporter.h"

#include <catch2/catch.hpp>
#include <map>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>

using namespace tactus;
using namespace tactus::sync;

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
      for (int i = 0; i < 45; ++i)
        reporter.report(ms * 100 + i, presentation_t::WHOLE, now, now, Nanoseconds(1), presentation_t::PRESENTED);
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
  for (int i = 0; i < 3000; ++i)
    reporter.report(i, presentation_t::WHOLE, host_time(0), host_time(0), Nanoseconds(0), presentation_t::PRESENTED);
  CHECK(reporter.dropped() == 3000 - static_cast<int>(PresentationReporter::kMaxPending));
}
