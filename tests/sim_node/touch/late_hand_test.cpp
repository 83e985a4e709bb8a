// Tests of the stage `action`: the world receives the messages of a hand late.
#include "sim_node/touch/late_hand.h"

#include <catch2/catch.hpp>
#include <random>

#include "sim_node/world/simulation.h"
#include "sync/resampling/sample_status.h"
#include "tests/sim_node/support/simple_hand.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kTick_ns = 1'000'000;

sync::OperatorChain action_operators(const std::string& attributes) {
  if (attributes.empty()) return {};
  return sync::OperatorChain(
      sync::parse_profile("<profile seed=\"9\"><degrade modality=\"haptic\" stage=\"action\" " + attributes + "/></profile>", "p.xml"),
      "haptic", {}, "action");
}

tool_state_t numbered(std::int64_t seq, int tool = 0) {
  tool_state_t m{};
  m.tool = tool;
  m.header.incarnation = 4;
  m.header.seq = seq;
  m.header.sim_time_ns = seq * kTick_ns;
  m.header.publish_time_ns = 1'000'000'000 + seq * kTick_ns;
  m.touch_status = static_cast<std::int8_t>(sync::SampleStatus::kExtrapolated);
  return m;
}

// The released messages of each tick, one message sent in each.
std::vector<std::vector<tool_state_t>> released(sync::OperatorChain operators, int ticks, int last_staged = 1 << 30) {
  LateHand hand;
  std::vector<std::vector<tool_state_t>> out;
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == last_staged) operators = {};
    hand.push(numbered(tick), sync::host_time(tick * kTick_ns), operators, nullptr);
    hand.release(sync::host_time(tick * kTick_ns), sync::sim_time(tick * kTick_ns), operators, out.emplace_back());
  }
  return out;
}

// A free ball that a scripted hand hits and follows.
struct PushedBall {
  std::vector<Vector3d> ball;
  Vector3d speed_m_s{0, 0, 0};
};

PushedBall push_ball(const std::string& attributes, int ticks) {
  WorldDef w = empty_world(0);
  const int body = add_ball(w, 0.2, 0.02, {0.05, 0, 0});
  add_tool(w, {0, 0, 0});
  Simulation simulation(w, {});
  simulation.start(3);
  sync::OperatorChain operators = action_operators(attributes);
  LateHand late;
  Hand hand{.radius = 0.01, .last = {0, 0, 0}};
  PushedBall out;
  for (int tick = 0; tick < ticks; ++tick) {
    const Vector3d at(std::min(0.00004 * tick, 0.024), 0, 0);
    const sync::HostTime now = sync::host_time(tick * kTick_ns);
    late.push(hand.tick(simulation.touch_models().front(), at, sync::to_ns(simulation.now())), now, operators, nullptr);
    std::vector<tool_state_t> messages;
    late.release(now, simulation.now(), operators, messages);
    simulation.step(messages);
    out.ball.push_back(simulation.bodies()[static_cast<std::size_t>(body)].position_m);
    out.speed_m_s = simulation.bodies()[static_cast<std::size_t>(body)].velocity_m_s;
  }
  return out;
}

}  // namespace

TEST_CASE("Without an action stage each message reaches the world in its tick, unchanged") {
  for (const char* neutral : {"", "delay=\"0\"", "loss=\"0%\"", "delay=\"50ms\" from=\"60s\""}) {
    const auto out = released(action_operators(neutral), 200);
    for (int tick = 0; tick < 200; ++tick) {
      const auto& messages = out[static_cast<std::size_t>(tick)];
      REQUIRE(messages.size() == 1);
      CHECK(messages[0].header.seq == tick);
      CHECK(messages[0].header.publish_time_ns == numbered(tick).header.publish_time_ns);
      CHECK(messages[0].touch_status == numbered(tick).touch_status);
    }
  }
}

TEST_CASE("A late hand reaches the world later with its own stamps, and its touch model reaches as far as a late one") {
  for (const char* kind : {"", " network"}) {
    const auto out = released(action_operators("delay=\"40ms" + std::string(kind) + "\""), 300);
    for (int tick = 0; tick < 300; ++tick) {
      const auto& messages = out[static_cast<std::size_t>(tick)];
      REQUIRE(messages.size() == (tick < 40 ? 0u : 1u));
      if (tick < 40) continue;
      CHECK(messages[0].header.seq == tick - 40);
      CHECK(messages[0].header.publish_time_ns == numbered(tick - 40).header.publish_time_ns);
      CHECK(messages[0].touch_status == static_cast<std::int8_t>(sync::SampleStatus::kHeld));
    }
  }
}

