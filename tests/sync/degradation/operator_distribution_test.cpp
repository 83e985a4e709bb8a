// Distributions of every random operator, applied as in a modality: through a profile, to events and snapshots. A count of outcomes of
// probability p is binomial; 4.5 standard deviations are exceeded once in 150,000.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>

#include "sync/resampling/contact_stream.h"
#include "sync/resampling/event_inbox.h"
#include "sync/random/keyed_random.h"
#include "sync/degradation/degraded_snapshots.h"
#include "sync/bus/identity.h"
#include "tests/sync/degradation/share_check.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

OperatorChain seeded_chain(const std::string& attributes, int seed = 1) {
  return OperatorChain(parse_profile("<profile seed=\"" + std::to_string(seed) + "\"><degrade modality=\"a\" " +
                                 attributes + "/></profile>",
                             "p"),
               "a", SimTime{});
}

// The i-th item of a millisecond clock: an event with an id as sim_node assigns it, or a snapshot.
StreamItem item(int i, bool is_event) {
  const std::uint64_t key =
      is_event ? (0xabcdefull << 40) + static_cast<std::uint64_t>(i) : mixed(7, static_cast<std::uint64_t>(i));
  return {.key = key,
          .is_event = is_event,
          .time = sim_time(i * 1'000'000ll),
          .arrival = host_time(i * 1'000'000ll + 300'000),
          .signals = {}};
}

std::vector<Decision> verdicts(const std::string& attributes, bool is_event, int seed = 1, int n = kN) {
  OperatorChain stack = seeded_chain(attributes, seed);
  std::vector<Decision> out;
  for (int i = 0; i < n; ++i) out.push_back(stack.decide(item(i, is_event)));
  return out;
}

std::vector<double> held_s(const std::vector<Decision>& all, bool is_event) {
  std::vector<double> out;
  for (int i = 0; i < static_cast<int>(all.size()); ++i)
    out.push_back(to_seconds(all[static_cast<std::size_t>(i)].release - item(i, is_event).arrival));
  return out;
}

std::uint64_t fingerprint(const std::vector<Decision>& all) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const Decision& v : all)
    for (const std::int64_t word :
         {std::int64_t{static_cast<std::int8_t>(v.why)}, to_ns(v.release), v.shift.count(), std::int64_t{v.duplicated}})
      hash = fnv1a_64(hash, &word, sizeof word);
  return hash;
}

}  // namespace

TEST_CASE("The quantiles of a jittered delay match its distribution for events and snapshots") {
  struct Shape {
    std::string words;
    std::function<double(double)> quantile_s;  // quantile function of the added delay
  };
  const Shape shape = GENERATE(
      values<Shape>({{"8ms uniform", [](double p) { return 0.008 * (2 * p - 1); }},
                     {"3ms normal", [](double p) { return 0.003 * normal_quantile(p); }},
                     // Lomax with index 2.5 and mean 4 ms.
                     {"4ms pareto", [](double p) { return 0.004 * 1.5 * (std::pow(1 - p, -1 / 2.5) - 1); }}}));
  const bool is_event = GENERATE(true, false);
  INFO(shape.words << (is_event ? ", events" : ", snapshots"));
  // The constant delay is six standard deviations, so that no delay is cut off at 0.
  const auto held =
      held_s(verdicts("delay=\"20ms network\" jitter=\"" + shape.words + " order=free\"", is_event), is_event);
  for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
    INFO(p);
    const double edge = 0.020 + shape.quantile_s(p);
    check_share(static_cast<double>(std::count_if(held.begin(), held.end(), [&](double h) { return h <= edge; })),
                p);
  }
}

TEST_CASE("A constant delay is exact to 1 ns, and a jitter keeps its mean where it is cut off") {
  for (const double h : held_s(verdicts("delay=\"40ms network\"", true), true)) REQUIRE(h == 0.040);
  const auto held = held_s(verdicts("delay=\"15ms network\" jitter=\"5ms normal order=free\"", true), true);
  CHECK(*std::min_element(held.begin(), held.end()) == 0);
  CHECK(*std::max_element(held.begin(), held.end()) == Approx(0.030));
  // Three standard deviations on both sides.
  check_share(static_cast<double>(std::count(held.begin(), held.end(), 0.0)), normal_cdf(-3));
  check_share(static_cast<double>(std::count_if(held.begin(), held.end(), [](double h) { return h >= 0.030; })), normal_cdf(-3));
}

TEST_CASE("Jitter has the specified autocorrelation") {
  const double rho = GENERATE(0.0, 0.5, 0.9);
  std::ostringstream words;
  words << "delay=\"30ms network\" jitter=\"3ms normal order=free correlation=" << rho << "\"";
  const auto x = held_s(verdicts(words.str(), true), true);
  double square = 0, product = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    square += (x[i] - 0.030) * (x[i] - 0.030);
    product += (x[i] - 0.030) * (x[i - 1] - 0.030);
  }
  // Standard error for a first-order process: sqrt((1 - rho^2) / n) (Bartlett 1946).
  CHECK(std::abs(product / square - rho) < kSigmas * std::sqrt((1 - rho * rho) / kN));
}

TEST_CASE("A kept order changes no delay of a jitter") {
  const std::string jitter = "jitter=\"20ms pareto";
  const bool is_event = GENERATE(true, false);
  CHECK(fingerprint(verdicts(jitter + " order=free\"", is_event)) == fingerprint(verdicts(jitter + "\"", is_event)));
}

