// Tests of matching expected events to presentation reports, and of their outcomes.
#include "sync/presentation/presentation_matcher.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>

#include "tests/sync/presentation/presentation_matcher_fixture.h"

using namespace tactus;
using namespace tactus::sync;

TEST_CASE("A reported event has the outcome of its report") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  f.event(1, 1000);
  const auto outcome = [&](std::int8_t o) {
    f.presented("audio_node", "audio", 1, 1020, o);
    f.matcher.advance(f.at(2001));
    CHECK(f.tally("audio").expected == 1);
    CHECK(sum(f.tally("audio")) == 1);
    return f.tally("audio");
  };
  SECTION("the outcome is presented") { CHECK(outcome(presentation_t::PRESENTED).presented == 1); }
  SECTION("the outcome is late") { CHECK(outcome(presentation_t::LATE).presented == 1); }
  SECTION("the outcome is inaudible") { CHECK(outcome(presentation_t::INAUDIBLE).presented == 1); }
  SECTION("the outcome is dropped late") { CHECK(outcome(presentation_t::DROPPED_LATE).dropped_late == 1); }
  SECTION("the outcome is dropped by profile") { CHECK(outcome(presentation_t::DROPPED_BY_PROFILE).dropped_by_profile == 1); }
}

TEST_CASE("An event that a running node does not report is lost after one second") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  f.event(1, 1000);
  f.matcher.advance(f.at(1999));
  CHECK(f.tally("audio").expected == 0);
  f.matcher.advance(f.at(2000));
  CHECK(f.tally("audio").expected == 1);
  CHECK(f.tally("audio").lost == 1);

  SECTION("a later report changes nothing") {
    f.presented("audio_node", "audio", 1, 2500);
    CHECK(f.tally("audio").lost == 1);
  }
}

TEST_CASE("A node must present the kinds of events that it declares") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  f.healths("visual_node", "visual", kBoth, 0, 5000);
  f.healths("left", "haptic", kBoth | node_health_t::EXPECTS_OWN_TOOL_ONLY, 0, 5000, 1, node_health_t::RUNNING, 0);
  f.healths("right", "haptic", kBoth | node_health_t::EXPECTS_OWN_TOOL_ONLY, 0, 5000, 1, node_health_t::RUNNING, 1);
  f.healths("sim_node", "", 0, 0, 5000);
  f.event(1, 1000, contact_event_t::BEGIN);
  f.event(2, 1001, contact_event_t::HIT, 1);
  f.event(3, 1002, contact_event_t::END, 1);
  f.event(4, 1003, contact_event_t::HIT, 2);
  f.matcher.advance(f.at(2500));
  CHECK(f.matcher.begins() == 1);
  CHECK(f.matcher.hits() == 2);
  CHECK(f.matcher.ends() == 1);
  CHECK(f.tally("audio").expected == 2);
  CHECK(f.tally("visual").expected == 3);
  CHECK(f.tally("haptic").expected == 1);  // the hit of the right hand
  CHECK(f.matcher.modalities().size() == 3);
}

TEST_CASE("A modality that never ran has no expected events") {
  MatcherFixture f;
  f.event(1, 1000);
  f.matcher.advance(f.at(3000));
  CHECK(f.matcher.modalities().empty());

  SECTION("a modality that waits or has just started has none either") {
    f.healths("audio_node", "audio", kHit, 3000, 4000, 1, node_health_t::WAITING);
    f.healths("audio_node", "audio", kHit, 4100, 9000);
    f.event(2, 3500);
    f.event(3, 4050);
    f.event(4, 4299);
    f.event(5, 4301);
    f.matcher.advance(f.at(7000));
    CHECK(f.tally("audio").expected == 1);
    CHECK(f.tally("audio").lost == 1);
  }
}

TEST_CASE("A modality that was ready before the simulation started must present its first contact") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 500, 900, 1, node_health_t::READY);
  f.healths("audio_node", "audio", kHit, 1000, 4000);
  f.event(1, 950);
  f.matcher.advance(f.at(3000));
  CHECK(f.tally("audio").expected == 1);
  CHECK(f.tally("audio").lost == 1);
}

