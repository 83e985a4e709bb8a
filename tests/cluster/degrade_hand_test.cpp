// Tests of each degradation of touch and warmth: it changes the rendered force, and no other modality is affected.
#include <cmath>
#include <set>
#include <tactus/header_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/cluster/support/profiles.h"
#include "tests/cluster/support/run_log.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr std::size_t kPeriod_ms = 500;          // period of the taps in tapping.sdf, whose path follows the host's time
using Trace = std::vector<std::vector<double>>;  // by ms of the period

std::size_t phase_ms(const header_t& h) {
  return static_cast<std::size_t>(h.publish_time_ns / 1'000'000) % kPeriod_ms;
}

// Measurements over one span: the rendered force, and the timing of the other modalities.
struct Measurement {
  Trace force = Trace(kPeriod_ms), thermal_force = Trace(kPeriod_ms);  // force on the hand, N, and the force in the input of warmth, N
  std::set<int> held_forces_cN;                                          // forces that were held for at least 5 ticks
  std::vector<std::int64_t> ticks, world;                          // send times of TOOL_STATE and TOUCH_MODEL
  Trace setpoints = Trace(kPeriod_ms / 20);    // degrees C, by tick of the period: setpoint of the display
  std::map<std::string, double> wait_ms;  // median delay of each other modality

  double peak_N() const {
    double max = 0;
    for (const auto& f : force) max = std::max(max, f.empty() ? 0 : median(f));
    return max;
  }
};

// Peak-to-peak temperature of the display with each tap, K.
double ripple_K(const Measurement& f) {
  double min = 100, max = -100;
  for (const auto& setpoints : f.setpoints) {
    if (setpoints.empty()) continue;
    min = std::min(min, median(setpoints));
    max = std::max(max, median(setpoints));
  }
  return max - min;
}

struct DegradedCluster : RunningCluster {
  sync::Queue<tool_state_t>& tools = monitor.bus().queue<tool_state_t>(channels::kToolState, 8192);
  sync::Queue<touch_model_t>& models = monitor.bus().queue<touch_model_t>(channels::kTouchModel, 8192);
  sync::Queue<thermal_state_t>& skins = monitor.bus().queue<thermal_state_t>(channels::kThermalState, 8192);

  Measurement measure(double seconds) {
    while (tools.pop()) {
    }
    while (models.pop()) {
    }
    while (skins.pop()) {
    }
    Measurement f;
    const PresentedEvents before = presented_events(monitor);
    int held = 0, last_cN = 0;
    for (double waited = 0; waited < seconds; waited += 0.5) {
      monitor.receive_for(0.5);
      while (auto m = tools.pop()) {
        const tool_state_t& t = m->message;
        const double N = std::hypot(t.force_N.x, t.force_N.y, t.force_N.z);
        f.force[phase_ms(t.header)].push_back(N);
        f.ticks.push_back(t.header.publish_time_ns);
        const int cN = static_cast<int>(std::lround(100 * N));
        held = cN == last_cN ? held + 1 : 0;
        last_cN = cN;
        if (held == 5 && cN > 0) f.held_forces_cN.insert(cN);
      }
      while (auto m = models.pop())
        if (m->message.page == 0) f.world.push_back(m->message.header.publish_time_ns);
      while (auto m = skins.pop()) {
        f.thermal_force[phase_ms(m->message.header)].push_back(m->message.force_N);
        f.setpoints[phase_ms(m->message.header) / 20].push_back(m->message.commanded_degC);
      }
    }
    for (const char* sense : {"audio", "visual", "thermal"})
      if (const auto waits = delays_ms(monitor, sense, before); !waits.empty()) f.wait_ms[sense] = median(waits);
    return f;
  }
};

// Mean difference of the forces over a period, N.
double force_difference_N(const Measurement& clean, const Measurement& f) {
  double sum = 0;
  int n = 0;
  for (std::size_t ms = 0; ms < kPeriod_ms; ++ms)
    if (!clean.force[ms].empty() && !f.force[ms].empty()) {
      sum += std::abs(median(clean.force[ms]) - median(f.force[ms]));
      ++n;
    }
  REQUIRE(n > 400);
  return sum / n;
}

// Lag of the force in the input of warmth behind the force on the hand, ms: the shift of best agreement.
double lag_ms(const Measurement& f) {
  double best = -1;
  std::size_t best_shift = 0;
  for (std::size_t shift = 0; shift < kPeriod_ms; shift += 10) {
    double sum = 0;
    for (std::size_t ms = 0; ms < kPeriod_ms; ++ms)
      for (const double w : f.thermal_force[(ms + shift) % kPeriod_ms])
        if (!f.force[ms].empty()) sum += w * median(f.force[ms]);
    if (sum > best) best = sum, best_shift = shift;
  }
  return static_cast<double>(best_shift);
}

// Checks the rates in the best of three spans, as RunningCluster::check_rates_hold. Vision may become faster when other work on the machine ends.
void check_not_slower(DegradedCluster& c, std::map<std::string, double> left) {
  std::map<std::string, double> now;
  for (int span = 0; span < 3 && !left.empty(); ++span) {
    now = c.rates(1);
    std::erase_if(left, [&](const auto& b) { return now[b.first] > b.second / rate_factor(b.first); });
  }
  for (const auto& [node, rate] : left)
    FAIL_CHECK(node << ": " << rate << " Hz before, " << now[node] << " Hz in the last of three spans");
}

