// Tests of the motion of a hand over a line between two relays, with a deadband and a predictor.
#include "sync/relay/motion_line.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "lcmtypes/channels.h"
#include "lcmtypes/vectors.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/degradation/degraded_snapshots.h"
#include "sync/relay/relay.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kMotionRun = 7;
constexpr std::int64_t kPublished_ns = 3'600'000'000'000;  // of the tick 0

HostTime motion_ms(int ms) { return host_time(kPublished_ns + 1'000'000LL * ms); }

// A hand with a smooth random motion, once a millisecond, in a world that runs.
class MovingHand {
 public:
  explicit MovingHand(unsigned seed, std::int32_t tool = 0) : tool_(tool) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (auto& axis : waves_)
      for (auto& w : axis) w = {0.01 + 0.04 * unit(random), 2 * M_PI * (0.3 + 2.5 * unit(random)), 2 * M_PI * unit(random)};
  }
  tool_state_t at(int ms) const {
    tool_state_t m{};
    m.header = {1'000'000LL * (ms + 100), to_ns(motion_ms(ms)), 5, kMotionRun, static_cast<std::int32_t>(fnv1a_32("haptic_node")), 11, ms};
    m.tool = tool_;
    m.device.orientation.w = m.proxy.orientation.w = 1;
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      for (const Wave& w : waves_[static_cast<std::size_t>(axis)]) {
        x[axis] += w.size_m * std::sin(w.rad_s * ms * 1e-3 + w.phase);
        v[axis] += w.size_m * w.rad_s * std::cos(w.rad_s * ms * 1e-3 + w.phase);
      }
    m.device.position_m = to_vec3(x);
    m.proxy.position_m = to_vec3(0.9 * x);
    m.device_velocity_m_s = to_vec3f(v);
    m.proxy_velocity_m_s = to_vec3f(0.9 * v);
    return m;
  }

 private:
  struct Wave {
    double size_m, rad_s, phase;
  };
  std::int32_t tool_;
  std::array<std::array<Wave, 2>, 3> waves_{};
};

RelayRules motion_rules(const std::string& deadband) {
  return parse_relay_rules("<relay><pass channel='TOOL_STATE' deadband='" + deadband + "'/></relay>", "rules.xml");
}

std::vector<LineEnd> one_site(int number) { return {parse_other_site("10.0.1." + std::to_string(number) + ":7700")}; }

// Two relays, and a line that takes delay_ms and loses datagrams.
struct MotionLine {
  explicit MotionLine(const std::string& deadband, int delay = 0)
      : here(motion_rules(deadband), one_site(2), kMotionRun), there(motion_rules(deadband), one_site(1), kMotionRun), delay_ms(delay) {}
  // A millisecond: messages on the bus of the one site, the published messages at the other.
  std::vector<tool_state_t> step(int ms, const std::vector<tool_state_t>& messages, bool lost = false) {
    for (const tool_state_t& m : messages) here.on_bus_message({channels::kToolState, encode(m)}, false, motion_ms(ms));
    here.flush(motion_ms(ms), [&](const LineEnd&, std::span<const std::uint8_t> d) {
      ++packets;
      if (!lost) underway.emplace_back(ms + delay_ms, std::vector<std::uint8_t>(d.begin(), d.end()));
      return true;
    });
    for (; !underway.empty() && underway.front().first <= ms; underway.erase(underway.begin())) {
      const auto m = parse_line_datagram(underway.front().second);
      REQUIRE(m);
      REQUIRE_FALSE(there.on_line_message(0, *m, motion_ms(ms)));
    }
    std::vector<tool_state_t> published;
    there.publish_motions(motion_ms(ms), [&](const std::string& channel, std::span<const std::uint8_t> bytes) {
      REQUIRE(channel == channels::kToolState);
      published.push_back(*decode<tool_state_t>(bytes.data(), bytes.size()));
    });
    return published;
  }
  Relay here, there;
  int delay_ms, packets = 0;
  std::vector<std::pair<int, std::vector<std::uint8_t>>> underway{};
};

// The motion that the operator of the stage `action` gives to the world, as in sim_node/touch/late_hand.cpp.
class NodeOperator {
 public:
  explicit NodeOperator(const std::string& deadband)
      : operators_(parse_profile("<profile><degrade modality='haptic' stage='action' deadband='" + deadband + "'/></profile>", "p.xml"), "haptic", {}, "action") {
    waiting_.present_on_release();
    waiting_.keep_stamps();
    waiting_.reconstruct_motion();
  }
  tool_state_t step(int ms, const tool_state_t& m) {
    waiting_.push(m, motion_ms(ms), operators_, nullptr);
    std::optional<std::pair<tool_state_t, HostTime>> next, newest;
    while ((next = waiting_.pop(motion_ms(ms)))) newest = next;
    REQUIRE(newest);
    return newest->first;
  }

 private:
  OperatorChain operators_;
  DegradedSnapshots<tool_state_t> waiting_;
};