TEST_CASE("Messages of a hand never reach the world out of order, also when the delay ends") {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const int delay_ms = 10 + static_cast<int>(random() % 80);
    const auto out = released(action_operators("delay=\"" + std::to_string(delay_ms) + "ms\" jitter=\"" +
                                               std::to_string(delay_ms / 3 > 0 ? delay_ms / 3 : 1) + "ms uniform\" loss=\"10%\""),
                              600, 300);
    std::int64_t newest = -1;
    for (const auto& messages : out)
      for (const tool_state_t& m : messages) {
        REQUIRE(m.header.seq > newest);
        newest = m.header.seq;
      }
    CHECK(newest == 599);
  }
}

TEST_CASE("Two hands are late independently") {
  sync::OperatorChain operators = action_operators("delay=\"5ms\"");
  LateHand hand;
  std::vector<tool_state_t> out;
  for (int tick = 0; tick < 20; ++tick) {
    const sync::HostTime now = sync::host_time(tick * kTick_ns);
    for (int tool : {0, 1}) hand.push(numbered(tick, tool), now, operators, nullptr);
    hand.release(now, sync::sim_time(tick * kTick_ns), operators, out);
  }
  CHECK(out.size() == 2 * 15);
}

TEST_CASE("A scripted hand that is late pushes the ball later, as far and as fast") {
  const PushedBall now = push_ball("", 900), late = push_ball("delay=\"60ms\"", 900), none = push_ball("off=\"true\"", 900);
  CHECK(now.speed_m_s.x() > 0.01);
  CHECK(none.ball.back() == none.ball.front());
  std::size_t first_now = 0, first_late = 0;
  while (now.ball[first_now].x() < 0.0501) ++first_now;
  while (late.ball[first_late].x() < 0.0501) ++first_late;
  CHECK(first_late >= first_now + 60);
  // The hand feels the surface where the world shows it, so its late push differs in size only.
  CHECK(late.speed_m_s.x() > 0.01);
}

TEST_CASE("The force on a scripted hand at a fixed wall is the same while the world receives it late") {
  WorldDef w = empty_world();
  add_floor(w);
  add_tool(w, {0, 0, 0.05});
  const auto forces = [&](const std::string& attributes) {
    Simulation simulation(w, {});
    simulation.start(3);
    sync::OperatorChain operators = action_operators(attributes);
    LateHand late;
    Hand hand{.radius = 0.01, .last = {0, 0, 0.05}};
    std::vector<double> force_N;
    for (int tick = 0; tick < 1500; ++tick) {
      // Rests for 0.3 s, presses 2 mm at up to 0.2 m/s, and leaves again.
      const double t = std::max(0, tick - 300) * 1e-3;
      const Vector3d at(0, 0, 0.029 + 0.021 * std::cos(2 * M_PI * t));
      const sync::HostTime now = sync::host_time(tick * kTick_ns);
      const tool_state_t m = hand.tick(simulation.touch_models().front(), at, sync::to_ns(simulation.now()));
      double sum = 0;
      for (const tool_constraint_t& c : m.constraints) sum += c.force_N.z;
      force_N.push_back(sum);
      late.push(m, now, operators, nullptr);
      std::vector<tool_state_t> messages;
      late.release(now, simulation.now(), operators, messages);
      simulation.step(messages);
    }
    return force_N;
  };
  const auto now = forces(""), late = forces("delay=\"80ms\"");
  CHECK(*std::max_element(now.begin(), now.end()) > 1.9);
  for (std::size_t i = 0; i < now.size(); ++i) CHECK(late[i] == Approx(now[i]).margin(1e-6));
}

TEST_CASE("With a deadband the world follows the motion that is sent, and receives each force and each message") {
  std::mt19937 random(12);
  std::normal_distribution<double> push(0, 0.02);
  for (const std::string quantity : {"position", "velocity"})
    for (const std::string predictor : {"hold", "linear"}) {
      sync::OperatorChain operators = action_operators("deadband=\"10% " + quantity + " floor=" +
                                                       (quantity == "position" ? "1mm" : "1mm/s") + " predict=" + predictor + "\"");
      LateHand hand;
      sync::Decisions decisions;
      Vector3d at(0.2, 0.1, 0), v(0.05, 0, 0);
      int sent = 0;
      for (int tick = 0; tick < 3000; ++tick) {
        v += kTick_ns * 1e-9 * (Vector3d(push(random), push(random), 0) * 20 - 0.5 * v);
        at += kTick_ns * 1e-9 * v;
        tool_state_t m = numbered(tick);
        m.proxy.position_m = to_vec3(at);
        m.proxy_velocity_m_s = to_vec3f(v);
        m.device = m.proxy;
        m.force_N = {0, 0, static_cast<float>(tick)};
        const sync::HostTime now = sync::host_time(tick * kTick_ns);
        hand.push(m, now, operators, &decisions);
        std::vector<tool_state_t> out;
        hand.release(now, sync::sim_time(tick * kTick_ns), operators, out);
        REQUIRE(out.size() == 1);
        CHECK(out[0].header.seq == tick);
        CHECK(out[0].force_N.z == static_cast<float>(tick));
        sent += !decisions.back().decision.dropped();
        const Vector3d p = to_eigen(out[0].proxy.position_m), speed = to_eigen(out[0].proxy_velocity_m_s);
        if (quantity == "position") REQUIRE((p - at).norm() <= std::max(0.1 * p.norm(), 0.001) + 1e-9);
        if (quantity == "velocity") REQUIRE((speed - v).norm() <= std::max(0.1 * speed.norm(), 0.001) + 1e-6);
      }
      INFO(quantity << " " << predictor << ": " << sent << " of 3000");
      CHECK(sent > 1);
      CHECK(sent < 1500);
    }
}

