#include "audio_node/samples/recorded.h"

#include <catch2/catch.hpp>
#include <memory>
#include <thread>

#include "audio_node/samples/library.h"
#include "tests/audio_node/bench.h"
#include "tests/audio_node/samples/sounds.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

Strike strike_with(const Recording& r, std::int64_t database, std::int64_t at_ns) {
  Strike s;
  s.event_id = 1;
  s.scheduled = sync::host_time(at_ns);
  s.recorded.database = database;
  s.recorded.shots[0] = {&r, 0.1f, 1};
  return s;
}

}  // namespace

TEST_CASE("A database is kept while a strike of it waits or sounds, and let go of when none does any more") {
  const Recording r{tone(300, 0.1), 0.5f, 0.35f};
  auto bench = std::make_unique<Bench>();
  RecordedCrossing& crossing = bench->crossing.recorded;
  REQUIRE(crossing.databases.push(1));
  bench->play(64);
  CHECK(crossing.let_go == 1);
  REQUIRE(bench->crossing.strikes.push(strike_with(r, 1, kStart_ns + 20'000'000)));
  REQUIRE(crossing.databases.push(2));
  bench->play(64);
  CHECK(crossing.let_go == 1);  // it waits
  bench->play(2400);
  CHECK(crossing.let_go == 1);  // it sounds
  bench->play(4800);
  CHECK(crossing.let_go == 2);
}

TEST_CASE(
    "A database is kept while a contact scrapes with it; one that is told later of the old one is not heard") {
  Layers l;
  l.by_speed.push_back({1, 1, {{tone(400, 0.5), 0.5f, 0.35f}}});
  auto bench = std::make_unique<Bench>();
  RecordedCrossing& crossing = bench->crossing.recorded;
  REQUIRE(crossing.databases.push(1));
  Rub rub;
  rub.contact = 3, rub.database = 1, rub.layers = &l, rub.speed_m_s = 1, rub.level = 0.1f;
  rub.at = sync::host_time(kStart_ns);
  REQUIRE(crossing.rubs.push(rub));
  bench->play(480);
  CHECK(bench->renderer.recorded() == 1);
  rub.at = sync::host_time(kStart_ns + 1'000'000'000);  // still in the queue when the next database comes
  REQUIRE(crossing.rubs.push(rub));
  REQUIRE(crossing.databases.push(2));
  bench->play(480);
  CHECK(crossing.let_go == 1);
  for (int i = 0; i < 30; ++i) bench->play(480);
  CHECK(bench->renderer.recorded() == 0);
  CHECK(crossing.let_go == 2);
}

TEST_CASE("A renderer that ends lets go of all") {
  const Recording r{tone(300, 1), 0.5f, 0.35f};
  auto bench = std::make_unique<Bench>();
  RecordedCrossing& crossing = bench->crossing.recorded;
  REQUIRE(crossing.databases.push(1));
  REQUIRE(bench->crossing.strikes.push(strike_with(r, 1, kStart_ns)));
  bench->play(480);
  REQUIRE(crossing.databases.push(2));
  REQUIRE(bench->crossing.strikes.push(strike_with(r, 1, kStart_ns + 500'000'000)));
  bench->renderer.abandon();
  CHECK(crossing.let_go == 2);
  CHECK(bench->renderer.recorded() == 0);
}

TEST_CASE("The library reads what the settings ask for, once, and gives back what nobody plays any more") {
  const SoundFolder one, two;
  one.write("oak/impact/1.wav", tone(300, 0.1));
  two.write("steel/impact/1.wav", tone(300, 0.1));
  RecordedCrossing crossing;
  Recorded callback(crossing, 48000);
  const Scheduler none(1);
  Library library(crossing);
  Settings settings;
  settings.sounds = one.path();
  library.configure(settings);
  CHECK(library.step().empty());
  CHECK_FALSE(library.database());  // by modes alone nothing is read
  const auto read = [&](std::int64_t number) {
    std::vector<Library::Shared> unread;
    for (int i = 0; i < 10000 && library.number() < number; ++i) {
      for (auto& gone : library.step()) unread.push_back(gone);
      std::this_thread::yield();
    }
    return unread;
  };
  settings.method = "samples";
  library.configure(settings);
  for (std::int64_t spins = 0; library.number() < 1 && spins < 200'000'000; ++spins) read(1);
  REQUIRE(library.database());
  CHECK(library.database()->find("oak", "oak", Interaction::kImpact).any());
  CHECK(library.news().size() == 1);
  CHECK(library.news().empty());
  callback.take_databases();
  callback.let_go(none);
  settings.sounds = two.path();
  library.configure(settings);
  for (std::int64_t spins = 0; library.number() < 2 && spins < 200'000'000; ++spins) read(2);
  CHECK(library.database()->find("steel", "steel", Interaction::kImpact).any());
  CHECK(library.step().empty());  // the callback has not been told yet
  callback.take_databases();
  callback.let_go(none);
  CHECK(library.step().size() == 1);
}
