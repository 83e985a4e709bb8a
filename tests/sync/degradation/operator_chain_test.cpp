// Tests of the operators of a profile, one by one and combined.
#include "sync/degradation/operator_chain.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::sync;

namespace {

SimTime at(double s) { return sim_time(std::llround(s * 1e9)); }
HostTime host(double s) { return host_time(std::llround(s * 1e9)); }

OperatorChain stack_of(const std::string& attributes, std::uint64_t seed = 1) {
  return OperatorChain(parse_profile("<profile seed=\"" + std::to_string(seed) + "\"><degrade modality=\"audio\" " +
                                 attributes + "/></profile>",
                             "p.xml"),
               "audio", SimTime{});
}

StreamItem event(std::uint64_t key, double t) {
  return {.key = key, .is_event = true, .time = at(t), .arrival = host(t + 0.001), .signals = {}};
}
StreamItem snapshot(double t) {
  return {.key = static_cast<std::uint64_t>(std::llround(t * 1e9)),
          .time = at(t),
          .arrival = host(t + 0.001),
          .signals = {}};
}
double held_s(const Decision& v, const StreamItem& i) { return to_seconds(v.release - i.arrival); }

}  // namespace

TEST_CASE("A rule for another modality changes nothing") {
  const Profile p = parse_profile("<profile><degrade modality=\"visual\" off=\"true\"/></profile>", "p.xml");
  OperatorChain stack(p, "audio", {});
  CHECK(stack.empty());
  const StreamItem i = event(1, 0);
  const Decision v = stack.decide(i);
  CHECK_FALSE(v.dropped());
  CHECK_FALSE(v.evaluated);
  CHECK(v.release == i.arrival);
}

TEST_CASE("A network delay holds messages, a presentation delay shifts the whole modality") {
  OperatorChain network = stack_of("delay=\"40ms network\"");
  const StreamItem i = snapshot(1);
  CHECK(held_s(network.decide(i), i) == Approx(0.040));
  CHECK(network.presentation_delay(at(1)).count() == 0);
  OperatorChain presentation = stack_of("delay=\"40ms\"");
  CHECK(held_s(presentation.decide(i), i) == 0);
  CHECK(presentation.presentation_delay(at(1)) == std::chrono::milliseconds(40));
}

TEST_CASE("The delay by skew grows with time") {
  OperatorChain stack = stack_of("skew=\"1000ppm\" from=\"2s\"");
  CHECK(stack.presentation_delay(at(1)).count() == 0);
  CHECK(to_seconds(stack.presentation_delay(at(12))) == Approx(0.010));
}

TEST_CASE("A rate keeps one snapshot per period at its phase and delays events to the next one") {
  OperatorChain stack = stack_of("rate=\"5Hz phase=50ms\"");
  std::vector<double> kept;
  for (int ms = 0; ms < 2000; ++ms)
    if (!stack.decide(snapshot(ms / 1000.0)).dropped()) kept.push_back(ms / 1000.0);
  REQUIRE(kept.size() == 11);
  for (std::size_t i = 1; i < kept.size(); ++i)
    CHECK(kept[i] == Approx(0.05 + 0.2 * static_cast<double>(i - 1)).margin(0.0011));
  const StreamItem e = event(1, 0.1);
  CHECK(held_s(stack.decide(e), e) == Approx(0.150));
  const StreamItem exact = event(2, 0.25);
  CHECK(held_s(stack.decide(exact), exact) == Approx(0).margin(1e-9));
}

TEST_CASE("Off and freeze drop all messages within their time range") {
  for (const std::string op : {"off=\"true\"", "freeze=\"hold\""}) {
    OperatorChain stack = stack_of(op + " from=\"1s\" until=\"2s\"");
    CHECK_FALSE(stack.decide(event(1, 0.999)).dropped());
    CHECK(stack.decide(event(2, 1.0)).dropped());
    CHECK(stack.decide(snapshot(1.999)).dropped());
    CHECK_FALSE(stack.decide(snapshot(2.0)).dropped());
  }
}

TEST_CASE("The same seed gives the same decisions for any order of arrival") {
  constexpr int kN = 2000;
  const std::string ops = "loss=\"20%\" delay=\"15ms network\" jitter=\"5ms normal order=free\" duplicate=\"10%\" reorder=\"10% by=7ms\"";
  std::vector<StreamItem> items;
  for (int i = 0; i < kN; ++i) items.push_back(event(static_cast<std::uint64_t>(i + 1), i * 0.001));
  const auto decide_all = [&](const std::vector<StreamItem>& order, bool company, std::uint64_t seed) {
    OperatorChain stack = stack_of(ops, seed);
    std::map<std::uint64_t, Decision> verdicts;
    for (const StreamItem& i : order) {
      if (company) stack.decide(snapshot(to_seconds(i.time - SimTime{})));
      verdicts[i.key] = stack.decide(i);
    }
    return verdicts;
  };
  auto shuffled = items;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  const auto a = decide_all(items, false, 9), b = decide_all(shuffled, true, 9), c = decide_all(items, false, 10);
  int differ = 0, lost = 0;
  for (const auto& [key, v] : a) {
    CHECK(v.why == b.at(key).why);
    CHECK(v.release == b.at(key).release);
    CHECK(v.duplicated == b.at(key).duplicated);
    differ += v.why != c.at(key).why;
    lost += v.dropped();
  }
  CHECK(std::abs(lost - 0.2 * kN) < 5 * std::sqrt(0.16 * kN));
  CHECK(differ > 0.2 * kN);  // 2 * 0.2 * 0.8 for two independent seeds
}