TEST_CASE("Events during a stop of two seconds count as stalled") {
  MatcherFixture f;
  f.healths("visual_node", "visual", kBoth, 0, 2000);
  f.event(1, 1950);  // the node may have stopped before it could report
  f.event(2, 2500);
  f.event(3, 3990);
  f.event(4, 1800);  // no exception applies
  f.matcher.advance(f.at(3600));
  CHECK(f.tally("visual").dead == 2);  // the apparent state so far
  CHECK(f.tally("visual").lost == 1);
  f.healths("visual_node", "visual", kBoth, 4000, 6000);
  f.event(5, 4001);
  f.matcher.advance(f.at(6000));
  CHECK(f.tally("visual").dead == 0);
  CHECK(f.tally("visual").stalled == 3);
  CHECK(f.tally("visual").lost == 2);
  CHECK(f.tally("visual").expected == 5);
}

TEST_CASE("Events during a silence of 0.3 s count as lost") {
  MatcherFixture f;
  f.healths("visual_node", "visual", kBoth, 0, 2000);
  f.healths("visual_node", "visual", kBoth, 2300, 5000);
  f.event(1, 2150);
  f.matcher.advance(f.at(4000));
  CHECK(f.tally("visual").lost == 1);
}

TEST_CASE("Events count as dead until the successor of a killed node has run for a short time") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 2000, 1);
  f.healths("audio_node", "audio", kHit, 2150, 2450, 2, node_health_t::WAITING);
  f.healths("audio_node", "audio", kHit, 2550, 6000, 2);
  f.event(1, 1500);
  f.event(2, 1950);
  f.event(3, 2080);
  f.event(4, 2300);
  f.event(5, 2700);
  f.event(6, 2760);
  f.matcher.advance(f.at(5000));
  CHECK(f.tally("audio").dead == 4);
  CHECK(f.tally("audio").lost == 2);

  SECTION("events that it presents in that time count as presented") {
    f.event(7, 5500);
    f.healths("audio_node", "audio", kHit, 6050, 8000, 3);
    f.event(8, 6000);
    f.presented("audio_node", "audio", 8, 6010);
    f.matcher.advance(f.at(7500));
    CHECK(f.tally("audio").presented == 1);
    CHECK(f.tally("audio").lost == 3);
  }
}

TEST_CASE("Events of a node that never returns count as dead and delay nothing") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 2000);
  f.healths("visual_node", "visual", kHit, 0, 9000);
  for (int i = 0; i < 50; ++i) {
    f.event(i, 2200 + 100 * i);
    f.presented("visual_node", "visual", i, 2210 + 100 * i);
    f.matcher.advance(f.at(2220 + 100 * i));
  }
  f.matcher.advance(f.at(8200));
  CHECK(f.tally("audio").dead == 50);
  CHECK(f.tally("visual").presented == 50);
}

TEST_CASE("Events of a node without an output count as dead and not as lost") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 1000);
  f.healths("audio_node", "audio", kHit, 1100, 5000, 1, node_health_t::OUTPUT_LOST);
  f.event(1, 1050);
  f.event(2, 3000);
  f.matcher.advance(f.at(4500));
  CHECK(f.tally("audio").dead == 2);
  CHECK(f.tally("audio").lost == 0);
}

TEST_CASE("A node with stale input must still present events") {
  MatcherFixture f;
  f.healths("haptic_node", "haptic", kHit, 0, 1000);
  f.healths("haptic_node", "haptic", kHit, 1100, 5000, 1, node_health_t::INPUT_LOST);
  f.event(1, 1050);
  f.event(2, 3000);
  f.matcher.advance(f.at(4500));
  CHECK(f.tally("haptic").lost == 2);
}

TEST_CASE("A node whose input is stale from the start must present events while it is frozen") {
  MatcherFixture f;
  f.health("visual_node", "visual", kBoth, 0, 1, node_health_t::WAITING);
  f.healths("visual_node", "visual", kBoth, 100, 1000, 1, node_health_t::STALE);
  f.event(1, 1500);
  f.healths("visual_node", "visual", kBoth, 3000, 4000, 1, node_health_t::STALE);
  f.matcher.advance(f.at(4000));
  CHECK(f.tally("visual").expected == 1);
  CHECK(f.tally("visual").stalled == 1);
}

