// Figures of the simulation and of the first hand of three_hands.sdf over a span, from the log of a run.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/cluster/support/run_log.h"

namespace tactus::cluster {

inline constexpr int kLeft = 0, kRight = 1, kThird = 2;  // order of the tools in three_hands.sdf
inline constexpr double kPeriod_s = 0.5;                 // period of the taps of the left hand

// Figures of the simulation and of the hand that stays over a span.
struct Figures {
  // Rate of the touch models for that hand, and of its loop, on a machine that delays no loop: both are loops of 1000 Hz.
  double sim_Hz = 0, hand_Hz = 0;
  double sim_step_p50_ms = 0, sim_step_p99_ms = 0;    // from one touch model to the next
  double hand_step_p50_ms = 0, hand_step_p99_ms = 0;  // from one tool state to the next
  double machine_p99_ms = 0;                          // as in Span
  double age_p50_ms = 0, age_p90_ms = 0;  // age of the newest touch model, as that hand reports it 10 times per second
  double felt_p50_ms = 0;                 // delay from a hit to its vibration
  std::vector<double> force_N;            // by ms of the repeated path, median
  double peak_N() const { return *std::max_element(force_N.begin(), force_N.end()); }
};

inline Figures figures_of_span(const RunLog& log, const Span& span) {
  Figures f;
  std::vector<std::int64_t> steps, ticks;
  std::vector<std::vector<double>> force(static_cast<std::size_t>(kPeriod_s * 1000));
  log.for_each<touch_model_t>(channels::kTouchModel, span, [&](const touch_model_t& m) {
    if (m.tool == kLeft && m.page == 0) steps.push_back(m.header.publish_time_ns);
  });
  log.for_each<tool_state_t>(channels::kToolState, span, [&](const tool_state_t& m) {
    if (m.tool != kLeft) return;
    ticks.push_back(m.header.publish_time_ns);
    // The host's time, which the path of a virtual hand follows.
    const auto ms = static_cast<std::size_t>(m.header.publish_time_ns / 1'000'000) % force.size();
    force[ms].push_back(std::hypot(m.force_N.x, m.force_N.y, m.force_N.z));
  });
  std::vector<double> ages, delays_ms;
  log.for_each<node_health_t>(channels::kNodeHealth, span, [&](const node_health_t& m) {
    for (const input_health_t& in : m.inputs)
      if (m.node == "haptic_node" && in.channel == channels::kTouchModel)
        ages.push_back(static_cast<double>(in.age_ns) * 1e-6);
  });
  std::map<std::int64_t, std::int64_t> event_ns;
  log.for_each<contact_events_t>(channels::kContactEvents, span, [&](const contact_events_t& m) {
    for (const contact_event_t& e : m.events)
      if (e.tool == kLeft && e.kind == contact_event_t::HIT && m.clock.rate > 0)
        event_ns[e.event_id] =
            m.clock.host_ns +
            static_cast<std::int64_t>(static_cast<double>(e.time_ns - m.clock.sim_ns) / m.clock.rate);
  });
  log.for_each<presented_t>(channels::kPresented, span, [&](const presented_t& m) {
    for (const presentation_t& p : m.reports)
      if (m.modality == "haptic" && p.part == presentation_t::TRANSIENT && p.presented_ns >= 0 &&
          event_ns.contains(p.event_id))
        delays_ms.push_back(static_cast<double>(p.presented_ns - event_ns.at(p.event_id)) * 1e-6);
  });
  f.machine_p99_ms = span.machine_p99_ms;
  const double slowness = span.machine_Hz > 0 ? 1000 / span.machine_Hz : 1;
  f.sim_Hz = std::min(1000.0, slowness * static_cast<double>(steps.size()) / span.seconds());
  f.hand_Hz = std::min(1000.0, slowness * static_cast<double>(ticks.size()) / span.seconds());
  f.sim_step_p50_ms = quantile(steps_ms(steps), 0.5), f.sim_step_p99_ms = quantile(steps_ms(steps), 0.99);
  f.hand_step_p50_ms = quantile(steps_ms(ticks), 0.5), f.hand_step_p99_ms = quantile(steps_ms(ticks), 0.99);
  f.age_p50_ms = quantile(ages, 0.5), f.age_p90_ms = quantile(ages, 0.9);
  f.felt_p50_ms = quantile(delays_ms, 0.5);
  for (const auto& samples : force) f.force_N.push_back(quantile(samples, 0.5));
  return f;
}

// The best of each figure over three spans: other work on the machine comes and goes and delays the simulation or a hand in some spans,
// but an effect of the other hands would be in all three. The force is the median.
inline Figures figures(const RunLog& log, const std::vector<Span>& spans) {
  std::vector<Figures> each;
  for (const Span& span : spans) each.push_back(figures_of_span(log, span));
  const auto values = [&](const auto& get) {
    std::vector<double> x;
    for (const Figures& f : each) x.push_back(get(f));
    return x;
  };
  Figures f;
  for (const auto rate : {&Figures::sim_Hz, &Figures::hand_Hz})
    f.*rate = quantile(values([&](const Figures& g) { return g.*rate; }), 1);
  for (const auto time :
       {&Figures::sim_step_p50_ms, &Figures::sim_step_p99_ms, &Figures::hand_step_p50_ms,
        &Figures::hand_step_p99_ms, &Figures::machine_p99_ms, &Figures::age_p50_ms, &Figures::age_p90_ms, &Figures::felt_p50_ms})
    f.*time = quantile(values([&](const Figures& g) { return g.*time; }), 0);
  for (std::size_t ms = 0; ms < each.front().force_N.size(); ++ms)
    f.force_N.push_back(quantile(values([&](const Figures& g) { return g.force_N[ms]; }), 0.5));
  return f;
}

// Mean difference of two traces of force where either is not 0, N. It is also small for the same taps shifted by some ms.
inline double mean_difference_N(const Figures& a, const Figures& b) {
  double sum = 0;
  int samples = 0;
  for (std::size_t i = 0; i < a.force_N.size(); ++i) {
    if (std::max(a.force_N[i], b.force_N[i]) < 0.01) continue;
    sum += std::abs(a.force_N[i] - b.force_N[i]);
    ++samples;
  }
  return samples > 0 ? sum / samples : 0;
}

inline std::string to_text(const Figures& f) {
  std::ostringstream out;
  out << "sim " << f.sim_Hz << " Hz, step " << f.sim_step_p50_ms << " / " << f.sim_step_p99_ms
      << " ms (p50 / p99); hand " << f.hand_Hz << " Hz, tick " << f.hand_step_p50_ms << " / " << f.hand_step_p99_ms
      << " ms; touch model " << f.age_p50_ms << " / " << f.age_p90_ms << " ms old (p50 / p90); felt after "
      << f.felt_p50_ms << " ms; peak " << f.peak_N() << " N; an empty loop " << f.machine_p99_ms << " ms (p99)\n";
  return out.str();
}

}  // namespace tactus::cluster
