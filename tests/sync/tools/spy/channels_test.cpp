// Tests of the statistics of each channel of a bus.
#include "sync/tools/spy/channels.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/decode.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using namespace tactus::sync::spy;
using tactus::test::at_ms;

namespace {

struct Heard {
  ClockMaps maps{7};
  Channels channels{OwnClock{7, 1, &maps}};

  void receive(const std::string& channel, const std::vector<std::uint8_t>& bytes, HostTime at, bool whole = true) {
    MessageBatch batch;
    REQUIRE(batch.add(at, {channel, bytes, whole}, 1 << 20));
    channels.push(batch[0]);
  }
  void tool(std::int64_t seq, HostTime sent, HostTime at, std::int32_t source = 5,
            const std::string& channel = "TOOL_STATE") {
    tool_state_t m{};
    m.header.run_id = 7, m.header.clock = 1, m.header.incarnation = 9, m.header.source = source,
    m.header.seq = seq;
    m.header.sim_time_ns = 0, m.header.publish_time_ns = to_ns(sent);
    m.force_N.z = static_cast<float>(seq);
    receive(channel, encode(m), at);
  }
  const ChannelFigures& of(const std::string& name) {
    figures = channels.figures(at_ms(10'000));
    const auto it = std::find_if(figures.begin(), figures.end(), [&](const auto& f) { return f.name == name; });
    REQUIRE(it != figures.end());
    return *it;
  }
  std::vector<ChannelFigures> figures;
};

}  // namespace

TEST_CASE("A channel has type, rate, losses and age") {
  Heard h;
  std::int64_t seq = 0;
  for (int ms = 8000; ms <= 10'000; ms += 10) {
    if (ms == 9000) seq += 4;  // four are lost
    h.tool(seq++, at_ms(ms) - Nanoseconds(3'000'000), at_ms(ms));
  }
  const ChannelFigures& f = h.of("TOOL_STATE");
  CHECK(f.type == "tool_state_t");
  CHECK(f.messages == 201);
  CHECK(f.gaps == 4);
  CHECK(f.senders == 1);
  CHECK(f.rate_Hz == Approx(100));
  CHECK(f.age_ms == Approx(3));
  CHECK(f.silent_s == 0);
  const MessageType* type = type_of(h.channels.newest("TOOL_STATE"));
  REQUIRE(type);
  CHECK(FieldPath(*type, "force_N.z").number(h.channels.newest("TOOL_STATE")) == static_cast<double>(seq - 1));
}

TEST_CASE("The rates of several senders on a channel add up, and their jitter is separate") {
  Heard h;
  for (int i = 0; i <= 200; ++i) {
    h.tool(i, at_ms(8000 + 10 * i), at_ms(8000 + 10 * i), 5);
    h.tool(i, at_ms(8000 + 10 * i), at_ms(8000 + 10 * i) + Nanoseconds(1'000'000), 6);
  }
  const ChannelFigures& f = h.of("TOOL_STATE");
  CHECK(f.senders == 2);
  CHECK(f.rate_Hz == Approx(200).epsilon(0.01));
  CHECK(f.jitter.p99_ms == Approx(0).margin(1e-6));
  CHECK(f.gaps == 0);
}

TEST_CASE("Messages of unknown types are listed, and incomplete ones are counted") {
  Heard h;
  h.receive("CAMERA", {1, 2, 3, 4, 5, 6, 7, 8, 9}, at_ms(9000));
  h.receive("CAMERA", {1, 2}, at_ms(9001), false);
  h.receive("EMPTY", {}, at_ms(9000));
  CHECK(h.of("CAMERA").type.empty());
  CHECK(h.of("CAMERA").messages == 2);
  CHECK(h.of("CAMERA").torn == 1);
  CHECK(h.of("CAMERA").age_ms < 0);
  CHECK(h.of("EMPTY").messages == 1);
  CHECK(h.channels.newest("NOTHING").empty());
}

TEST_CASE("The number of channels and senders is bounded, and the excess is counted") {
  Heard h;
  for (int i = 0; i < 2000; ++i) h.receive("NOISE_" + std::to_string(i), {1}, at_ms(9000));
  CHECK(h.channels.figures(at_ms(9000)).size() == Channels::kMax);
  CHECK(h.channels.beyond() == 2000 - static_cast<std::int64_t>(Channels::kMax));
  CHECK(h.channels.messages() == 2000);
  Heard many;
  for (int i = 0; i < 2000; ++i) many.tool(i, at_ms(9000), at_ms(9000), i + 1);
  CHECK(many.of("TOOL_STATE").senders == static_cast<int>(Channels::kMaxSenders));
}
