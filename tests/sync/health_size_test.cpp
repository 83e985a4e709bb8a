#include "sync/health_size.h"

#include <catch2/catch.hpp>

#include "lcmtypes/channels.h"
#include "sync/decode.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

node_health_t health(int inputs, std::size_t note = 100) {
  node_health_t m{};
  m.header.run_id = m.header.incarnation = 1;
  m.node = "visual_node";
  m.note = std::string(note, 'n');
  m.tick.bins.resize(m.tick.bin_count = 40), m.wake.bins.resize(m.wake.bin_count = 40);
  for (int i = 0; i < inputs; ++i) {
    input_health_t in{};
    in.channel = "CHANNEL_" + std::to_string(i);
    in.messages = i % 2;  // every other one never carried anything
    m.inputs.push_back(in);
  }
  m.input_count = inputs;
  return m;
}

bool fits(const node_health_t& m) { return m.getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes); }

}  // namespace

TEST_CASE("A report of health that fits goes as it is") {
  node_health_t m = health(4);
  REQUIRE(fits(m));
  make_fit(m);
  CHECK(m.note == std::string(100, 'n'));
  CHECK(m.inputs.size() == 4);
}

TEST_CASE(
    "A report of health with more inputs than a datagram holds leaves idle ones out, then the last, and says so") {
  node_health_t m = health(24);
  REQUIRE_FALSE(fits(m));
  make_fit(m);
  CHECK(fits(m));
  CHECK(m.input_count == static_cast<int>(m.inputs.size()));
  CHECK(m.note == std::string(100, 'n') + "; " + std::to_string(24 - m.inputs.size()) + " inputs more");
  // No busy one went while an idle one was there.
  std::size_t busy = 0;
  for (const input_health_t& in : m.inputs) busy += in.messages > 0;
  CHECK((busy == 12 || busy == m.inputs.size()));
  CHECK(m.inputs.back().channel == "CHANNEL_" + std::to_string(2 * busy - 1));
  const auto bytes = encode(m);
  CHECK(decode<node_health_t>(bytes.data(), bytes.size()));
}

TEST_CASE("Any report of health is made to fit") {
  for (const int inputs : {0, 1, 10, 60, 200})
    for (const std::size_t note : {0u, 140u, 1000u, 5000u}) {
      node_health_t m = health(inputs, note);
      make_fit(m);
      CHECK(fits(m));
    }
}