TEST_CASE("Independent and bursty loss have the specified share and mean burst for events and snapshots") {
  const bool is_event = GENERATE(true, false);
  const double burst = GENERATE(0.0, 4.0, 20.0), share = GENERATE(0.01, 0.05, 0.4);
  std::ostringstream words;
  words << "loss=\"" << share;
  if (burst > 0) words << " burst=" << burst;
  const int n = 10 * kN;
  const auto all = verdicts(words.str() + "\"", is_event, 3, n);
  int lost = 0, bursts = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    lost += all[i].dropped();
    bursts += all[i].dropped() && (i == 0 || !all[i - 1].dropped());
  }
  INFO(words.str() << " lost " << lost << " in " << bursts);
  // Run lengths are geometric with mean b and variance b (b - 1); for independent losses b = 1 / (1 - share).
  const double b = burst > 0 ? burst : 1 / (1 - share);
  CHECK(std::abs(static_cast<double>(lost) / bursts - b) <= kSigmas * std::sqrt(b * (b - 1) / bursts));
  // A two-state chain enlarges the variance by (1 + r) / (1 - r), where r is its second eigenvalue.
  const double r = burst > 0 ? 1 - share / (burst * (1 - share)) - 1 / burst : 0;
  CHECK(std::abs(lost - share * n) <= kSigmas * std::sqrt(share * (1 - share) * n * (1 + r) / (1 - r)));
}

TEST_CASE("Reordering delays its share by the given time, and duplication doubles its share") {
  const auto all = verdicts("reorder=\"5% by=10ms\" duplicate=\"3%\"", true);
  const auto held = held_s(all, true);
  check_share(static_cast<double>(std::count(held.begin(), held.end(), 0.010)), 0.05);
  CHECK(std::count(held.begin(), held.end(), 0.010) + std::count(held.begin(), held.end(), 0.0) == kN);
  check_share(static_cast<double>(std::count_if(all.begin(), all.end(), [](const Decision& v) { return v.duplicated; })),
              0.03);
}

TEST_CASE("One seed gives identical decisions, another seed gives others") {
  const std::string everything =
      "loss=\"5% burst=3\" delay=\"20ms network\" jitter=\"3ms pareto correlation=0.5\" reorder=\"5% by=10ms\" "
      "duplicate=\"1%\"";
  for (const bool is_event : {true, false}) {
    CHECK(fingerprint(verdicts(everything, is_event, 7)) == fingerprint(verdicts(everything, is_event, 7)));
    CHECK(fingerprint(verdicts(everything, is_event, 7)) != fingerprint(verdicts(everything, is_event, 8)));
  }
  // Profiles without logarithms and powers, which differ between C libraries, give the same result on every machine.
  CHECK(fingerprint(verdicts("loss=\"20%\" reorder=\"10% by=10ms\" duplicate=\"5%\"", true, 7)) ==
        0xeb7f74d09e8e226eull);
}

TEST_CASE("Repeated messages do not change any decision") {
  const std::string everything =
      "loss=\"20% burst=3\" delay=\"9ms network\" jitter=\"3ms normal correlation=0.5 order=free\" "
      "duplicate=\"10%\"";
  const auto decided = [&](int repetitions) {
    OperatorChain stack = seeded_chain(everything, 5);
    EventInbox events(1);
    Decisions decisions;
    for (int ms = 0; ms < 4000; ++ms) {
      contact_events_t m{};
      m.header.incarnation = 1, m.header.seq = ms;
      m.header.sim_time_ns = m.header.publish_time_ns = ms * 1'000'000ll;
      for (int i = std::max(0, ms - repetitions + 1); i <= ms; ++i) {
        contact_event_t e{};
        e.event_id = 1000 + i;
        e.time_ns = i * 1'000'000ll;
        m.events.push_back(e);
      }
      m.count = static_cast<std::int32_t>(m.events.size());
      events.push(m, host_time(ms * 1'000'000ll), stack, &decisions);
    }
    std::vector<Decision> all;
    for (const DecisionRecord& d : decisions) all.push_back(d.decision);
    return all;
  };
  const auto once = decided(1), often = decided(50);
  REQUIRE(once.size() == 4000);
  CHECK(often.size() == 4000);
  CHECK(fingerprint(once) == fingerprint(often));
}

TEST_CASE("A contact frozen with hold becomes stale, a contact frozen to zero ends at once") {
  const bool zero = GENERATE(true, false);
  OperatorChain stack = seeded_chain(std::string("freeze=\"") + (zero ? "zero" : "hold") + "\" from=\"100ms\"");
  DegradedSnapshots<contact_frame_t> frames;
  ContactStream stream(1);
  for (int ms = 0; ms < 200; ++ms) {
    contact_frame_t m{};
    m.header.run_id = m.header.incarnation = 1;
    m.header.sim_time_ns = m.header.publish_time_ns = ms * 1'000'000ll;
    m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
    m.pages = m.count = 1;
    m.contacts.resize(1);
    m.contacts[0].contact_id = 5;
    m.contacts[0].normal_force_N = static_cast<float>(ms);
    frames.push(m, host_time(m.header.publish_time_ns), stack, nullptr);
    while (const auto let = frames.pop(host_time(m.header.publish_time_ns))) stream.push(let->first, let->second);
    const auto state = stream.state_at(sim_time(m.header.sim_time_ns));
    INFO(ms << " ms");
    CHECK(state.value.size() == (zero && ms >= 100 ? 0 : 1));
    if (!zero && ms >= 100) {
      CHECK(state.value.at(0).normal_force_N == 99);
      CHECK(state.status == (ms <= 149 ? SampleStatus::kHeld : SampleStatus::kStale));
    }
  }
}
