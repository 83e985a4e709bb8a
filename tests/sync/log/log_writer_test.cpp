// Tests of writing a log.
#include "sync/log/log_writer.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "tests/sync/support/memory_sink.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;

namespace {

const std::vector<std::uint8_t> kData(100, 42);

}  // namespace

TEST_CASE("Time stamps in a log never decrease") {
  const auto state = std::make_shared<MemorySink::State>();
  LogWriter writer(std::make_unique<MemorySink>(state));
  for (int us : {5, 7, 6, 7, 9}) writer.write(us, "A", kData);
  writer.flush();
  std::vector<std::int64_t> stamps;
  for (const LogEvent& e : read_all(state->bytes)) stamps.push_back(e.timestamp_us);
  CHECK(stamps == std::vector<std::int64_t>{5, 7, 7, 7, 9});
}

TEST_CASE("Events wait up to a limit while the disk is full, further ones are counted as lost") {
  const auto state = std::make_shared<MemorySink::State>();
  LogWriter writer(std::make_unique<MemorySink>(state), 10 * (28 + 1 + kData.size()));
  writer.write(1, "A", kData);
  writer.flush();
  state->trouble = "No space left on device";
  for (int i = 0; i < 25; ++i) {
    writer.write(2 + i, "A", kData);
    writer.flush();
  }
  CHECK(writer.error() == "No space left on device");
  CHECK(writer.lost() == 15);
  CHECK(read_all(state->bytes).size() == 1);

  state->trouble.clear();
  writer.flush();
  writer.write(100, "A", kData);
  writer.flush();
  CHECK(writer.error().empty());
  const auto events = read_all(state->bytes);
  REQUIRE(events.size() == 12);
  CHECK(events.back().number == 11);
  CHECK(writer.events() == 12);
}

TEST_CASE("lcm::LogFile reads a log of LogWriter") {
  TemporaryFolder folder;
  const std::string path = folder.path / "run.lcmlog";
  {
    LogWriter writer(std::make_unique<FileSink>(path));
    for (int i = 0; i < 1000; ++i) {
      writer.write(10 * i, "SOME_CHANNEL", kData);
      if (i % 100 == 0) writer.flush();
    }
    writer.flush();
  }
  lcm::LogFile log(path, "r");
  REQUIRE(log.good());
  for (int i = 0; i < 1000; ++i) {
    const lcm::LogEvent* e = log.readNextEvent();
    REQUIRE(e != nullptr);
    CHECK(e->eventnum == i);
    CHECK(e->timestamp == 10 * i);
    CHECK(e->channel == "SOME_CHANNEL");
    CHECK(e->datalen == 100);
  }
  CHECK(log.readNextEvent() == nullptr);
}

TEST_CASE("An existing file is not overwritten") {
  TemporaryFolder folder;
  std::ofstream(folder.path / "run.lcmlog") << "x";
  CHECK_THROWS_WITH(FileSink((folder.path / "run.lcmlog").string()), Catch::Contains("run.lcmlog"));
}