// Checks the rates of the servo loop and of the simulation, and the time of the other modalities from the earliest possible instant to the
// output. The medians have wide bounds, because other work comes and goes.
void check_other_modalities(DegradedCluster& c, const std::map<std::string, double>& rates, const Measurement& clean, const Measurement& f,
                  const std::string& degraded) {
  check_not_slower(c, rates);
  CHECK(quantile(steps_ms(f.ticks), 0.5) == Approx(1).margin(0.05));
  CHECK(quantile(steps_ms(f.world), 0.5) == Approx(1).margin(0.05));
  CHECK(quantile(steps_ms(f.ticks), 0.9) < 1.5 * std::max(1.0, quantile(steps_ms(clean.ticks), 0.9)));
  CHECK(quantile(steps_ms(f.world), 0.9) < 1.5 * std::max(1.0, quantile(steps_ms(clean.world), 0.9)));
  for (const auto& [sense, wait] : clean.wait_ms) {
    if (sense == degraded) continue;
    INFO(sense);
    REQUIRE(f.wait_ms.contains(sense));
    // Vision has no real-time priority and may vary by a few frames beside other work.
    const double tolerance_ms = sense == "visual" ? 60 : 20;
    CHECK(f.wait_ms.at(sense) == Approx(wait).margin(tolerance_ms));
  }
}

}  // namespace

TEST_CASE("DEGRADE-5: touch is delayed, decimated, lost, frozen, off or coarse, and only the hand is affected") {
  DegradedCluster c;
  c.start();
  // Each modality runs by itself: aligned ones wait for the slowest, which is vision, whose time varies beside other work.
  request_playout(c, {"asap"});
  c.measure(2);  // delays of presentation settle
  Measurement clean = c.measure(5), again = c.measure(5);
  // A pause of the machine shifts a tap in one of the spans: measures until two spans are alike.
  for (int span = 2; span < 5 && force_difference_N(clean, again) > 0.002 * clean.peak_N(); ++span)
    clean = std::move(again), again = c.measure(5);
  const auto rates = c.rates(2);
  const double peak_N = clean.peak_N(), noise_N = force_difference_N(clean, again);
  REQUIRE(peak_N > 1);
  REQUIRE(noise_N < 0.01 * peak_N);
  // The same taps differ by a few mN, beside heavy load by about 20 mN.
  const double effect_N = std::max(1.5 * noise_N, 0.004 * peak_N);
  for (const std::string rule : {"delay=\"40ms\"", "rate=\"3Hz\"", "loss=\"98% burst=400\"", "freeze=\"zero\"",
                                 "off=\"true\"", "force_step=\"1N\""}) {
    put_in_force(c, "<degrade modality=\"haptic\" " + rule + "/>");
    c.measure(1);
    const Measurement f = c.measure(4);
    INFO(rule << ": force off by " << force_difference_N(clean, f) << " N in the mean, peak " << f.peak_N() << " N of "
              << peak_N << " N; two clean spans differ by " << noise_N << " N; " << f.held_forces_cN.size()
              << " forces held");
    CHECK(force_difference_N(clean, f) > effect_N);
    if (rule == "off=\"true\"" || rule == "freeze=\"zero\"") CHECK(f.peak_N() == 0);
    if (rule == "force_step=\"1N\"") {
      CHECK(!f.held_forces_cN.empty());
      for (const int cN : f.held_forces_cN) CHECK(cN % 100 == 0);
    }
    check_other_modalities(c, rates, clean, f, "haptic");
  }
  put_in_force(c, "");
  c.measure(1);
  CHECK(force_difference_N(clean, c.measure(4)) < 0.05 * peak_N);
}

TEST_CASE("DEGRADE-6: warmth is delayed, slow or off, and touch on the same hand is not affected") {
  DegradedCluster c;
  c.start();
  // Each modality runs by itself: aligned ones wait for the slowest, which is vision, whose time varies beside other work.
  request_playout(c, {"asap"});
  c.measure(2);
  const Measurement clean = c.measure(4);
  const auto rates = c.rates(2);
  REQUIRE(clean.peak_N() > 1);
  const double lag = lag_ms(clean);
  for (const std::string rule : {"delay=\"150ms\"", "response=\"1s\"", "off=\"true\""}) {
    put_in_force(c, "<degrade modality=\"thermal\" " + rule + "/>");
    c.measure(2);
    const Measurement f = c.measure(4);
    INFO(rule << ": warmth follows force by " << lag_ms(f) << " ms, clean by " << lag << " ms; the display goes "
              << ripple_K(f) << " K up and down, clean " << ripple_K(clean) << " K");
    if (rule.starts_with("delay"))
      CHECK(std::remainder(lag_ms(f) - lag - 150, kPeriod_ms) == Approx(0).margin(40));
    // A lag of 1 s leaves 1 / sqrt(1 + (2 pi 2 Hz 1 s)^2), a thirteenth, of a variation at 2 Hz.
    if (rule.starts_with("response")) CHECK(ripple_K(f) < 0.4 * ripple_K(clean));
    double max_thermal_force_N = 0;
    for (const auto& by : f.thermal_force)
      for (const double N : by) max_thermal_force_N = std::max(max_thermal_force_N, N);
    CHECK((max_thermal_force_N == 0) == (rule == "off=\"true\""));
    check_other_modalities(c, rates, clean, f, "thermal");
    CHECK(force_difference_N(clean, f) < 0.05 * clean.peak_N());
  }
  put_in_force(c, "");
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
