// Hostile and damaged messages must not harm a receiver.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <new>
#include <tactus/answer_t.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/clock_probe_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <utility>

#include "sync/bus/decode.h"
#include "tests/lcmtypes/samples.h"
#include "tests/lcmtypes/schema.h"
#include "tests/source_dir.h"

namespace {
std::atomic<std::size_t> largest_allocation{0};
}

// Tracks every allocation of this test program, to detect memory for a message that claims a billion elements.
[[gnu::noinline]] void* operator new(std::size_t size) {
  std::size_t seen = largest_allocation;
  while (size > seen && !largest_allocation.compare_exchange_weak(seen, size)) {
  }
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace tactus::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Schema& schema() {
  static const Schema s(source_dir() + "/lcmtypes");
  return s;
}

template <class Message>
constexpr bool kIsAsset = std::is_same_v<Message, scene_t> || std::is_same_v<Message, mesh_t>;

// The validation that nodes use.
template <class Message>
std::optional<Message> border(const Bytes& bytes) {
  if constexpr (kIsAsset<Message>)
    return sync::decode_asset<Message>(bytes);
  else
    return sync::decode<Message>(bytes.data(), bytes.size());
}

// Memory limit: 512 bytes for each byte on the wire, and 4 kB of constant overhead.
template <class Message>
bool refused_cheaply(const Bytes& bytes) {
  largest_allocation = 0;
  const bool refused = !border<Message>(bytes);
  return refused && largest_allocation <= 512 * bytes.size() + 4096;
}

template <class Message>
Bytes encoded_sample(Samples& samples) {
  Bytes bytes;
  do {
    Message m{};
    samples.fill(m);
    bytes = sync::encode(m);
  } while (!kIsAsset<Message> && bytes.size() > channels::kMaxMessageBytes);
  return bytes;
}

#define EVERY_MESSAGE                                                                                             \
  touch_model_t, contact_events_t, contact_frame_t, world_state_t, tool_state_t, thermal_state_t, presented_t,    \
      device_state_t, device_force_t, frame_shown_t, picture_chunk_t,                                                                            \
      node_health_t, sync_report_t, clock_probe_t, clock_map_t, media_clock_t, scene_manifest_t, asset_request_t, \
      asset_chunk_t, scene_t, mesh_t, log_info_t, degradation_t, degraded_t, playout_t,           \
      playout_request_t, setting_change_t, setting_reply_t, sim_command_t, sim_reply_t, game_state_t, thermal_device_t, \
      tag_list_t, tag_request_t, tag_values_t, question_t, answer_t

}  // namespace

TEMPLATE_TEST_CASE("A valid message is received unchanged", "", EVERY_MESSAGE) {
  Samples samples(1);
  for (int i = 0; i < 200; ++i) {
    const Bytes bytes = encoded_sample<TestType>(samples);
    const auto m = border<TestType>(bytes);
    REQUIRE(m);
    REQUIRE(sync::encode(*m) == bytes);
    REQUIRE_NOTHROW(schema().walk(TestType::getTypeName(), bytes));
  }
}

TEMPLATE_TEST_CASE("A message truncated anywhere, or with extra bytes, is rejected", "", EVERY_MESSAGE) {
  Samples samples(2);
  for (int i = 0; i < 5; ++i) {
    Bytes bytes = encoded_sample<TestType>(samples);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      REQUIRE(
          refused_cheaply<TestType>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))));
    for (int extra = 0; extra < 16; ++extra) {
      bytes.push_back(static_cast<std::uint8_t>(samples.whole(0, 255)));
      REQUIRE(refused_cheaply<TestType>(bytes));
    }
  }
}

TEMPLATE_TEST_CASE("A message of another type is rejected", "", EVERY_MESSAGE) {
  Samples samples(3);
  Bytes bytes = encoded_sample<TestType>(samples);
  for (std::size_t bit = 0; bit < 64; ++bit) {
    Bytes other = bytes;
    other[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    REQUIRE(refused_cheaply<TestType>(other));
  }
  for (const auto fingerprint :
       {touch_model_t::getHash(), node_health_t::getHash(), scene_t::getHash(), pose_t::getHash()}) {
    if (fingerprint == TestType::getHash()) continue;
    put(bytes, 0, fingerprint);
    REQUIRE(refused_cheaply<TestType>(bytes));
  }
}

TEMPLATE_TEST_CASE("A number that is not finite, in any field, is rejected", "", EVERY_MESSAGE) {
  Samples samples(4);
  for (int i = 0; i < 5; ++i) {
    const Bytes bytes = encoded_sample<TestType>(samples);
    for (const Spot& spot : schema().walk(TestType::getTypeName(), bytes)) {
      if (spot.type != "double" && spot.type != "float") continue;
      INFO(spot.path);
      for (const double poison :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()}) {
        Bytes poisoned = bytes;
        if (spot.type == "double")
          put(poisoned, spot.offset, poison);
        else
          put(poisoned, spot.offset, static_cast<float>(poison));
        REQUIRE(refused_cheaply<TestType>(poisoned));
      }
    }
  }
}