TEST_CASE("Events that the simulation had no time to repeat before it died count as dead unless presented") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 6000);
  f.healths("sim_node", "", 0, 0, 2000, f.sim_incarnation);
  f.event(1, 1900);
  f.event(2, 1990);
  f.event(3, 1991);
  f.presented("audio_node", "audio", 3, 2011);
  f.healths("sim_node", "", 0, 2200, 6000, f.sim_incarnation + 1);
  f.matcher.advance(f.at(4000));
  CHECK(f.tally("audio").lost == 1);
  CHECK(f.tally("audio").dead == 1);
  CHECK(f.tally("audio").presented == 1);
}

TEST_CASE("Health messages and reports of another run are ignored and counted") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  node_health_t old = f.health_message("audio_node", "audio", kHit, 900, 55);
  old.header.run_id = 3;
  f.matcher.observe(old, f.at(900));
  f.event(1, 1000);
  presented_t report = f.presented_message("audio_node", "audio", 1, 1020);
  report.header.run_id = 3;
  f.matcher.observe(report, f.at(1020));
  f.matcher.advance(f.at(2500));
  CHECK(f.tally("audio").lost == 1);
}

TEST_CASE("Events of a replayed run are expected at their time of arrival") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 5000);
  contact_events_t m = f.event_message(1, 1000, contact_event_t::HIT, 100);
  m.header.run_id = 3;
  m.header.publish_time_ns -= 500'000'000'000;  // the clock of that host had another offset
  m.clock.host_ns -= 500'000'000'000;
  f.matcher.observe(m, f.at(1001));
  f.matcher.advance(f.at(1990));
  CHECK(f.tally("audio").expected == 0);
  f.matcher.advance(f.at(2001));
  CHECK(f.tally("audio").expected == 1);
}

TEST_CASE("Events of a replayed log are not expected while a simulation of this run is active") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 6000);
  contact_events_t old = f.event_message(1, 1000, contact_event_t::HIT, 50);
  old.header.run_id = 3;
  f.event(2, 900);
  f.health("sim_node", "", 0, 950, 100);
  f.matcher.observe(old, f.at(1001));
  f.matcher.advance(f.at(2100));
  CHECK(f.tally("audio").expected == 1);  // its own event
  // The node is silent for the next second: the log is the only source.
  f.matcher.observe(old, f.at(2200));
  f.matcher.advance(f.at(4000));
  CHECK(f.tally("audio").expected == 2);
}

TEST_CASE("Events that are undecided at the end of a log are not expected") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 3000);
  f.event(1, 2500);  // lost: the node ran long enough afterwards
  f.event(2, 2950);  // it may have ended before it could report
  f.event(3, 2960);
  f.presented("audio_node", "audio", 3, 2980);
  f.matcher.finish(f.at(3100));
  CHECK(f.tally("audio").expected == 2);
  CHECK(f.tally("audio").lost == 1);
  CHECK(f.tally("audio").presented == 1);
  f.matcher.finish(f.at(3100));
  CHECK(f.tally("audio").expected == 2);
}

TEST_CASE("The end of a run is not a dead node, even if the log continues") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 3000);
  f.healths("visual_node", "visual", kHit, 0, 2900);
  f.healths("sim_node", "", 0, 0, 3000, f.sim_incarnation);
  f.event(1, 2980);
  f.event(2, 2985);
  f.presented("visual_node", "visual", 2, 3000);
  f.matcher.advance(f.at(5500));
  SECTION("no node publishes again") {
    f.matcher.finish(f.at(5500));
    CHECK(f.tally("audio").expected == 0);
    CHECK(f.tally("visual").expected == 1);
    CHECK(f.tally("visual").presented == 1);
  }
  SECTION("nodes count as dead if the simulation publishes again") {
    f.healths("sim_node", "", 0, 5600, 6000, f.sim_incarnation + 1);
    f.matcher.finish(f.at(6000));
    CHECK(f.tally("audio").dead == 2);
    CHECK(f.tally("visual").dead == 1);
  }
  SECTION("a modality counts as stalled if it publishes again") {
    f.healths("audio_node", "audio", kHit, 5600, 6000);
    f.matcher.finish(f.at(6000));
    CHECK(f.tally("audio").stalled == 2);
    CHECK(f.tally("audio").dead == 0);
    CHECK(f.tally("visual").expected == 1);
  }
}

