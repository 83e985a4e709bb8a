#include "audio_node/devices/output.h"

#include <catch2/catch.hpp>
#include <memory>
#include <optional>
#include <tactus/presentation_t.hpp>
#include <tuple>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// A card on a manual clock, which a test can unplug.
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
  std::string recording_fault() const override { return fault; }

  std::shared_ptr<Plug> plug;
  Render render;
  std::string name = "fake", fault;
  std::int64_t blocks = 0;
  float loudest = 0;
};

// A card that requests one period at a time, at its presentation: updates sent ahead wait longest.
struct SlowCard : FakeCard {
  SlowCard(Render r, const StreamOptions& o)
      : FakeCard(std::make_shared<Plug>(), std::move(r)),
        options(o),
        out(2 * static_cast<std::size_t>(o.period_frames)) {}
  void play_until(sync::HostTime now) override {
    if (now < next) return;
    render(out.data(), options.period_frames, {now, sync::Nanoseconds(0), sync::Nanoseconds(0)});
    next = now + sync::from_seconds(static_cast<double>(options.period_frames) / options.rate_Hz);
  }
  StreamOptions options;
  std::vector<float> out;
  sync::HostTime next{};
};

// Status text after ten seconds in which all audible contacts begin and end at every update.
std::string status_after_updates(const Settings& settings, std::optional<sync::Nanoseconds> every = {}) {
  constexpr sync::Nanoseconds kLead{2'000'000};
  Output output(".", "", 0, [](const StreamOptions& options, Card::Render render) {
    return std::make_unique<SlowCard>(std::move(render), options);
  });
  output.configure(settings);
  sync::HostTime last_update{};
  for (std::int64_t ms = 0; ms < 10'000; ++ms) {
    const sync::HostTime now = sync::host_time(kStart_ns + 1'000'000 * ms);
    output.keep_open(now);
    if (now - last_update < every.value_or(output.update_interval(kLead))) continue;
    last_update = now;
    Scrape scrape;
    RecordedContact contact;
    scrape.at = contact.at = now + output.latency() + kLead;
    for (int i = 0; i < 2 * Scrapes::kMax; ++i) output.submit(scrape);
    for (int i = 0; i < 2 * Loops::kMax; ++i) output.submit(contact);
  }
  return output.status_text();
}

sync::HostTime at_block(int n) { return sync::host_time(kStart_ns + std::llround(n * 128e9 / kRate)); }

}  // namespace

TEST_CASE("A sound file that the disk refuses is reported once as a change of state, and stays in the status") {
  FakeCard* card = nullptr;
  Output output(".", "", 0, [&](const StreamOptions&, Card::Render render) {
    auto made = std::make_unique<FakeCard>(std::make_shared<FakeCard::Plug>(), std::move(render));
    card = made.get();
    return made;
  });
  output.configure(Settings{});
  output.keep_open(at_block(0));
  CHECK(output.take_status_change() == "plays on fake into fake");
  card->fault = "the disk refuses the sound (File too large): fake ends after 1.0 s";
  CHECK(output.take_status_change() == "plays on fake into fake; " + card->fault);
  CHECK_FALSE(output.take_status_change());
  CHECK(output.status_text().find("; " + card->fault) != std::string::npos);
}

TEST_CASE("An unplugged card is reported as lost, and hits sound again after its return") {
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
  CHECK(output.status_text().find("fake") != std::string::npos);
  output.submit(strike_of(1, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  play(20);
  CHECK(outcome_of(1) == presentation_t::PRESENTED);
  CHECK(card->loudest > 0.01f);
  CHECK(output.status_text().find("sound dose of this run below 1 % of a day's") != std::string::npos);
  CHECK(output.status_text().find("to limit the level") == std::string::npos);
  const std::int64_t played = output.callbacks();
  CHECK(played >= 20);

  output.submit(strike_of(2, 1, 500, 20, sync::to_ns(at_block(now + 500))));  // still waits when the card is lost
  play(2);
  plug->in = false;
  CHECK_THROWS_WITH(output.keep_open(at_block(now++)), "there is no such card");
  CHECK(outcome_of(2) == presentation_t::DROPPED_LATE);
  output.submit(strike_of(3, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  CHECK(outcome_of(3) == presentation_t::DROPPED_LATE);  // nothing plays: reported at once
  CHECK(output.status_text().find("is lost") != std::string::npos);

  plug->in = true;
  CHECK(output.keep_open(at_block(now++)) == true);
  CHECK(plug->opened == 2);
  output.submit(strike_of(4, 1, 500, 20, sync::to_ns(at_block(now + 5))));
  play(20);
  CHECK(outcome_of(4) == presentation_t::PRESENTED);
  CHECK(output.callbacks() > played + 15);  // counted over both
}

TEST_CASE("No contact update is lost on the way to the callback, for any period of the card") {
  Settings settings;
  settings.spatial = "stereo";
  for (const auto& [rate_Hz, period_frames, latency_periods] : {std::tuple{48000., 128, 2.},
                                                                {48000., 4096, 2.},
                                                                {48000., 4096, 8.},
                                                                {8000., 4096, 8.},
                                                                {48000., 1024, 4.}}) {
    settings.sample_rate_Hz = rate_Hz, settings.period_frames = period_frames;
    settings.latency_periods = latency_periods;
    CAPTURE(rate_Hz, period_frames, latency_periods);
    CHECK_THAT(status_after_updates(settings), !Catch::Contains("lost"));
  }
  // When they are sent every tick all the same, the health shows the losses.
  settings.sample_rate_Hz = 48000, settings.period_frames = 4096;
  CHECK_THAT(status_after_updates(settings, sync::Nanoseconds(0)), Catch::Contains(" contact updates lost"));
}

TEST_CASE("Reports that do not fit into the queue are counted") {
  Output output(".", "", 0, [](const StreamOptions&, Card::Render) -> std::unique_ptr<Card> { return {}; });
  for (std::int64_t id = 0; id < 1030; ++id) output.drop(id, {});
  CHECK_THAT(output.status_text(), Catch::Contains("6 reports of hits lost"));
  std::int64_t taken = 0;
  while (output.next_report()) ++taken;
  CHECK(taken == 1024);
}
