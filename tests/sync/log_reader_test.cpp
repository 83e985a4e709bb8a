#include "sync/log_reader.h"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "tests/sync/memory_sink.h"

using namespace tactus::sync;

namespace {

// 200 events of 0 .. 299 bytes; where each begins.
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

TEST_CASE("A log that is cut off anywhere yields every event before the cut") {
  const Log log(2);
  const std::span<const std::uint8_t> bytes(log.state->bytes);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 37) {
    const auto whole =
        static_cast<std::size_t>(std::upper_bound(log.begins.begin(), log.begins.end(), cut) - log.begins.begin());
    LogScanner scanner(bytes.first(cut));
    std::size_t found = 0;
    for (LogEvent e; scanner.next(e);) ++found;
    // The last of those that begin before the cut is whole only when the cut lies at the beginning of the next.
    const std::size_t expected = cut == 0 ? 0 : whole - 1;  // the last one that begins before the cut is not whole
    CHECK(found == expected);
    CHECK(scanner.damaged_regions() == (cut == 0 || log.begins[whole - 1] == cut ? 0 : 1));
  }
}

TEST_CASE("Every event outside of a damaged region is found, whatever lies in the region") {
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

TEST_CASE("A length that lies does not swallow the events behind it") {
  Log log(3);
  auto& bytes = log.state->bytes;
  bytes[log.begins[50] + 26] = 0x20;  // data of event 50: 8 kB more than there are
  const auto events = read_all(bytes);
  CHECK(events.size() == 199);
  CHECK(events[50].number == 51);
}

TEST_CASE("Any bytes at all are read to their end") {
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

TEST_CASE("A log that cannot be read is refused with its name") {
  CHECK_THROWS_WITH(MappedFile("/nowhere/run.lcmlog"), Catch::Contains("/nowhere/run.lcmlog"));
  CHECK_THROWS_WITH(MappedFile("/tmp"), Catch::Contains("directory"));
}

TEST_CASE("A log that is cut while it is read ends its reader with one sentence, and not by a signal") {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / ("cut_" + std::to_string(getpid()));
  std::ofstream(path) << std::string(1 << 20, 'x');
  int said[2];
  REQUIRE(pipe(said) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(said[1], STDERR_FILENO);
    const MappedFile file(path);
    std::filesystem::resize_file(path, 100);
    std::int64_t sum = 0;
    for (const std::uint8_t byte : file.bytes()) sum += byte;
    _exit(sum == 0 ? 42 : 43);
  }
  close(said[1]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  char text[256] = {};
  CHECK(read(said[0], text, sizeof text - 1) > 0);
  close(said[0]);
  std::filesystem::remove(path);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  CHECK_THAT(text, Catch::Contains("cut while it was read"));
}
