// Tests of memory-mapped logs, also while they grow.
#include "sync/log/mapped_log.h"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "sync/log/log_parts.h"
#include "sync/log/log_reader.h"
#include "sync/log/log_writer.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;

TEST_CASE("The error for an unreadable log names its path") {
  CHECK_THROWS_WITH(MappedLog("/nowhere/run.lcmlog"), Catch::Contains("/nowhere/run.lcmlog"));
  CHECK_THROWS_WITH(MappedLog("/proc/self"), Catch::Contains("/proc/self") && Catch::Contains("no run.lcmlog"));
}

TEST_CASE("A log that is truncated while it is read ends the program with an error message") {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / ("cut_" + std::to_string(getpid()));
  std::ofstream(path) << std::string(1 << 20, 'x');
  int output_pipe[2];
  REQUIRE(pipe(output_pipe) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(output_pipe[1], STDERR_FILENO);
    const MappedLog file(path);
    std::filesystem::resize_file(path, 100);
    std::int64_t sum = 0;
    for (const std::uint8_t byte : file.bytes()) sum += byte;
    _exit(sum == 0 ? 42 : 43);
  }
  close(output_pipe[1]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  char text[256] = {};
  CHECK(read(output_pipe[0], text, sizeof text - 1) > 0);
  close(output_pipe[0]);
  std::filesystem::remove(path);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  CHECK_THAT(text, Catch::Contains("truncated the log while it was read"));
}

TEST_CASE("A folder is read as one log of all its parts, sorted by number") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const TemporaryFolder folder;
    LogParts parts(folder.path, {});
    const int count = 1 + static_cast<int>(random() % 12);  // run.10 sorts after run.9
    int written = 0;
    for (int part = 0; part < count; ++part) {
      LogWriter writer(parts.open());
      // One part may be empty so far, and one may fill its space exactly.
      for (unsigned n = random() % 4 * 10; n > 0; --n, ++written)
        writer.write(1000 + written, "NUMBERED",
                     std::vector<std::uint8_t>(random() % 9000, static_cast<std::uint8_t>(written)));
      writer.flush();
    }
    const MappedLog log(folder.path);
    LogScanner scanner(log.bytes());
    int read = 0;
    bool in_order = true;
    for (LogEvent e; scanner.next(e); ++read) in_order &= e.timestamp_us == 1000 + read;
    INFO("seed " << seed);
    CHECK(read == written);
    CHECK(in_order);
    CHECK(scanner.damaged_regions() == 0);
  }
}

TEST_CASE("A full part is followed by the next part without padding") {
  const TemporaryFolder folder;
  LogParts parts(folder.path, {});
  for (int part = 0; part < 2; ++part) {
    LogWriter writer(parts.open());
    writer.write(part, "A", std::vector<std::uint8_t>(kLogPartBytes - kLogEventHeaderBytes - 1));
    writer.flush();
  }
  const MappedLog log(folder.path);
  CHECK(log.bytes().size() == 2 * kLogPartBytes);
  LogScanner scanner(log.bytes());
  int read = 0;
  for (LogEvent e; scanner.next(e);) ++read;
  CHECK(read == 2);
}
