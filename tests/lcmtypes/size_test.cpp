// Every message of its documented maximum size fits one datagram.
#include <catch2/catch.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/time/histogram.h"
#include "tests/lcmtypes/samples.h"

using namespace tactus;

namespace {
constexpr std::size_t kMax = channels::kMaxMessageBytes;

template <class Item>
std::vector<Item> full(test::Samples& samples, int count) {
  std::vector<Item> items(static_cast<std::size_t>(count));
  for (Item& item : items) samples.fill(item);
  return items;
}
}  // namespace

TEST_CASE("A page of 7 planes and 4 applied entries of a touch model fits a datagram") {
  test::Samples samples(1);
  touch_model_t m{};
  samples.fill(m);
  m.planes = full<touch_plane_t>(samples, 7);
  m.applied = full<touch_applied_t>(samples, 4);
  m.plane_count = 7;
  m.applied_count = 4;
  CHECK(sync::encode(m).size() <= kMax);
}

TEST_CASE("A tool state with 12 constraints fits a datagram") {
  test::Samples samples(1);
  tool_state_t m{};
  samples.fill(m);
  m.constraints = full<tool_constraint_t>(samples, 12);
  m.constraint_count = 12;
  CHECK(sync::encode(m).size() <= kMax);
}

TEST_CASE("A page holds at least 2 contacts of 4 points, 14 events, 18 bodies") {
  test::Samples samples(1);
  contact_frame_t contacts{};
  contacts.contacts = full<contact_t>(samples, 2);
  for (contact_t& c : contacts.contacts) c.points = full<contact_point_t>(samples, 4), c.point_count = 4;
  contacts.count = 2;
  CHECK(sync::encode(contacts).size() <= kMax);
  contact_events_t events{};
  events.events = full<contact_event_t>(samples, 14);
  events.count = 14;
  CHECK(sync::encode(events).size() <= kMax);
  world_state_t world{};
  world.bodies = full<body_state_t>(samples, 18);
  world.count = 18;
  CHECK(sync::encode(world).size() <= kMax);
}

TEST_CASE("A health message with both histograms full, 8 inputs and a long note fits a datagram") {
  test::Samples samples(1);
  node_health_t m{};
  samples.fill(m);
  m.node = std::string(24, 'n'), m.modality = std::string(12, 'm'), m.status_text = std::string(140, 'x');
  sync::Histogram h;
  for (int i = 0; i < sync::Histogram::kBins; ++i)
    h.add(sync::Nanoseconds(static_cast<std::int64_t>(1000 * std::exp2(i / 4.0))));
  m.tick = m.wake = h.to_message();
  REQUIRE(m.tick.bin_count == sync::Histogram::kBins);
  m.inputs = full<input_health_t>(samples, 8);
  for (input_health_t& i : m.inputs) i.channel = "CONTACT_EVENTS";
  m.input_count = 8;
  CHECK(sync::encode(m).size() <= kMax);
}

TEST_CASE("A report of 30 presentations fits a datagram") {
  test::Samples samples(1);
  presented_t m{};
  m.modality = std::string(16, 'm');
  m.reports = full<presentation_t>(samples, 30);
  m.count = 30;
  CHECK(sync::encode(m).size() <= kMax);
}

TEST_CASE("A manifest page of 12 long names and a full chunk fit a datagram") {
  test::Samples samples(1);
  scene_manifest_t manifest{};
  manifest.assets = full<asset_ref_t>(samples, 12);
  manifest.count = 12;
  for (auto& a : manifest.assets) a.name = std::string(64, 'n');
  CHECK(sync::encode(manifest).size() <= kMax);
  asset_chunk_t chunk{};
  samples.fill(chunk);
  chunk.data.assign(1024, 1);
  chunk.size = 1024;
  CHECK(sync::encode(chunk).size() <= kMax);
}
