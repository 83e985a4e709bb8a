#include "audio_node/output.h"

#include <catch2/catch.hpp>
#include <memory>

#include "tests/audio_node/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// A card on a hand-moved clock, which a test can pull out.
struct FakeCard : Card {
  struct Plug {
    bool in = true;
    int opened = 0;
  };
  FakeCard(std::shared_ptr<Plug> p, Render r) : plug(std::move(p)), render(std::move(r)) { ++plug->opened; }
  bool alive(sync::HostTime) const override { return plug->in; }
  void play_until(sync::HostTime now) override {
    std::vector<float> block(2 * 128 * 8);
    render(block.data(), 128, {now, sync::Nanoseconds(0), sync::Nanoseconds(0)});
    for (const float x : block) loudest = std::max(loudest, std::abs(x));
    ++blocks;
  }
  std::int64_t callbacks() const override { return blocks; }
  std::int64_t underflows() const override { return 0; }
  const std::string& card() const override { return name; }
  const std::string& medium() const override { return name; }
  std::optional<MediaPair> next_pair() override { return std::nullopt; }

  std::shared_ptr<Plug> plug;
  Render render;
  std::string name = "fake";
  std::int64_t blocks = 0;
  float loudest = 0;
};

sync::HostTime at_block(int n) { return sync::host_time(kStart_ns + std::llround(n * 128e9 / kRate)); }

}  // namespace

TEST_CASE("A card that is pulled out is a lost output, and when it is back the next blow sounds") {
  const auto plug = std::make_shared<FakeCard::Plug>();
  FakeCard* card = nullptr;
  Output output(".", "", 0, [&](const StreamOptions&, Card::Render render) {
    if (!plug->in) throw std::runtime_error("there is no such card");
    auto made = std::make_unique<FakeCard>(plug, std::move(render));
    card = made.get();
    return made;
  });
  output.configure(Settings{});
  int now = 0;
  const auto play = [&](int blocks) {
    for (int i = 0; i < blocks; ++i) output.keep_open(at_block(now++));
  };
  const auto outcome_of = [&](std::int64_t id) {
    while (const auto report = output.next_report())
      if (report->event_id == id) return static_cast<int>(report->outcome);
    return -1;
  };
  play(3);
  CHECK(output.note().find("fake") != std::string::npos);
  output.submit(strike_of(1, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  play(20);
  CHECK(outcome_of(1) == presentation_t::PRESENTED);
  CHECK(card->loudest > 0.01f);
  CHECK(output.note().find("sound dose of this run below 1 % of a day's") != std::string::npos);
  CHECK(output.note().find("turned down") == std::string::npos);
  const std::int64_t played = output.callbacks();
  CHECK(played >= 20);

  output.submit(strike_of(2, 1, 500, 20, sync::to_ns(at_block(now + 500))));  // still waits when the card goes
  play(2);
  plug->in = false;
  CHECK_THROWS_WITH(output.keep_open(at_block(now++)), "there is no such card");
  CHECK(outcome_of(2) == presentation_t::DROPPED_LATE);
  output.submit(strike_of(3, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  CHECK(outcome_of(3) == presentation_t::DROPPED_LATE);  // nothing plays: said at once
  CHECK(output.note().find("has gone") != std::string::npos);

  plug->in = true;
  CHECK(output.keep_open(at_block(now++)) == true);
  CHECK(plug->opened == 2);
  output.submit(strike_of(4, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  play(20);
  CHECK(outcome_of(4) == presentation_t::PRESENTED);
  CHECK(output.callbacks() > played + 15);  // counted over both
}