TEST_CASE("Two rules or two modalities draw independent random numbers") {
  const Profile p = parse_profile(
      R"(<profile><degrade modality="a" loss="50%"/><degrade modality="b" loss="50%"/></profile>)", "p");
  OperatorChain a(p, "a", {}), b(p, "b", {});
  int same = 0;
  for (std::uint64_t k = 0; k < 1000; ++k)
    same += a.decide(event(k, 0)).dropped() == b.decide(event(k, 0)).dropped();
  CHECK(std::abs(same - 500) < 5 * std::sqrt(250));
}

TEST_CASE("A jitter delays each item by itself and never before its arrival, and the order is kept by dropping") {
  OperatorChain kept = stack_of("delay=\"20ms network\" jitter=\"20ms uniform\"");
  OperatorChain unordered = stack_of("delay=\"20ms network\" jitter=\"20ms uniform order=free\"");
  for (int i = 0; i < 1000; ++i) {
    const StreamItem item = snapshot(i * 0.001);
    const Decision v = kept.decide(item), other = unordered.decide(item);
    CHECK(v.release == other.release);
    CHECK(v.newest_wins());
    CHECK_FALSE(other.newest_wins());
    CHECK(v.release >= item.arrival);
  }
  OperatorChain free = stack_of("reorder=\"20% by=10ms\"");
  int overtaken = 0;
  HostTime last{};
  for (int i = 0; i < 1000; ++i) {
    const Decision v = free.decide(snapshot(i * 0.001));
    overtaken += v.release < last;
    last = std::max(last, v.release);
  }
  CHECK(overtaken > 500);
}

TEST_CASE("A rule with a filter applies only to its pair of bodies or its material") {
  OperatorChain stack = stack_of("off=\"true\" material=\"steel\"");
  stack.set_scene({{"floor", "ball", "cup"}, {"oak", "steel"}});
  StreamItem e = event(1, 0);
  e.material_a = 0, e.material_b = 1;
  CHECK(stack.decide(e).dropped());
  e.material_b = 0;
  CHECK_FALSE(stack.decide(e).dropped());
  CHECK_FALSE(stack.decide(snapshot(0)).dropped());

  OperatorChain pair = stack_of("delay=\"30ms\" bodies=\"ball floor\"");
  pair.set_scene({{"floor", "ball", "cup"}, {}});
  e.body_a = 0, e.body_b = 1;
  CHECK(pair.decide(e).shift == std::chrono::milliseconds(30));
  e.body_b = 2;
  CHECK(pair.decide(e).shift.count() == 0);
  CHECK(pair.presentation_delay(at(0)).count() == 0);
}

TEST_CASE("Rules of one modality apply one after the other") {
  const Profile p = parse_profile(R"(<profile>
    <degrade modality="audio" delay="10ms network"/><degrade modality="audio" delay="20ms network" gain="2"/>
    <degrade modality="audio" quantise="1N"/></profile>)",
                                  "p.xml");
  OperatorChain stack(p, "audio", {});
  const StreamItem i = event(1, 0);
  CHECK(held_s(stack.decide(i), i) == Approx(0.030));
  CHECK(stack.degraded_value(Quantity::kForce, 1, 0, 0.8, at(0), -1, -1, -1, -1) == Approx(2));  // 1.6, rounded
  CHECK(stack.degraded_value(Quantity::kVelocity, 1, 0, 0.8, at(0), -1, -1, -1, -1) == 0.8);
}

TEST_CASE("Within a rule values are quantised first, then scaled") {
  OperatorChain stack = stack_of("quantise=\"1N\" gain=\"0.5\"");
  CHECK(stack.degraded_value(Quantity::kForce, 1, 0, 2.8, at(0), -1, -1, -1, -1) == Approx(1.5));
}

TEST_CASE("Loss on the wire is independent for each message") {
  OperatorChain stack = stack_of("wire_loss=\"30%\"");
  int lost = 0;
  for (std::uint64_t m = 0; m < 10'000; ++m) lost += stack.lost_on_wire(m, at(0));
  CHECK(std::abs(lost - 3000) < 5 * std::sqrt(2100));
}
