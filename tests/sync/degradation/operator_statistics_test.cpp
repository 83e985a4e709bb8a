// The asked numbers of every operator against the measured ones, as a node measures them: at 60 Hz and 1 kHz, ordered and
// unordered, for events and snapshots. A count of outcomes of probability p is binomial; 4.5 standard deviations are exceeded
// once in 150,000.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <vector>

#include "sync/degradation/degraded_snapshots.h"
#include "sync/degradation/measured_effect.h"
#include "sync/resampling/event_inbox.h"
#include "tests/sync/degradation/share_check.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

Profile profile_of(const std::string& attributes) {
  return parse_profile("<profile seed=\"11\"><degrade modality=\"a\" " + attributes + "/></profile>", "p.xml");
}

// Delays of all decided items, before any is overtaken.
struct Decided {
  std::vector<double> delays_s;
  double mean() const {
    double sum = 0;
    for (const double x : delays_s) sum += x / static_cast<double>(delays_s.size());
    return sum;
  }
  double sd() const {
    const double m = mean();
    double sum = 0;
    for (const double x : delays_s) sum += (x - m) * (x - m) / static_cast<double>(delays_s.size());
    return std::sqrt(sum);
  }
};

struct Measured {
  MeasuredEffect effect;
  Decided events, snapshots;
  std::vector<std::int64_t> released_ns;  // simulated times of the snapshots, in the order of their release
};

header_t stamped_header(std::int64_t t_ns, std::int64_t seq) {
  header_t h{};
  h.run_id = h.incarnation = 1;
  h.sim_time_ns = h.publish_time_ns = t_ns;
  h.seq = seq;
  return h;
}

