// Tests of reading and replaying damaged logs.
#include "sync/bus/bus.h"
#include "tests/sync/support/damaged_log.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <tactus/node_health_t.hpp>

#include "sync/log/log_feed.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

struct TemporaryFile {
  std::string path = "/tmp/tactus_damaged_" + std::to_string(getpid()) + ".lcmlog";
  ~TemporaryFile() { std::filesystem::remove(path); }
  void write(const std::vector<std::uint8_t>& bytes) const {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
};

// Events of `whole` that the scanner does not return with the same bytes.
std::set<std::int64_t> missed(const DamagedLog& log) {
  std::set<std::int64_t> missing = log.whole;
  for (const LogEvent& e : read_all(log.bytes)) {
    if (!missing.contains(e.number)) continue;
    const auto& data = log.data[static_cast<std::size_t>(e.number)];
    if (std::equal(e.data.begin(), e.data.end(), data.begin(), data.end())) missing.erase(e.number);
  }
  return missing;
}

}  // namespace

TEST_CASE("Every undamaged event is found in 1,000 logs with flipped bits, cuts and garbage") {
  const DamagedLog sound(120);
  std::size_t touched = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    DamagedLog log = sound;
    log.damage(random);
    touched += sound.whole.size() - log.whole.size();
    INFO("seed " << seed);
    CHECK(missed(log).empty());
  }
  CHECK(touched > 1000);
}

TEST_CASE("A damaged log is rendered to its end, with its undamaged messages") {
  const TemporaryFile file;
  const DamagedLog sound(120);
  int refused = 0;
  std::size_t missed_in_all = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    DamagedLog log = sound;
    log.damage(random);
    file.write(log.bytes);
    INFO("seed " << seed);
    log.whole.erase(0);  // LOG_INFO
    try {
      LogFeed feed(file.path, 100);
      CHECK(feed.run_id() == DamagedLog::kRun);
      CHECK(feed.clock() == 4711);
      Bus bus(Identity::fresh("listener", feed.run_id()), feed.bus());
      auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 256);
      std::set<std::int64_t> missing = log.whole;
      for (int tick = 0; tick < 10'000 && !feed.over(Nanoseconds(20'000'000)); ++tick) {
        feed.next(bus);
        while (const auto m = healths.pop()) missing.erase(m->message.header.seq);
      }
      CHECK(feed.over(Nanoseconds(20'000'000)));
      // Sequence numbers and send times are damaged, too. A wrong value is discarded after kMaxContradictions messages that
      // contradict it (sync/bus/sequence.h). A log is damaged in up to eight places.
      CHECK(missing.size() <= 8 * SequenceTracker::kMaxContradictions);
      missed_in_all += missing.size();
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  CHECK(refused == 0);
  CHECK(missed_in_all < 1000);  // out of about 110,000
}

TEST_CASE("Run and clock of a log without a valid LOG_INFO are recovered from its messages") {
  const TemporaryFile file;
  DamagedLog log(120);
  std::size_t end = 0;
  while (log.owner[end] == 0) ++end;
  SECTION("LOG_INFO is missing") {
    log.bytes.erase(log.bytes.begin(), log.bytes.begin() + static_cast<std::ptrdiff_t>(end));
  }
  SECTION("LOG_INFO is unreadable") { log.bytes[end - 30] ^= 0x40, log.bytes[40] ^= 0xff; }
  SECTION("LOG_INFO has a wrong offset") {
    for (std::size_t i = 28; i + 8 < end; ++i) {
      std::int64_t value = 0;
      for (std::size_t b = 0; b < 8; ++b) value = value << 8 | log.bytes[i + b];
      if (value == DamagedLog::kOffset_ns) log.bytes[i + 2] ^= 0x10;
    }
  }
  file.write(log.bytes);
  const LogFeed feed(file.path, 1000);
  CHECK(feed.run_id() == DamagedLog::kRun);
  CHECK(feed.clock() == 4711);
  CHECK(feed.recovered().find("LOG_INFO") != std::string::npos);
  // Every message arrives 50 us after it was sent, and the stamps are cut to 1 us.
  CHECK(std::abs(to_ns(feed.end()) - (DamagedLog::kBegin_ns + 119'000'000 - 50'000)) <= 1000);
}

TEST_CASE("An undamaged log needs no recovery") {
  const TemporaryFile file;
  file.write(DamagedLog(120).bytes);
  CHECK(LogFeed(file.path, 1000).recovered().empty());
}

TEST_CASE("Empty logs, noise and logs of other systems are rejected with one sentence") {
  const TemporaryFile file;
  file.write({});
  CHECK_THROWS_WITH(LogFeed(file.path, 1000), Catch::Contains("not an LCM log"));
  std::vector<std::uint8_t> noise(100'000);
  std::mt19937 random(5);
  for (auto& b : noise) b = static_cast<std::uint8_t>(random());
  file.write(noise);
  CHECK_THROWS_WITH(LogFeed(file.path, 1000), Catch::Contains("not an LCM log"));
  const auto state = std::make_shared<MemorySink::State>();
  LogWriter writer(std::make_unique<MemorySink>(state));
  for (int i = 0; i < 100; ++i)
    writer.write(i, "POSE", std::vector<std::uint8_t>(60, static_cast<std::uint8_t>(0xf0 + i % 8)));
  writer.flush();
  file.write(state->bytes);
  CHECK_THROWS_WITH(LogFeed(file.path, 1000), Catch::Contains("no message of Tactus"));
}