TEST_CASE("A suppressed motion is as late as a sent one") {
  sync::OperatorChain operators = action_operators("deadband=\"10% velocity\" delay=\"20ms network\"");
  LateHand hand;
  for (int tick = 0; tick < 100; ++tick) {
    tool_state_t m = numbered(tick);
    m.proxy_velocity_m_s = {0.1f, 0, 0};
    m.proxy.position_m = {0.0001 * tick, 0, 0};
    hand.push(m, sync::host_time(tick * kTick_ns), operators, nullptr);
    std::vector<tool_state_t> out;
    hand.release(sync::host_time(tick * kTick_ns), sync::sim_time(tick * kTick_ns), operators, out);
    REQUIRE(out.size() == (tick < 20 ? 0u : 1u));
    if (tick < 20) continue;
    CHECK(out[0].header.seq == tick - 20);
    // One message was sent; its velocity is integrated.
    CHECK(out[0].proxy.position_m.x == Approx(0.0001 * (tick - 20)).margin(1e-9));
  }
}

TEST_CASE("A suppressed motion is released after the sent one that it follows from, also with a jitter") {
  sync::OperatorChain operators = action_operators("deadband=\"10% velocity\" delay=\"20ms network\" jitter=\"15ms uniform\"");
  LateHand hand;
  int sent = 0, received = 0;
  std::vector<tool_state_t> out;
  for (int tick = 0; tick < 2000; ++tick) {
    tool_state_t m = numbered(tick);
    // One message in a hundred is sent; its velocity names it.
    m.proxy_velocity_m_s = {1.0f + static_cast<float>(tick / 100), 0, 0};
    sync::Decisions decisions;
    hand.push(m, sync::host_time(tick * kTick_ns), operators, &decisions);
    sent += !decisions.back().decision.dropped();
    out.clear();
    hand.release(sync::host_time(tick * kTick_ns), sync::sim_time(tick * kTick_ns), operators, out);
    for (const tool_state_t& n : out) received += n.header.seq % 100 == 0;
  }
  CHECK(sent >= 10);
  CHECK(received == 20);
}

TEST_CASE("Under a new profile a motion is predicted from its own updates only") {
  const std::string rule = "deadband=\"10% velocity predict=linear\"";
  sync::OperatorChain operators = action_operators(rule);
  LateHand hand;
  for (int tick = 0; tick < 4000; ++tick) {
    if (tick == 1500) operators = action_operators(rule);
    tool_state_t m = numbered(tick);
    m.proxy_velocity_m_s = {tick < 1500 ? 0.5f : 0.1f, 0, 0};
    hand.push(m, sync::host_time(tick * kTick_ns), operators, nullptr);
    std::vector<tool_state_t> out;
    hand.release(sync::host_time(tick * kTick_ns), sync::sim_time(tick * kTick_ns), operators, out);
    REQUIRE(out.size() == 1);
    REQUIRE(out[0].proxy_velocity_m_s.x == Approx(m.proxy_velocity_m_s.x).epsilon(0.11));
  }
}

TEST_CASE("A deadband of 0 % changes no message of a hand") {
  sync::OperatorChain operators = action_operators("deadband=\"0% position predict=linear\"");
  LateHand hand;
  for (int tick = 0; tick < 100; ++tick) {
    tool_state_t m = numbered(tick);
    m.proxy.position_m = {std::sin(0.1 * tick), 0, 0};
    m.proxy_velocity_m_s = {1, 0, 0};
    hand.push(m, sync::host_time(tick * kTick_ns), operators, nullptr);
    std::vector<tool_state_t> out;
    hand.release(sync::host_time(tick * kTick_ns), sync::sim_time(tick * kTick_ns), operators, out);
    REQUIRE(out.size() == 1);
    CHECK(out[0].proxy.position_m.x == m.proxy.position_m.x);
    CHECK(out[0].touch_status == m.touch_status);
  }
}