double apart(const tool_state_t& a, const tool_state_t& b) {
  return (to_eigen(a.device.position_m) - to_eigen(b.device.position_m)).norm() + (to_eigen(a.proxy.position_m) - to_eigen(b.proxy.position_m)).norm() +
         (to_eigen(a.device_velocity_m_s) - to_eigen(b.device_velocity_m_s)).norm() + (to_eigen(a.proxy_velocity_m_s) - to_eigen(b.proxy_velocity_m_s)).norm();
}

}  // namespace

TEST_CASE("Two relays give the world the motion that the operator in the node gives it, for either predictor") {
  for (const char* quantity : {"velocity", "position"})
    for (const char* predictor : {"hold", "linear"})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        const std::string deadband = std::to_string(2 + 4 * seed) + "% " + quantity + " floor=" + (quantity[0] == 'v' ? "1cm/s" : "1mm") + " predict=" + predictor + " resend=50ms";
        INFO(deadband);
        const int delay_ms = static_cast<int>(seed % 3) * 7;
        const MovingHand hand(seed);
        NodeOperator node(deadband);
        MotionLine line(deadband, delay_ms);
        std::vector<tool_state_t> expected;
        for (int ms = 0; ms < 2000; ++ms) {
          expected.push_back(node.step(ms, hand.at(ms)));
          const auto published = line.step(ms, {hand.at(ms)});
          REQUIRE(published.size() == (ms < delay_ms ? 0u : 1u));
          if (published.empty()) continue;
          REQUIRE(apart(published[0], expected[static_cast<std::size_t>(ms - delay_ms)]) < 1e-12);
          REQUIRE(published[0].header.publish_time_ns == to_ns(motion_ms(ms - delay_ms)));
          REQUIRE(std::abs(published[0].header.sim_time_ns - 1'000'000LL * (ms - delay_ms + 100)) <= 1);
          REQUIRE(published[0].header.seq == ms - delay_ms);
        }
        CHECK(line.packets < 1000);
      }
}

TEST_CASE("A lost packet is a gap in the numbers, and the next packet corrects the motion") {
  const MovingHand hand(3);
  MotionLine whole("10% velocity predict=linear resend=20ms"), lossy("10% velocity predict=linear resend=20ms");
  std::mt19937 random(5);
  int gaps = 0, last_packets = 0;
  std::int64_t next_seq = 0, lost = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    const auto right = whole.step(ms, {hand.at(ms)});
    const bool loses = ms > 0 && random() % 3 == 0;
    const int before = lossy.packets;
    const auto got = lossy.step(ms, {hand.at(ms)}, loses);
    const bool sent = lossy.packets > before;
    lost += loses && sent;
    if (sent && !loses) {
      REQUIRE(apart(got.at(0), right.at(0)) < 1e-12);
      last_packets = ms;
    }
    for (const tool_state_t& m : got) {
      gaps += static_cast<int>(m.header.seq - next_seq);
      next_seq = m.header.seq + 1;
    }
  }
  CHECK(last_packets > 2900);
  CHECK(gaps <= lost);
  CHECK(gaps >= lost - 3);  // the last ones have no packet after them yet
  CHECK(lost > 50);
}

TEST_CASE("A hand whose line breaks stops after twice the time of resend") {
  const MovingHand hand(4);
  MotionLine line("10% velocity predict=linear resend=20ms");
  for (int ms = 0; ms < 500; ++ms) line.step(ms, {hand.at(ms)});
  int last = 0;
  for (int ms = 500; ms < 2000; ++ms)
    if (!line.step(ms, {hand.at(ms)}, true).empty()) last = ms;
  CHECK(last >= 500);
  CHECK(last < 500 + 40);
  CHECK(line.step(2000, {hand.at(2000)}).size() <= 1);
  for (int ms = 2001; ms < 2030; ++ms) line.step(ms, {hand.at(ms)});
  CHECK(line.step(2030, {hand.at(2030)}).size() == 1);
}

TEST_CASE("A hand at rest is sent again after the time of resend and published in each tick") {
  MotionLine line("10% velocity predict=linear resend=20ms");
  tool_state_t still = MovingHand(1).at(0);
  still.device_velocity_m_s = still.proxy_velocity_m_s = {};
  for (int ms = 0; ms < 1000; ++ms) {
    still.header.publish_time_ns = to_ns(motion_ms(ms));
    still.header.seq = ms;
    CHECK(line.step(ms, {still}).size() == 1);
  }
  CHECK(line.packets == 50);
}

TEST_CASE("Two hands of one sender keep their own motions") {
  const MovingHand left(1, 0), right(2, 1);
  const std::string deadband = "10% velocity predict=linear resend=20ms";
  NodeOperator left_node(deadband), right_node(deadband);
  MotionLine line(deadband);
  for (int ms = 0; ms < 1000; ++ms) {
    const tool_state_t a = left_node.step(ms, left.at(ms)), b = right_node.step(ms, right.at(ms));
    const auto published = line.step(ms, {left.at(ms), right.at(ms)});
    REQUIRE(published.size() == 2);
    for (const tool_state_t& m : published) REQUIRE(apart(m, m.tool == 0 ? a : b) < 1e-12);
  }
}

