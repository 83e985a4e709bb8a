#include "audio_node/mixer/recording_player.h"

#include <catch2/catch.hpp>
#include <memory>
#include <thread>

#include "audio_node/mixer/library.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/sounds.h"

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

TEST_CASE("A database is kept while a strike of it waits or sounds, and is then released") {
  const Recording r{tone(300, 0.1), 0.5f, 0.35f};
  auto bench = std::make_unique<Bench>();
  RecordedQueues& queues = bench->queues.recorded;
  REQUIRE(queues.databases.push(1));
  bench->play(64);
  CHECK(queues.oldest_held == 1);
  REQUIRE(bench->queues.strikes.push(strike_with(r, 1, kStart_ns + 20'000'000)));
  REQUIRE(queues.databases.push(2));
  bench->play(64);
  CHECK(queues.oldest_held == 1);  // it waits
  bench->play(2400);
  CHECK(queues.oldest_held == 1);  // it sounds
  bench->play(4800);
  CHECK(queues.oldest_held == 2);
}

TEST_CASE("A database is kept while a contact scrapes with it, and later updates of an older database are ignored") {
  Layers l;
  l.by_speed.push_back({1, 1, {{tone(400, 0.5), 0.5f, 0.35f}}});
  auto bench = std::make_unique<Bench>();
  RecordedQueues& queues = bench->queues.recorded;
  REQUIRE(queues.databases.push(1));
  RecordedContact contact;
  contact.contact = 3, contact.database = 1, contact.layers = &l, contact.speed_m_s = 1, contact.level = 0.1f;
  contact.at = sync::host_time(kStart_ns);
  REQUIRE(queues.contacts.push(contact));
  bench->play(480);
  CHECK(bench->renderer.recorded() == 1);
  contact.at = sync::host_time(kStart_ns + 1'000'000'000);  // still in the queue when the next database arrives
  REQUIRE(queues.contacts.push(contact));
  REQUIRE(queues.databases.push(2));
  bench->play(480);
  CHECK(queues.oldest_held == 1);
  for (int i = 0; i < 30; ++i) bench->play(480);
  CHECK(bench->renderer.recorded() == 0);
  CHECK(queues.oldest_held == 2);
}

TEST_CASE("A renderer that ends releases all databases") {
  const Recording r{tone(300, 1), 0.5f, 0.35f};
  auto bench = std::make_unique<Bench>();
  RecordedQueues& queues = bench->queues.recorded;
  REQUIRE(queues.databases.push(1));
  REQUIRE(bench->queues.strikes.push(strike_with(r, 1, kStart_ns)));
  bench->play(480);
  REQUIRE(queues.databases.push(2));
  REQUIRE(bench->queues.strikes.push(strike_with(r, 1, kStart_ns + 500'000'000)));
  bench->renderer.abandon();
  CHECK(queues.oldest_held == 2);
  CHECK(bench->renderer.recorded() == 0);
}

TEST_CASE("The library reads the selected recordings once and returns released databases") {
  const SoundFolder one, two;
  one.write("oak/impact/1.wav", tone(300, 0.1));
  two.write("steel/impact/1.wav", tone(300, 0.1));
  RecordedQueues queues;
  RecordingPlayer callback(queues, 48000);
  const Scheduler none(1);
  Library library(queues);
  Settings settings;
  settings.sounds = one.path();
  library.configure(settings);
  CHECK(library.step().empty());
  CHECK_FALSE(library.database());  // the modal method reads nothing
  const auto read = [&](std::int64_t number) {
    std::vector<Library::Shared> released;
    for (int i = 0; i < 10000 && library.number() < number; ++i) {
      for (auto& gone : library.step()) released.push_back(gone);
      std::this_thread::yield();
    }
    return released;
  };
  settings.method = "samples";
  library.configure(settings);
  for (std::int64_t spins = 0; library.number() < 1 && spins < 200'000'000; ++spins) read(1);
  REQUIRE(library.database());
  CHECK(library.database()->find("oak", "oak", Interaction::kImpact).any());
  CHECK(library.take_messages().size() == 1);
  CHECK(library.take_messages().empty());
  callback.receive_databases();
  callback.release(none);
  settings.sounds = two.path();
  library.configure(settings);
  for (std::int64_t spins = 0; library.number() < 2 && spins < 200'000'000; ++spins) read(2);
  CHECK(library.database()->find("steel", "steel", Interaction::kImpact).any());
  CHECK(library.step().empty());  // the callback has not been notified yet
  callback.receive_databases();
  callback.release(none);
  CHECK(library.step().size() == 1);
}

namespace {

// A library and a manually called callback, with one folder of recordings, or two in alternation.
struct LibraryFixture {
  SoundFolder one, two;
  RecordedQueues queues;
  RecordingPlayer callback{queues, 48000};
  Scheduler none{1};
  Library library{queues};
  std::size_t released_count = 0;
  LibraryFixture() {
    one.write("oak/impact/1.wav", tone(300, 0.1));
    two.write("oak/impact/1.wav", tone(300, 0.1));
  }
  // Until everything has been read.
  void read(bool has_callback = true) {
    for (std::int64_t spins = 0; library.reading() && spins < 2'000'000'000; ++spins) {
      released_count += library.step(has_callback).size();
      std::this_thread::yield();
    }
    REQUIRE_FALSE(library.reading());
    released_count += library.step(has_callback).size();
  }
  void select(const std::string& method, const SoundFolder& folder) {
    Settings settings;
    settings.method = method, settings.sounds = folder.path();
    library.configure(settings);
  }
  void run_callback() {
    callback.receive_databases();
    callback.release(none);
  }
};

}  // namespace

TEST_CASE("Recordings are released when contacts are computed again, and read again on request") {
  LibraryFixture l;
  l.select("samples", l.one);
  l.read();
  l.run_callback();
  REQUIRE(l.library.database());
  l.select("modal", l.one);
  CHECK(l.library.step().empty());  // the callback may still play them
  CHECK_FALSE(l.library.database());
  l.run_callback();
  CHECK(l.library.step().size() == 1);
  l.select("both", l.one);
  l.read();
  CHECK(l.library.database());

  SECTION("recordings that are still being read are released too") {
    l.select("both", l.two);
    l.released_count += l.library.step().size();  // the thread may already have read them
    l.select("modal", l.two);
    for (std::int64_t spins = 0; l.library.reading() && spins < 2'000'000'000; ++spins) {
      l.released_count += l.library.step().size();
      l.run_callback();
    }
    for (int rounds = 0; rounds < 3; ++rounds) l.run_callback(), l.released_count += l.library.step().size();
    CHECK_FALSE(l.library.database());
    CHECK(l.released_count == 2);
  }
}

TEST_CASE("Without a card replaced recordings are released at once") {
  LibraryFixture l;
  for (std::size_t i = 0; i < 40; ++i) {
    l.select("samples", i % 2 ? l.two : l.one);
    l.read(false);
    REQUIRE(l.library.database());
    CHECK(l.released_count == i);
  }
  // A later callback plays the newest.
  RecordingPlayer callback(l.queues, 48000);
  callback.receive_databases();
  callback.release(l.none);
  l.select("modal", l.one);
  l.library.step();
  callback.receive_databases();
  callback.release(l.none);
  CHECK(l.library.step().size() == 1);
}

TEST_CASE("A stopped callback makes at most four databases wait") {
  LibraryFixture l;
  for (std::size_t i = 0; i < 20; ++i) {
    l.select("samples", i % 2 ? l.two : l.one);
    l.read();
  }
  // Two that it might play, one that is announced, one that is next.
  CHECK(l.released_count == 16);
  CHECK(l.library.number() == 3);
  l.run_callback();
  CHECK(l.library.step().size() == 2);
  l.library.step();
  CHECK(l.library.number() == 4);
}
