#include "haptic_node/rendering/session.h"

#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sync/resampling/event_inbox.h"
#include "tests/haptic_node/support/node_config.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;
using Catch::Contains;

namespace {

// As sent by a simulation of run 1.
touch_model_t sent(double sim_ms, std::vector<touch_plane_t> planes, int tool = 0, std::int64_t incarnation = 1) {
  touch_model_t m = model(sim_ms, std::move(planes), tool);
  m.header.publish_time_ns = m.clock.host_ns;
  m.header.incarnation = incarnation;
  return m;
}

contact_events_t events_of(double sim_ms, std::vector<contact_event_t> list) {
  contact_events_t m{};
  m.header = sent(sim_ms, {}).header;
  m.clock = sent(sim_ms, {}).clock;
  m.pages = 1;
  m.count = static_cast<std::int32_t>(list.size());
  m.events = std::move(list);
  return m;
}

NodeConfig config_of(const scene_t& s) { return resolve_config(s, "", {}); }

// The tool is 2 mm under the floor of z = 0.005 + ...: see the poses of the bodies.
scene_t pressing_scene() {
  scene_t s = scene();
  s.bodies[1].pose.position_m.z = 0.003;
  s.bodies[1].pose.orientation.w = 1;
  return s;
}

}  // namespace

TEST_CASE("Tool and settings are selected by name, and unknown names are reported") {
  scene_t s = scene();
  s.tools.push_back(s.tools[0]);
  s.tools[1].name = "finger";
  s.setting_count = 2;
  s.settings.resize(2);
  s.settings[0].node = s.settings[1].node = "haptic_node";
  s.settings[0].name = "force_limit";
  s.settings[0].value = "3 N";
  s.settings[1].name = "stale_after";
  s.settings[1].value = "20ms";
  CHECK(resolve_config(s, "", {}).tool == 0);
  CHECK(resolve_config(s, "finger", {}).tool == 1);
  CHECK(resolve_config(s, "", {}).settings.force_limit_N == 3);
  CHECK(resolve_config(s, "", {"force_limit=2"}).settings.force_limit_N == 2);
  CHECK(resolve_config(s, "", {}).settings.stale_after_s == 0.02);
  CHECK(resolve_config(s, "toe", {}).tool == -1);
  CHECK_THAT(resolve_config(s, "toe", {}).problem, Contains("toe"));
  CHECK_THAT(resolve_config(scene_t{}, "", {}).problem, Contains("no tool"));
  CHECK(rejected_settings(s, {"force=2"}).size() == 1);
  CHECK_THAT(limits_sentence(resolve_config(s, "", {}).settings), Contains("3 N") && Contains("0.49 J"));
}

TEST_CASE("A scene cannot widen a safety limit, the command line can") {
  scene_t s = scene();
  const Settings safe;
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{{"force_limit", "30"},
                                                                                    {"slew_limit", "100000"},
                                                                                    {"energy_limit", "10"},
                                                                                    {"power_limit", "50"},
                                                                                    {"stale_after", "1"},
                                                                                    {"fade", "1"},
                                                                                    {"transient_limit", "20"},
                                                                                    {"stiffness_limit", "20000"},
                                                                                    {"mass_factor", "0.5"},
                                                                                    {"damping_ratio", "0.1"},
                                                                                    {"device_damping", "100"}}) {
    INFO(name);
    s.settings.resize(1);
    s.settings[0].node = "haptic_node";
    s.settings[0].name = name;
    s.settings[0].value = value;
    const auto rejected = rejected_settings(s, {});
    REQUIRE(rejected.size() == 1);
    CHECK_THAT(rejected[0], Contains(name) && Contains("only tighten") && Contains("--set"));
    CHECK(limits_sentence(resolve_config(s, "", {}).settings) == limits_sentence(safe));
    CHECK(rejected_settings(scene(), {name + "=" + value}).empty());
  }
  CHECK(resolve_config(s, "", {"force_limit=12"}).settings.force_limit_N == 12);
}

TEST_CASE("A session renders only the touch models of its own tool") {
  const scene_t s = pressing_scene();
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  const auto floor = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  CHECK_FALSE(session.has_touch_model());
  for (int ms = 0; ms < 100; ++ms) {
    session.push(sent(ms, {floor}, 1), host_ms(ms));
    CHECK(session.step(host_ms(ms)).force_N.norm() == 0);
  }
  CHECK_FALSE(session.has_touch_model());
  TickOutput* out = nullptr;
  for (int ms = 100; ms < 400; ++ms) {
    session.push(sent(ms, {floor}), host_ms(ms));
    session.push(sent(ms, {}, 1), host_ms(ms));
    out = &session.step(host_ms(ms));
  }
  CHECK(session.has_touch_model());
  CHECK_FALSE(session.lost());
  CHECK(out->force_N.z() > 0.3);
  CHECK(out->state.tool == 0);
  CHECK(out->state.header.sim_time_ns == 399 * kMs);
}

