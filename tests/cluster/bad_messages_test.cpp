// Tests of malformed messages on the bus of a running cluster: every node counts and drops them, and none exits.
#include <chrono>
#include <limits>
#include <random>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <thread>

#include "sync/bus/decode.h"
#include "tests/cluster/support/datagram.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

header_t header() {
  header_t h{};
  h.run_id = RunningCluster::kRunId;
  h.source = 666;
  h.incarnation = 666;
  return h;
}

template <class Message>
Message with_header() {
  Message m{};
  m.header = header();
  return m;
}

// Well-formed messages with one non-finite value, by channel.
std::map<std::string, Bytes> non_finite_messages() {
  auto events = with_header<contact_events_t>();
  events.pages = 1;
  events.count = 1;
  events.events.resize(1);
  events.events[0].approach_speed_m_s = kNan;
  auto contacts = with_header<contact_frame_t>();
  contacts.pages = 1;
  contacts.count = 1;
  contacts.contacts.resize(1);
  contacts.contacts[0].depth_m = std::numeric_limits<float>::infinity();
  auto world = with_header<world_state_t>();
  world.pages = 1;
  world.count = 1;
  world.bodies.resize(1);
  world.bodies[0].position_m.x = std::numeric_limits<double>::quiet_NaN();
  auto touch = with_header<touch_model_t>();
  touch.clock.rate = std::numeric_limits<double>::quiet_NaN();
  auto tool = with_header<tool_state_t>();
  tool.force_N.z = kNan;
  auto health = with_header<node_health_t>();
  health.rate_Hz = std::numeric_limits<double>::infinity();
  return {{channels::kContactEvents, sync::encode(events)}, {channels::kContacts, sync::encode(contacts)},
          {channels::kWorldState, sync::encode(world)},     {channels::kTouchModel, sync::encode(touch)},
          {channels::kToolState, sync::encode(tool)},       {channels::kNodeHealth, sync::encode(health)}};
}

const std::vector<std::string> kChannels{channels::kTouchModel,  channels::kContactEvents, channels::kContacts,
                                    channels::kWorldState,  channels::kToolState,     channels::kThermalState,
                                    channels::kPresented,   channels::kNodeHealth,    channels::kSceneManifest,
                                    channels::kAssetChunk,  channels::kAssetRequest,  channels::kThermalDevice,
                                    channels::kDeviceState, channels::kDeviceForce};

// One round of every kind of bad datagram, on both ports.
void send_bad_messages(Datagrams& wire, std::mt19937& random) {
  std::uniform_int_distribution<int> byte(0, 255);
  const auto noise = [&](std::size_t size) {
    Bytes bytes(size);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(byte(random));
    return bytes;
  };
  for (int port : {0, 1}) {
    for (const auto& [channel, bytes] : non_finite_messages()) {
      wire.send_message(channel, bytes, port);
      Bytes part(bytes.begin(), bytes.begin() + static_cast<long>(byte(random) * bytes.size() / 256));
      wire.send_message(channel, part, port);
      Bytes longer = bytes;
      longer.resize(bytes.size() + 5);
      wire.send_message(channel, longer, port);
    }
    for (const std::string& channel : kChannels) {
      wire.send_message(channel, {}, port);
      wire.send_message(channel, noise(64), port);
      wire.send_message(channel, noise(4000), port);
    }
    wire.send(noise(100), port);  // noise without LCM's header
    wire.send({'L', 'C', '0', '2'}, port);
    wire.send({}, port);
  }
}

}  // namespace

TEST_CASE("Malformed, truncated, oversized and non-finite messages are counted and dropped, and no node exits", "[smoke]") {
  RunningCluster c;
  c.start();
  Datagrams wire;
  std::mt19937 random(1);
  std::map<std::string, std::int64_t> before;
  for (const std::string& node : kNodes) before[node] = c.monitor.malformed(node);
  // 3 s of about 10,000 datagrams per second.
  for (int round = 0; round < 300; ++round) {
    send_bad_messages(wire, random);
    c.monitor.receive_for(0.01);
  }
  const std::vector<std::string> all{"sim_node",    "haptic_node",  "audio_node",
                                     "visual_node", "thermal_node", "sync_node"};
  for (const std::string& node : all) {
    INFO(node << ": " << c.processes.output(node));
    CHECK(c.processes.running(node));
    CHECK(c.monitor.wait_until([&] { return c.monitor.malformed(node) > before[node]; }, kTimeout_s));
  }
  const bool recovered = c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s);
  INFO(c.log_text());
  CHECK(recovered);
  const std::int64_t hits = c.monitor.hits();
  CHECK(c.monitor.wait_until([&] { return c.monitor.hits() > hits; }, kTimeout_s));
  REQUIRE(c.monitor.tool_state() != nullptr);
  CHECK(std::isfinite(c.monitor.force_N()));
}
