// Tests of the inputs in NODE_HEALTH and of the size of the message.
#include "sync/bus/health_inputs.h"

#include <catch2/catch.hpp>
#include <tactus/histogram_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/time/histogram.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

input_health_t input(const std::string& channel, std::int32_t gaps = 0, std::int32_t bad = 0) {
  input_health_t i{};
  i.channel = channel, i.gaps = gaps, i.bad = bad;
  return i;
}

node_health_t with_inputs(int n, std::size_t note_bytes) {
  node_health_t m{};
  m.node = "visual_node_front", m.modality = "visual", m.status_text = std::string(note_bytes, 'n');
  for (histogram_t* h : {&m.tick, &m.wake}) h->bins.resize(Histogram::kBins), h->bin_count = Histogram::kBins;
  for (int i = 0; i < n; ++i) add_input(m, input("CHANNEL_OF_A_NAME_" + std::to_string(i)));
  return m;
}

}  // namespace

TEST_CASE("Two subscriptions to one channel are one health input with the larger counts") {
  node_health_t m{};
  add_input(m, input("WORLD_STATE", 3, 0));
  add_input(m, input("TOOL_STATE"));
  add_input(m, input("WORLD_STATE", 1, 2));
  REQUIRE(m.inputs.size() == 2);
  CHECK(m.input_count == 2);
  CHECK(m.inputs[0].channel == "WORLD_STATE");
  CHECK(m.inputs[0].gaps == 3);
  CHECK(m.inputs[0].bad == 2);
}

TEST_CASE("A health message with many inputs and a long note fits a datagram and keeps the first inputs") {
  for (int n = 0; n < 60; ++n)
    for (const std::size_t note_bytes : {0u, 70u, 140u}) {
      node_health_t m = with_inputs(n, note_bytes);
      const bool fits = static_cast<std::size_t>(m.getEncodedSize()) <= channels::kMaxMessageBytes;
      fit(m, channels::kMaxMessageBytes);
      REQUIRE(static_cast<std::size_t>(m.getEncodedSize()) <= channels::kMaxMessageBytes);
      REQUIRE(m.input_count == static_cast<std::int32_t>(m.inputs.size()));
      const int left_out = n - m.input_count;
      REQUIRE((left_out == 0) == fits);
      if (left_out > 0) REQUIRE_THAT(m.status_text, Catch::EndsWith(std::to_string(left_out) + " inputs not listed"));
      if (m.input_count > 0) REQUIRE(m.inputs.front().channel == "CHANNEL_OF_A_NAME_0");
      REQUIRE(m.input_count >= std::min(n, 6));  // the inputs that a renderer needs, and more
    }
}