TEST_CASE("Models of another tool or of a replaced simulation do not keep the force alive") {
  const scene_t s = pressing_scene();
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  const auto floor = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
  const int other_tool = GENERATE(0, 1);
  // From the bus, and from there to the hand, with a delay of the profile.
  const int delay_ms = GENERATE(0, 30);
  const auto arrives = [&](int ms, const touch_model_t& m) { session.observe_arrival(m, host_ms(ms)); };
  // The predecessor was silent before the simulation began.
  session.observe_arrival(sent(0, {floor}, 0, 9), host_ms(-200));
  double force = 0;
  for (int ms = 0; ms < 590; ++ms) {
    // The simulation ends at 300 ms. Foreign models continue at 100 Hz, in part those of its predecessor.
    if (ms < 300) arrives(ms, sent(ms, {floor}));
    if (ms % 10 == 0) arrives(ms, sent(ms, {floor}, other_tool, other_tool == 0 ? 9 : 3));
    if (ms >= delay_ms && ms < 300 + delay_ms) session.push(sent(ms - delay_ms, {floor}), host_ms(ms));
    force = session.step(host_ms(ms)).force_N.z();
    if (ms == 299) CHECK(force > 0.3);
    if (ms >= 372) CHECK(force == 0);
    if (ms >= 352) CHECK(session.lost());
  }
}

TEST_CASE("Repeated events are rendered once") {
  const scene_t s = pressing_scene();
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  sync::EventInbox events(1);
  int begins = 0, hits = 0;
  for (int ms = 0; ms < 300; ++ms) {
    session.push(sent(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())}), host_ms(ms));
    if (ms >= 100 && ms < 150)
      events.push(events_of(ms, {event(1, contact_event_t::BEGIN, 99.5), event(2, contact_event_t::HIT, 99.5)}),
                   host_ms(ms));
    session.push(events.take(sync::SimTime::max()));
    for (const presentation_t& r : session.step(host_ms(ms)).reports) {
      r.part == presentation_t::TRANSIENT ? ++hits : ++begins;
      CHECK(r.outcome == presentation_t::PRESENTED);
      CHECK(r.scheduled_ns == sync::to_ns(host_ms(99.5)));
      // The transient is in the tick that received it; the constraint was felt from the first one on.
      CHECK(r.presented_ns == sync::to_ns(host_ms(r.part == presentation_t::TRANSIENT ? 100 : 0)));
    }
  }
  CHECK(begins == 1);
  CHECK(hits == 1);
}

TEST_CASE("Events wait for the first touch model, and a flood of them is bounded") {
  const scene_t s = pressing_scene();
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  std::vector<contact_event_t> flood;
  for (int i = 0; i < 3000; ++i) flood.push_back(event(i + 1, contact_event_t::HIT, 0.5));
  std::size_t reports = 0;
  for (int ms = 0; ms < 3; ++ms) {
    session.push(flood);
    reports += session.step(host_ms(ms)).reports.size();
  }
  CHECK(reports == 0);
  session.push(sent(3, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())}), host_ms(3));
  for (int ms = 3; ms < 400; ++ms) reports += session.step(host_ms(ms)).reports.size();
  CHECK(reports == Session::kMaxEvents);
}

TEST_CASE("The first touch model of a restarted simulation causes no jump of the force") {
  const scene_t s = pressing_scene();
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  double last = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    // Stopped at 200 ms, restarted at 500 ms with its time beginning at 0.
    if (ms < 200) session.push(sent(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())}), host_ms(ms));
    if (ms >= 500) {
      auto m = sent(ms - 500, {plane(99, Vector3d::Zero(), Vector3d::UnitZ())}, 0, 2);
      m.clock.host_ns = m.header.publish_time_ns = sync::to_ns(host_ms(ms));
      session.push(m, host_ms(ms));
    }
    const auto& out = session.step(host_ms(ms));
    CHECK(std::abs(out.force_N.z() - last) < 0.2);
    last = out.force_N.z();
    if (ms >= 275 && ms < 500) CHECK(last == 0);
    if (ms >= 500) CHECK(out.state.header.sim_time_ns == (ms - 500) * kMs);
  }
  CHECK(last > 0.3);
}