TEST_CASE("A message of a hand with a wrong number or time stops its motion for 60 ms at most") {
  using Change = void (*)(header_t&);
  constexpr std::int64_t kLatest_ns = 1'000'000'000'000'000'000;
  const std::array<std::pair<const char*, Change>, 11> changes{{
      {"half a second ahead", [](header_t& h) { h.publish_time_ns += 500'000'000; }},
      {"half a second ahead, with a later number", [](header_t& h) { h.publish_time_ns += 500'000'000, h.seq += 2; }},
      {"half a second and a thousand numbers ahead", [](header_t& h) { h.publish_time_ns += 500'000'000, h.seq += 1000; }},
      {"a second and all numbers ahead", [](header_t& h) { h.publish_time_ns += 999'000'000, h.seq = std::numeric_limits<std::int64_t>::max(); }},
      {"ten seconds ahead", [](header_t& h) { h.publish_time_ns += 10'000'000'000; }},
      {"at the end of time", [](header_t& h) { h.publish_time_ns = kLatest_ns; }},
      {"at the begin of time", [](header_t& h) { h.publish_time_ns = 0; }},
      {"a thousand numbers ahead", [](header_t& h) { h.seq += 1000; }},
      {"an impossible number", [](header_t& h) { h.seq = std::numeric_limits<std::int64_t>::max(); }},
      {"the first number", [](header_t& h) { h.seq = 0; }},
      {"the end of the world", [](header_t& h) { h.sim_time_ns = kLatest_ns; }},
  }};
  for (const bool on_line : {false, true})
    for (const bool moves : {false, true})
      for (const auto& [name, change] : changes) {
        INFO(name << (on_line ? ", on the line" : ", on the bus") << (moves ? ", of a hand that moves" : ", of a hand at rest"));
        MotionLine line("10% velocity floor=1cm/s predict=linear resend=20ms");
        const MovingHand hand(2);
        const auto at = [&](int ms) {
          tool_state_t m = hand.at(ms);
          if (!moves) {
            const header_t header = m.header;
            m = hand.at(0);
            m.header = header, m.device_velocity_m_s = m.proxy_velocity_m_s = {};
          }
          return m;
        };
        int unpublished = 0;
        for (int ms = 0; ms < 700; ++ms) {
          std::vector<tool_state_t> messages{at(ms)};
          if (ms == 300) {
            tool_state_t wrong = at(ms);
            wrong.header.seq = on_line ? line.packets : wrong.header.seq + 1;  // the next number
            change(wrong.header);
            if (on_line)
              line.there.on_line_message(0, *parse_line_datagram(line_datagram({channels::kToolState, encode(wrong)}, false)), motion_ms(ms));
            else
              messages.push_back(wrong);
          }
          const auto published = line.step(ms, messages);
          unpublished += published.empty();
          if (ms < 300 + 3 * 20 + 5 || published.empty()) continue;  // numbers that are used twice, and the next packet
          CHECK(apart(published.back(), at(ms)) < (moves ? 0.3 : 1e-9));
        }
        CHECK(unpublished <= 3 * 20);
      }
}

TEST_CASE("An invalid motion from a line is counted and not published") {
  MotionLine line("10% velocity resend=20ms");
  std::vector<std::uint8_t> bytes = encode(MovingHand(1).at(0));
  bytes.resize(bytes.size() - 3);
  const auto datagram = line_datagram({channels::kToolState, bytes}, false);
  CHECK_FALSE(line.there.on_line_message(0, *parse_line_datagram(datagram), motion_ms(0)));
  CHECK(line.there.counts().bad == 1);
  CHECK(line.step(1, {}).empty());
}

TEST_CASE("predict=linear of a relay needs a motion and a time of resend") {
  const auto motion_refusal = [](const std::string& pass) {
    try {
      parse_relay_rules("<relay>\n<pass " + pass + "/></relay>", "rules.xml");
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  for (const char* pass : {"channel='TOOL_STATE' deadband='10% velocity predict=linear'", "channel='TOOL_STATE' deadband='10% force predict=linear resend=20ms'",
                           "channel='WORLD_STATE' deadband='10% position predict=linear resend=20ms'"})
    CHECK(motion_refusal(pass).find("rules.xml:2: predict=linear needs a receiver that predicts: give the channel TOOL_STATE") == 0);
  CHECK(motion_refusal("channel='TOOL_STATE' deadband='10% velocity predict=linear resend=20ms'").empty());
  CHECK(motion_refusal("channel='TOOL_STATE' deadband='10% position resend=20ms'").empty());
  CHECK(motion_refusal("channel='TOOL_STATE' deadband='10% position resend=1s'").empty());
  CHECK(motion_refusal("channel='TOOL_STATE' deadband='10% position resend=1001ms'").find("behind a broken line the hand would move on") != std::string::npos);
}
