// Properties of the matching over many random runs, against an oracle that has all delivered messages.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>

#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

struct Node {
  std::string name, modality;
  int expected_events;
};

// Counts one expected event.
void count(OutcomeCounts& t, bool reported, std::int8_t outcome) {
  ++t.expected;
  if (!reported)
    ++t.lost;
  else if (outcome == presentation_t::DROPPED_LATE)
    ++t.dropped_late;
  else if (outcome == presentation_t::DROPPED_BY_PROFILE)
    ++t.dropped_by_profile;
  else
    ++t.presented;
}
}  // namespace

TEST_CASE("Every expected event has one outcome when messages are lost, repeated and reordered") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    MatcherFixture f;
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::uniform_real_distribution<>(0, 1)(random) < p; };
    std::vector<Node> nodes = {{"haptic_node", "haptic", kBoth},
                               {"audio_node", "audio", kHit},
                               {"wall_1", "visual", kBoth},
                               {"wall_2", "visual", kBoth},
                               {"smell_node", "smell", node_health_t::EXPECTS_BEGIN}};

    // Every message with its time of arrival.
    struct Sent {
      double ms;
      std::function<void(HostTime)> deliver;
    };
    std::vector<Sent> sent;
    for (const Node& n : nodes)
      for (int ms = 0; ms <= 12000; ms += 100)
        f.health(n.name, n.modality, n.expected_events, ms);  // no loss: liveness is not under test here

    std::map<std::string, OutcomeCounts> expected;
    std::int64_t hits = 0, begins = 0;
    for (int id = 0; id < 200; ++id) {
      const double time = 1000 + 40 * id + std::uniform_real_distribution<>(0, 40)(random);
      const int kind = static_cast<int>(random() % 3);
      bool heard = false;
      for (int repeat = 0; repeat < 50; repeat += 5) {
        if (chance(0.5)) continue;
        heard = true;
        const double arrival = time + 1 + repeat + std::uniform_real_distribution<>(0, 30)(random);
        sent.push_back({arrival, [&f, id, time, kind](HostTime t) {
                          f.matcher.observe(f.event_message(id, time, kind, 100), t);
                        }});
      }
      if (heard) ++(kind == contact_event_t::HIT ? hits : begins), begins -= kind == contact_event_t::END;
      for (const Node& n : nodes) {
        const bool is_expected =
            kind == contact_event_t::BEGIN ? (n.expected_events & 1) != 0 : kind == contact_event_t::HIT && (n.expected_events & 2) != 0;
        const auto outcome = static_cast<std::int8_t>(random() % 5);
        const bool reports = chance(0.8);
        bool reported = false;
        for (int repeat = 0; reports && repeat < 2; ++repeat) {
          if (chance(0.3)) continue;
          const double arrival = time + 5 + 20 * repeat + std::uniform_real_distribution<>(0, 200)(random);
          reported = true;
          const int copies = 1 + static_cast<int>(random() % 2);
          for (int c = 0; c < copies; ++c)
            sent.push_back({arrival, [&f, n, id, time, outcome](HostTime t) {
                              f.matcher.observe(f.presented_message(n.name, n.modality, id, time + 5, outcome), t);
                            }});
        }
        if (!is_expected || !heard) continue;
        OutcomeCounts& t = expected[n.modality];
        count(t, reported, outcome);
      }
    }
    std::sort(sent.begin(), sent.end(), [](const Sent& a, const Sent& b) { return a.ms < b.ms; });
    for (const Sent& s : sent) {
      s.deliver(f.at(s.ms));
      f.matcher.advance(f.at(s.ms));
    }
    f.matcher.advance(f.at(12000));

    CHECK(f.matcher.hits() == hits);
    CHECK(f.matcher.begins() == begins);
    for (const auto& [modality, e] : expected) {
      const OutcomeCounts t = f.tally(modality);
      CAPTURE(seed, modality);
      CHECK(t.expected == e.expected);
      CHECK(t.presented == e.presented);
      CHECK(t.lost == e.lost);
      CHECK(t.dropped_by_profile == e.dropped_by_profile);
      CHECK(t.dropped_late == e.dropped_late);
      CHECK(sum(t) == t.expected);
    }
  }
}

TEST_CASE("The outcomes add up to the expected events when nodes die and stall, and no reported event is lost") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    MatcherFixture f;
    std::mt19937 random(seed);
    std::int64_t incarnation = 1, reported = 0, n = 0;
    bool up = true;
    for (int ms = 0; ms < 20000; ms += 10) {
      if (random() % 100 == 0) up = !up;
      if (random() % 400 == 0) ++incarnation;
      if (up && ms % 100 == 0)
        f.health("audio_node", "audio", kHit, ms, incarnation,
                 static_cast<std::int8_t>(random() % 20 == 0 ? random() % 5 : 1));
      if (random() % 4 == 0 && ms > 1000 && ms < 18000) {
        f.event(++n, ms);
        if (up && random() % 3 != 0) f.presented("audio_node", "audio", n, ms + 5), ++reported;
      }
      f.matcher.advance(f.at(ms));
      const OutcomeCounts t = f.tally("audio");
      REQUIRE(sum(t) == t.expected);
      REQUIRE(std::min({t.presented, t.lost, t.stalled, t.dead}) >= 0);
    }
    f.matcher.finish(f.at(20000));
    CHECK(sum(f.tally("audio")) == f.tally("audio").expected);
    CHECK(f.tally("audio").presented <= reported);
    CHECK(f.tally("audio").expected <= n);
  }
}
