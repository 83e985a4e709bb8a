// A fan that blows a gust for every hit. Pure: no bus, no clock.
#pragma once
#include <cmath>
#include <tactus/contact_event_t.hpp>
#include "sync/presentation/late.h"
#include "wind_node/settings.gen.h"

namespace tactus::wind {
struct Fan {
  double gust = 0, share = 0;  // gust: of the hits, 0 .. 1; share: commanded share of the fan's full speed, 0 .. 1
  // One tick. response_s: time constant of the fan as an output operator sets it; 0: none.
  void step(const Settings& s, double response_s) {
    gust *= std::exp(-1 / (s.rate_Hz * s.gust_time_s));
    share += (response_s > 0 ? 1 - std::exp(-1 / (s.rate_Hz * response_s)) : 1) * (gust - share);
  }
  // Starts the gust of a hit in this tick, unless it is too late. Returns the report.
  presentation_t blow(const Settings& s, const contact_event_t& hit, sync::HostTime scheduled, sync::HostTime now) {
    const sync::LatePolicy late{sync::LateRule::kShowNewest, sync::from_seconds(s.late_after_s),
                                sync::from_seconds(s.drop_after_s)};
    const std::int8_t outcome = late.outcome(now - scheduled);
    const bool blows = outcome != presentation_t::DROPPED_LATE;
    if (blows) gust = std::fmin(1, gust + hit.approach_speed_m_s / s.full_hit_m_s);
    const std::int64_t half_tick_ns = sync::from_seconds(0.5 / s.rate_Hz).count(), at_ns = blows ? sync::to_ns(now) : -1;
    return {hit.event_id, presentation_t::WHOLE, -1, sync::to_ns(scheduled), at_ns, half_tick_ns, outcome};
  }
};
}  // namespace tactus::wind