TEST_CASE("The path of the hand begins with the first touch model") {
  scene_t s = scene();
  s.tools[0].waypoints.resize(2);
  s.tools[0].waypoints[1].time_s = 0.5;
  s.tools[0].waypoints[1].position_m.x = 0.1;
  s.tools[0].waypoint_count = 2;
  Safety safety{SafetyLimits{}};
  Session session(s, config_of(s), make_tool_device(s, config_of(s)), 1, safety);
  const auto x = [](const TickOutput& out) { return out.state.device.position_m.x; };
  // The scene arrives half a second before its time begins; the ticks fall anywhere between its steps.
  const double tick_ms = GENERATE(0.0, 0.3, 0.9);
  for (int ms = -500; ms < 0; ++ms) CHECK(x(session.step(host_ms(ms + tick_ms))) == 0);
  SECTION("The path begins at the simulated instant of the first touch model") {
    double at_250 = 0;
    for (int ms = 0; ms < 1000; ++ms) {
      session.push(sent(ms, {}), host_ms(ms));
      const double here = x(session.step(host_ms(ms + tick_ms)));
      if (ms == 250) at_250 = here;
    }
    CHECK(at_250 == Approx(0.05 + 0.3e-3 * tick_ms).margin(2e-4));  // halfway, at 0.3 m/s
    CHECK(x(session.step(host_ms(1000))) == Approx(0.1).epsilon(1e-6));
  }
  SECTION("With an intended delay the path begins when the first touch model arrives") {
    double held = 0;
    for (int ms = 0; ms < 300; ++ms) {
      if (ms >= 200) session.push(sent(ms - 200, {}), host_ms(ms));
      held = x(session.step(host_ms(ms), {.touch_arrival = host_ms(ms)}));
    }
    CHECK(held > 0.05);
  }
  SECTION("Arrivals of an earlier simulation do not begin the path") {
    for (int ms = 0; ms < 300; ++ms) CHECK(x(session.step(host_ms(ms), {.touch_arrival = host_ms(-501)})) == 0);
  }
}

TEST_CASE("The force continues from its value within the limits when the scene changes") {
  const scene_t s = pressing_scene();
  // So slow that the way to 0.4 N takes 40 ms.
  const NodeConfig slow = resolve_config(s, "", {"slew_limit=10", "energy_limit=0.4"});
  Safety safety{safety_limits(slow.settings)};
  std::optional<Session> session(std::in_place, s, slow, make_tool_device(s, slow), 1, safety);
  Vector3d last = Vector3d::Zero();
  // Rises by the slew limit, and falls within 20 ms.
  double largest = 0;
  const auto tick = [&](int ms) {
    const Vector3d force = session->step(host_ms(ms)).force_N;
    CHECK(beyond_slew_N(force, last, 10 * 1e-3) <= 1e-9);
    largest = std::max(largest, force.norm());
    CHECK((last - force).norm() <= largest / 20 + 0.02);
    last = force;
  };
  for (int ms = 0; ms < 300; ++ms) {
    session->push(sent(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())}), host_ms(ms));
    tick(ms);
  }
  REQUIRE(last.z() > 0.3);
  SECTION("The next scene has the tool") {
    const double given_J = safety.energy_J();
    session.emplace(s, slow, make_tool_device(s, slow), 1, safety);
    tick(300);
    CHECK(last.z() > 0.3);
    CHECK(safety.energy_J() == given_J);  // a new hand at another place: no work
    for (int ms = 301; ms < 320; ++ms) tick(ms);
  }
  SECTION("The next scene has no such tool, and its touch models are ignored") {
    session->end();
    CHECK(session->ended());
    for (int ms = 300; ms < 330; ++ms) {
      session->push(sent(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())}), host_ms(ms));
      tick(ms);
      if (ms < 319) CHECK(last.norm() > 0);
    }
  }
  for (int ms = 330; ms < 400; ++ms) tick(ms);
  CHECK(last.norm() == 0);
}

TEST_CASE("An unknown device of the scene is rejected in one sentence") {
  scene_t s = scene();
  for (const std::string device : {"phantom", "playback:/no/such.csv", "playback:/dev/zero"}) {
    s.tools[0].device = device;
    CHECK_THROWS_WITH(make_tool_device(s, config_of(s)), Contains(device.substr(device.find(':') + 1)));
    const DeviceSpec given;
    CHECK(make_tool_device(s, config_of(s), &given));  // the command line overrides the scene
  }
}
