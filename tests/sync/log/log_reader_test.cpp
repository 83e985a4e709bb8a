// Tests of scanning a log: whole, cut off and damaged.
#include "sync/log/log_reader.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <tuple>

#include "tests/sync/support/memory_sink.h"

using namespace tactus::sync;

namespace {

// 200 events of 0 .. 299 bytes, and the offset of each.
struct Log {
  std::shared_ptr<MemorySink::State> state = std::make_shared<MemorySink::State>();
  std::vector<std::size_t> begins;
  std::vector<std::vector<std::uint8_t>> data;

  explicit Log(unsigned seed) {
    std::mt19937 random(seed);
    LogWriter writer(std::make_unique<MemorySink>(state));
    for (int i = 0; i < 200; ++i) {
      begins.push_back(state->bytes.size());
      std::vector<std::uint8_t> bytes(random() % 300);
      for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
      writer.write(1000 + i, "CHANNEL_" + std::to_string(i % 7), bytes);
      writer.flush();
      data.push_back(std::move(bytes));
    }
  }
};

}  // namespace

TEST_CASE("A log is read as it was written") {
  const Log log(1);
  const auto events = read_all(log.state->bytes);
  REQUIRE(events.size() == 200);
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(events[i].number == static_cast<std::int64_t>(i));
    CHECK(events[i].timestamp_us == 1000 + static_cast<std::int64_t>(i));
    CHECK(events[i].channel == "CHANNEL_" + std::to_string(i % 7));
    CHECK(std::vector<std::uint8_t>(events[i].data.begin(), events[i].data.end()) == log.data[i]);
  }
}

TEST_CASE("An empty log has no events and no damage") {
  LogScanner scanner({});
  LogEvent e;
  CHECK_FALSE(scanner.next(e));
  CHECK(scanner.damaged_regions() == 0);
}

TEST_CASE("All events before the cut of a truncated log are read") {
  const Log log(2);
  const std::span<const std::uint8_t> bytes(log.state->bytes);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 37) {
    const auto whole =
        static_cast<std::size_t>(std::upper_bound(log.begins.begin(), log.begins.end(), cut) - log.begins.begin());
    LogScanner scanner(bytes.first(cut));
    std::size_t found = 0;
    for (LogEvent e; scanner.next(e);) ++found;
    // The last event that begins before the cut is whole only when the cut lies at the beginning of the next event.
    const std::size_t expected = cut == 0 ? 0 : whole - 1;  // the last event that begins before the cut is not whole
    CHECK(found == expected);
    CHECK(scanner.damaged_regions() == (cut == 0 || log.begins[whole - 1] == cut ? 0 : 1));
  }
}

TEST_CASE("Every event outside a damaged region is found") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Log log(seed);
    auto& bytes = log.state->bytes;
    std::mt19937 random(seed + 1000);
    const std::size_t from = random() % (bytes.size() - 500), until = from + 1 + random() % 400;
    const int kind = static_cast<int>(random() % 3);
    for (std::size_t i = from; i < until; ++i)
      bytes[i] = kind == 0 ? 0 : kind == 1 ? 0xff : static_cast<std::uint8_t>(random());

    std::set<std::int64_t> intact, found;
    for (std::size_t i = 0; i < log.begins.size(); ++i) {
      const std::size_t end = i + 1 < log.begins.size() ? log.begins[i + 1] : bytes.size();
      if (end <= from || log.begins[i] >= until) intact.insert(static_cast<std::int64_t>(i));
    }
    for (const LogEvent& e : read_all(bytes)) found.insert(e.number);
    CHECK(std::includes(found.begin(), found.end(), intact.begin(), intact.end()));
  }
}

TEST_CASE("A wrong length field does not hide the following events") {
  Log log(3);
  auto& bytes = log.state->bytes;
  bytes[log.begins[50] + 26] = 0x20;  // length field of event 50: 8 kB more than the data
  const auto events = read_all(bytes);
  CHECK(events.size() == 199);
  CHECK(events[50].number == 51);
}

TEST_CASE("Random bytes are scanned to their end") {
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> bytes(random() % 2000);
    for (auto& b : bytes) b = std::vector<std::uint8_t>{0xED, 0xA1, 0xDA, 0x01, 0x00}[random() % 5];
    LogScanner scanner(bytes);
    std::int64_t read = 0;
    for (LogEvent e; scanner.next(e);) read += static_cast<std::int64_t>(28 + e.channel.size() + e.data.size());
    CHECK(read + scanner.damaged_bytes() == static_cast<std::int64_t>(bytes.size()));
  }
}

TEST_CASE("Padding between two log parts is not damage, other data there is") {
  const Log log(7);
  const auto part = log.state->bytes;
  const std::size_t border = (part.size() + kLogPartBytes - 1) / kLogPartBytes * kLogPartBytes;
  std::vector<std::uint8_t> two = part;
  two.resize(border);
  two.insert(two.end(), part.begin(), part.end());
  const auto read = [](const std::vector<std::uint8_t>& bytes) {
    LogScanner scanner(bytes);
    for (LogEvent e; scanner.next(e);) continue;
    return std::tuple(scanner.events(), scanner.damaged_regions(), scanner.damaged_bytes());
  };
  const auto between = static_cast<std::int64_t>(border - part.size());
  CHECK(read(two) == std::tuple<std::int64_t, std::int64_t, std::int64_t>(400, 0, 0));
  auto stain = two;
  stain[part.size() + 100] = 1;
  CHECK(read(stain) == std::tuple<std::int64_t, std::int64_t, std::int64_t>(400, 1, between));
  auto longer = two;
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(border), 16, 0);
  CHECK(read(longer) == std::tuple<std::int64_t, std::int64_t, std::int64_t>(400, 1, between + 16));
  // A machine that lost power leaves a tail of zeros.
  auto tail = part;
  tail.resize(border);
  CHECK(read(tail) == std::tuple<std::int64_t, std::int64_t, std::int64_t>(200, 1, between));
}