TEST_CASE("Asynchrony is the difference of the presented times") {
  MatcherFixture f;
  for (const char* node : {"haptic", "audio", "visual", "smell"}) f.healths(node, node, kBoth, 0, 9000);
  f.event(1, 1000, contact_event_t::HIT);
  f.presented("haptic", "haptic", 1, 990, presentation_t::PRESENTED, presentation_t::CONSTRAINT);
  f.presented("haptic", "haptic", 1, 1001, presentation_t::PRESENTED, presentation_t::TRANSIENT);
  f.presented("audio", "audio", 1, 1020);
  f.presented("visual", "visual", 1, 1015);
  f.presented("smell", "smell", 1, 1500);
  f.matcher.advance(f.at(2500));
  const auto soa_ms = [&](const char* a, const char* b) {
    const auto it = f.matcher.pairs().find({a, b});
    REQUIRE(it != f.matcher.pairs().end());
    REQUIRE(it->second.count() == 1);
    return static_cast<double>(it->second.quantile(0.5).count()) * 1e-6;
  };
  // Half a bin of 0.1 ms; touch presents a hit as its transient.
  CHECK(soa_ms("haptic", "audio") == Approx(19).margin(0.1));
  CHECK(soa_ms("haptic", "visual") == Approx(14).margin(0.1));
  CHECK(soa_ms("audio", "visual") == Approx(-5).margin(0.1));
  CHECK(soa_ms("visual", "smell") == Approx(485).margin(0.1));
  CHECK(f.matcher.pairs().size() == 6);

  SECTION("the constraint force of a begin forms its own pair, because no policy delays it") {
    f.event(2, 3000, contact_event_t::BEGIN);
    f.presented("haptic", "haptic", 2, 2999, presentation_t::PRESENTED, presentation_t::CONSTRAINT);
    f.presented("visual", "visual", 2, 3029);
    f.matcher.advance(f.at(4500));
    CHECK(f.matcher.pairs().at({"haptic", "visual"}).count() == 1);
    CHECK(soa_ms("haptic_push", "visual") == Approx(30).margin(0.1));
  }
  SECTION("a dropped event has no onset") {
    f.event(3, 3000, contact_event_t::HIT);
    f.presented("audio", "audio", 3, 3020);
    f.presented("visual", "visual", 3, 3020, presentation_t::DROPPED_BY_PROFILE);
    f.matcher.advance(f.at(4500));
    CHECK(f.matcher.pairs().at({"audio", "visual"}).count() == 1);
  }
}

TEST_CASE("Modalities are sorted by their known order, unknown ones last") {
  std::vector<std::string> names = {"wind", "thermal", "visual", "smell", "audio", "haptic"};
  std::sort(names.begin(), names.end(), named_before);
  CHECK(names == std::vector<std::string>{"haptic", "audio", "visual", "thermal", "smell", "wind"});
}

TEST_CASE("Many events take bounded memory, and the excess is counted") {
  MatcherFixture f;
  const int n = static_cast<int>(PresentationMatcher::kMaxEvents) + 1000;
  for (int i = 0; i < n; ++i) f.event(i, 1000);
  CHECK(f.matcher.overflow() == 1000);
  f.matcher.advance(f.at(60000));
  f.event(n, 60000);
  CHECK(f.matcher.overflow() == 1000);
}

TEST_CASE("Many unknown modalities take bounded memory, are counted and do not displace real ones") {
  MatcherFixture f;
  f.healths("audio_node", "audio", kHit, 0, 3000);
  for (int i = 0; i < 200; ++i)
    f.health("n" + std::to_string(i), "z" + std::to_string(i) + std::string(60, 'z'), kHit, 1000);
  CHECK(f.matcher.modalities().size() == PresentationMatcher::kMaxModalities);
  CHECK(f.matcher.overflow() == 201 - static_cast<std::int64_t>(PresentationMatcher::kMaxModalities));
  for (int i = 0; i < 60; ++i) {
    f.event(i, 2000);
    for (int j = 0; j < 30; ++j) f.presented("p" + std::to_string(j), "s" + std::to_string(30 * i + j), i, 2010);
  }
  f.matcher.advance(f.at(4000));
  CHECK(f.matcher.pairs().size() == PresentationMatcher::kMaxPairs);
  CHECK(f.tally("audio").expected == 60);
}