TEMPLATE_TEST_CASE("A false length is rejected without allocation", "", EVERY_MESSAGE) {
  Samples samples(5);
  for (int i = 0; i < 20; ++i) {
    const Bytes bytes = encoded_sample<TestType>(samples);
    for (const Spot& spot : schema().walk(TestType::getTypeName(), bytes)) {
      if (!spot.is_count && spot.type != "string") continue;
      INFO(spot.path);
      const std::int32_t lies[] = {-1, std::numeric_limits<std::int32_t>::min(),
                                   std::numeric_limits<std::int32_t>::max(), 1 << 20, 0x01000000};
      for (const std::int32_t lie : lies) {
        Bytes lying = bytes;
        if (spot.type == "int8_t")
          put(lying, spot.offset, static_cast<std::int8_t>(lie < 0 ? -1 : 127));
        else
          put(lying, spot.offset, lie);
        REQUIRE(refused_cheaply<TestType>(lying));
      }
      if (spot.type != "string") continue;
      Bytes lying = bytes;
      put(lying, spot.offset, std::int32_t{0});  // a string has at least its final zero
      REQUIRE(refused_cheaply<TestType>(lying));
    }
  }
}

TEMPLATE_TEST_CASE("An enumeration out of range is rejected", "", EVERY_MESSAGE) {
  Samples samples(6);
  for (int i = 0; i < 20; ++i) {
    const Bytes bytes = encoded_sample<TestType>(samples);
    for (const Spot& spot : schema().walk(TestType::getTypeName(), bytes)) {
      if (!spot.enumerated) continue;
      INFO(spot.path);
      for (const int wrong : {-1, -128, 100, 127}) {
        Bytes altered = bytes;
        if (spot.type == "int8_t")
          put(altered, spot.offset, static_cast<std::int8_t>(wrong));
        else
          put(altered, spot.offset, std::int32_t{wrong});
        REQUIRE(refused_cheaply<TestType>(altered));
      }
    }
  }
}

TEMPLATE_TEST_CASE("A page number outside the page count is rejected", "", contact_events_t, contact_frame_t, world_state_t,
                   scene_manifest_t, sync_report_t) {
  Samples samples(7);
  const int wrong[][2] = {{0, 0}, {1, 1}, {-1, 1}, {5, 3}, {0, -1}, {std::numeric_limits<int>::max(), 2}};
  for (const auto& [page, pages] : wrong) {
    TestType m{};
    samples.fill(m);
    m.page = page, m.pages = pages;
    INFO(page << " of " << pages);
    CHECK(!valid(m));
    CHECK(refused_cheaply<TestType>(sync::encode(m)));
  }
}

TEMPLATE_TEST_CASE("Random bytes are rejected, and damaged messages are rejected or harmless", "", EVERY_MESSAGE) {
  Samples samples(8);
  const auto byte = [&] { return static_cast<std::uint8_t>(samples.whole(0, 255)); };
  for (int i = 0; i < 2000; ++i) {
    Bytes noise(static_cast<std::size_t>(samples.whole(0, 1500)));
    for (auto& b : noise) b = byte();
    REQUIRE(refused_cheaply<TestType>(noise));
    if (noise.size() < 8) continue;
    put(noise, 0, TestType::getHash());  // the right type, otherwise noise
    largest_allocation = 0;
    (void)border<TestType>(noise);
    REQUIRE(largest_allocation <= 512 * noise.size() + 4096);
  }
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = encoded_sample<TestType>(samples);
    for (int flips = samples.whole(1, 8); flips > 0; --flips)
      bytes[static_cast<std::size_t>(samples.whole(8, static_cast<int>(bytes.size()) - 1))] = byte();
    largest_allocation = 0;
    const auto m = border<TestType>(bytes);
    REQUIRE(largest_allocation <= 512 * bytes.size() + 4096);
    if (!m) continue;
    REQUIRE(valid(*m));
    REQUIRE_NOTHROW(schema().walk(TestType::getTypeName(), bytes));
  }
}

TEST_CASE("An unprintable name is rejected") {
  Samples samples(10);
  node_health_t health{};
  presented_t presented{};
  samples.fill(health), samples.fill(presented);
  health.modality = "audio";
  REQUIRE(valid(health));
  REQUIRE(valid(presented));
  for (const std::string& bad :
       {std::string(65, 'a'), std::string("a\x1b[2J"), std::string("\xc3\xa4"), std::string("a\n")}) {
    node_health_t node = health, modality = health;
    node.node = modality.modality = presented.modality = bad;
    CHECK(!valid(node));
    CHECK(!valid(modality));
    CHECK(!valid(presented));
  }
}

TEST_CASE("A time that would overflow is rejected") {
  Samples samples(11);
  contact_frame_t frame{};
  samples.fill(frame);
  REQUIRE(valid(frame));
  for (auto* time :
       {&frame.header.sim_time_ns, &frame.header.publish_time_ns, &frame.clock.sim_ns, &frame.clock.host_ns}) {
    const auto kept = std::exchange(*time, std::numeric_limits<std::int64_t>::max());
    CHECK(!valid(frame));
    *time = kept;
  }
  frame.clock.rate = 1000;
  CHECK(!valid(frame));
}

TEST_CASE("A valid message that would be fragmented is rejected") {
  Samples samples(9);
  world_state_t m{};
  samples.fill(m);
  m.bodies.resize(40);
  for (auto& b : m.bodies) samples.fill(b);
  m.count = 40;
  const Bytes bytes = sync::encode(m);
  REQUIRE(valid(m));
  REQUIRE(bytes.size() > channels::kMaxMessageBytes);
  CHECK(!border<world_state_t>(bytes));
}

TEST_CASE("The schema names every field of every published type") {
  CHECK(schema().structs().size() >= 30);
  for (const auto& [name, fields] : schema().structs()) {
    INFO(name);
    CHECK(!fields.empty());
  }
}

}  // namespace tactus::test