// kN events and kN snapshots at this rate. A tick comes every quarter of a period, and at least every half millisecond.
Measured measured(const std::string& attributes, double rate_Hz) {
  OperatorChain chain(profile_of(attributes), "a", SimTime{});
  DegradedSnapshots<contact_frame_t> frames;
  EventInbox inbox(1);
  Decisions decisions;
  Measured out;
  const auto period_ns = static_cast<std::int64_t>(1e9 / rate_Hz);
  const auto tick_ns = std::min<std::int64_t>(period_ns / 4, 500'000);
  std::int64_t next_tick_ns = 0;
  const auto tick_until = [&](std::int64_t t_ns) {
    for (; next_tick_ns <= t_ns; next_tick_ns += tick_ns)
      while (const auto m = frames.pop(host_time(next_tick_ns))) out.released_ns.push_back(m->first.header.sim_time_ns);
  };
  for (int i = 0; i < kN; ++i) {
    const std::int64_t t_ns = i * period_ns;
    tick_until(t_ns - 1);
    contact_frame_t frame{};
    frame.header = stamped_header(t_ns, i);
    frame.clock = {t_ns, t_ns, 1};
    frame.pages = 1;
    frames.push(frame, host_time(t_ns), chain, &decisions);
    contact_events_t events{};
    events.header = stamped_header(t_ns, i);
    events.clock = frame.clock;
    events.pages = events.count = 1;
    events.events.resize(1);
    events.events[0].event_id = (0xabcdell << 40) + i;
    events.events[0].contact_id = i;
    events.events[0].time_ns = t_ns;
    inbox.push(events, host_time(t_ns), chain, &decisions);
    const Nanoseconds delay = chain.presentation_delay(sim_time(t_ns));
    for (const DecisionRecord& d : decisions) {
      out.effect.add(d, delay);
      if (!d.decision.dropped())
        (d.is_event ? out.events : out.snapshots).delays_s.push_back(to_seconds(d.decision.release - d.arrival + d.decision.shift + delay));
    }
    decisions.clear();
    inbox.take(SimTime::max());
  }
  tick_until(kN * period_ns + 2'000'000'000);
  out.effect.set_wire(chain.wire_messages(), chain.wire_lost());
  return out;
}

std::string text_of(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

}  // namespace

TEST_CASE("A jitter adds the asked mean and deviation to every event and snapshot, at any rate and in any order") {
  struct Shape {
    std::string words;
    double kurtosis;
  };
  const Shape shape = GENERATE(values<Shape>({{"3ms normal", 3}, {"8ms uniform", 1.8}, {"trace=1ms,2ms,6ms", 1.5}}));
  const std::string delay = GENERATE("delay=\"9ms\"", "delay=\"9ms network\"");
  const std::string order = GENERATE("", " order=free");
  const double rate_Hz = GENERATE(60.0, 1000.0);
  const std::string attributes = delay + " jitter=\"" + shape.words + order + "\"";
  INFO(attributes << " at " << rate_Hz << " Hz");
  const DelayMoments jitter = moments(*profile_of(attributes).rules[0].jitter, 0.009);
  const Measured m = measured(attributes, rate_Hz);
  // Standard error of a deviation: sd sqrt((kurtosis - 1) / 4 n).
  const double mean_error = kSigmas * jitter.sd_s / std::sqrt(kN), sd_error = kSigmas * jitter.sd_s * std::sqrt((shape.kurtosis - 1) / (4 * kN));
  for (const Decided* d : {&m.events, &m.snapshots}) {
    REQUIRE(d->delays_s.size() == kN);
    CHECK(std::abs(d->mean() - 0.009 - jitter.mean_s) <= mean_error);
    CHECK(std::abs(d->sd() - jitter.sd_s) <= sd_error);
  }
  const EffectFigures events = m.effect.events(), state = m.effect.snapshots();
  CHECK(events.mean_delay_s == Approx(m.events.mean()));
  CHECK(events.sd_delay_s == Approx(m.events.sd()));
  CHECK(events.delivered == kN);
  CHECK(state.delivered + state.overtaken == kN);
  // Snapshots that are overtaken after the last push are not reported.
  CHECK(std::abs(state.delivered - static_cast<std::int64_t>(m.released_ns.size())) <= 20);
  if (!order.empty()) {
    CHECK(state.overtaken == 0);
    CHECK(state.mean_delay_s == Approx(m.snapshots.mean()));
  } else if (rate_Hz == 60) {
    // Consecutive delays differ by less than the period of 16.7 ms, but in a few of 100,000 pairs of normal ones.
    CHECK(state.overtaken <= 5);
    CHECK(state.mean_delay_s == Approx(m.snapshots.mean()).epsilon(1e-3));
  } else {
    // Only the newest snapshots remain, and these are the early ones.
    CHECK(state.overtaken > kN / 4);
    CHECK(state.mean_delay_s < m.snapshots.mean());
  }
}

TEST_CASE("Snapshots leave in the order of their arrival, except with a free order") {
  const std::string delay = GENERATE("delay=\"9ms\"", "delay=\"9ms network\"");
  const double rate_Hz = GENERATE(60.0, 1000.0);
  const Measured kept = measured(delay + " jitter=\"3ms normal\"", rate_Hz), free = measured(delay + " jitter=\"3ms normal order=free\"", rate_Hz);
  CHECK(std::is_sorted(kept.released_ns.begin(), kept.released_ns.end()));
  CHECK(free.released_ns.size() == kN);
  // Shifted instants are in order, too: the presentation itself is shifted. Messages of a network are not.
  if (rate_Hz == 1000 && delay.find("network") != std::string::npos)
    CHECK_FALSE(std::is_sorted(free.released_ns.begin(), free.released_ns.end()));
}

TEST_CASE("A Pareto jitter needs no delay and adds the asked mean") {
  const double rate_Hz = GENERATE(60.0, 1000.0);
  const Measured m = measured("jitter=\"4ms pareto order=free\"", rate_Hz);
  const double error = kSigmas * moments({JitterShape::kPareto, 0.004}, 1).sd_s / std::sqrt(kN);
  CHECK(std::abs(m.effect.events().mean_delay_s - 0.004) <= error);
  CHECK(std::abs(m.effect.snapshots().mean_delay_s - 0.004) <= error);
}

TEST_CASE("A constant delay has the asked mean and no deviation") {
  const std::string delay = GENERATE("delay=\"40ms\"", "delay=\"40ms network\"");
  const Measured m = measured(delay, GENERATE(60.0, 1000.0));
  for (const EffectFigures& f : {m.effect.events(), m.effect.snapshots()}) {
    CHECK(f.mean_delay_s == Approx(0.040));
    CHECK(f.sd_delay_s == Approx(0).margin(1e-9));
    CHECK(f.delivered == kN);
  }
}

TEST_CASE("A loss has the asked share and the asked mean burst") {
  const double share = GENERATE(0.05, 0.3), burst = GENERATE(0.0, 3.0), rate_Hz = GENERATE(60.0, 1000.0);
  const Measured m = measured("loss=\"" + text_of(share) + (burst > 0 ? " burst=" + text_of(burst) : "") + "\"", rate_Hz);
  const double b = burst > 0 ? burst : 1 / (1 - share);
  // As in operator_distribution_test.cpp: a two-state chain enlarges the variance by (1 + r) / (1 - r).
  const double r = burst > 0 ? 1 - share / (burst * (1 - share)) - 1 / burst : 0;
  for (const EffectFigures& f : {m.effect.events(), m.effect.snapshots()}) {
    CHECK(f.items == kN);
    CHECK(f.lost + f.delivered == kN);
    CHECK(std::abs(static_cast<double>(f.lost) - share * kN) <= kSigmas * std::sqrt(share * (1 - share) * kN * (1 + r) / (1 - r)));
    CHECK(std::abs(f.mean_burst() - b) <= kSigmas * std::sqrt(b * (b - 1) / static_cast<double>(f.bursts)));
  }
}

TEST_CASE("A rate has the asked number of snapshots a second, or that of a slower stream") {
  const double asked_Hz = GENERATE(5.0, 25.0, 33.3, 400.0), rate_Hz = GENERATE(60.0, 1000.0);
  INFO(asked_Hz << " of " << rate_Hz << " Hz");
  const Measured m = measured("rate=\"" + text_of(asked_Hz) + "Hz\"", rate_Hz);
  // The period is rounded to nanoseconds, and at most one snapshot more than asked fits into the run.
  const double expected_Hz = std::min(asked_Hz, rate_Hz);
  CHECK(m.effect.snapshots().rate_Hz == Approx(expected_Hz).margin(2 * rate_Hz / kN));
  // Events wait for the next slot: between 0 and a period.
  CHECK(m.effect.events().delivered == kN);
  CHECK(m.effect.events().mean_delay_s <= 1 / asked_Hz);
}

TEST_CASE("Reorder and duplicate have the asked shares") {
  const double rate_Hz = GENERATE(60.0, 1000.0);
  const Measured m = measured("reorder=\"5% by=30ms\" duplicate=\"3%\"", rate_Hz);
  for (const EffectFigures& f : {m.effect.events(), m.effect.snapshots()}) {
    check_share(static_cast<double>(f.repeated), 0.03);
    CHECK(std::abs(f.mean_delay_s - 0.05 * 0.030) <= kSigmas * 0.030 * std::sqrt(0.05 * 0.95 / kN));
    CHECK(f.overtaken == 0);
  }
  CHECK(m.released_ns.size() == static_cast<std::size_t>(kN + m.effect.snapshots().repeated));
  CHECK_FALSE(std::is_sorted(m.released_ns.begin(), m.released_ns.end()));
}

TEST_CASE("Off and freeze deliver nothing, and the effect says so") {
  const std::string attributes = GENERATE("off=\"true\"", "freeze=\"hold\"");
  const Measured m = measured(attributes, 60);
  CHECK(m.effect.events().delivered == 0);
  CHECK(m.effect.snapshots().off == kN);
  CHECK_THAT(m.effect.text(), Catch::Contains("events none delivered; state none delivered"));
}

TEST_CASE("A deadband of a constant pattern keeps a constant rate") {
  // Snapshots without contacts never change: only the first one passes.
  const Measured m = measured("deadband=\"10% force\"", GENERATE(60.0, 1000.0));
  CHECK(m.effect.snapshots().delivered == 1);
  CHECK(m.effect.snapshots().thinned == kN - 1);
}

TEST_CASE("A loss on the wire is measured in messages") {
  const Measured m = measured("wire_loss=\"20%\"", 1000);
  CHECK(m.effect.text().find("of the messages lost on the wire") != std::string::npos);
  check_share(static_cast<double>(m.released_ns.size()), 0.8);
}
