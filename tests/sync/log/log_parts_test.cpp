// Tests of logs in several parts: numbers, limits and order.
#include "sync/log/log_parts.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;

TEST_CASE("New log parts are numbered after the existing ones and overwrite none") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "run.2.lcmlog") << "x";
  LogParts parts(folder.path, {});
  for (int i = 0; i < 3; ++i) parts.open();
  CHECK(folder.files() == std::set<std::string>{"run.2.lcmlog", "run.3.lcmlog", "run.4.lcmlog", "run.5.lcmlog"});
  CHECK(std::filesystem::file_size(folder.path / "run.2.lcmlog") == 1);
}

TEST_CASE("Only the newest parts are kept, up to the limit") {
  const TemporaryFolder folder;
  LogLimits limits;
  limits.keep = 2;
  LogParts parts(folder.path, limits);
  for (int i = 1; i <= 5; ++i) {
    parts.open();
    parts.prune(100);
    CHECK(folder.files().size() == static_cast<std::size_t>(std::min(i, 2)));
  }
  CHECK(folder.files() == std::set<std::string>{"run.4.lcmlog", "run.5.lcmlog"});
}

TEST_CASE("All parts together stay within the maximum size, and the current part is kept") {
  const TemporaryFolder folder;
  LogLimits limits;
  limits.max_bytes = 1000;
  LogParts parts(folder.path, limits);
  for (int i = 0; i < 10; ++i) {
    parts.open();
    for (const std::int64_t bytes : {100, 200, 300}) {
      parts.prune(bytes);
      CHECK(parts.bytes_before() + bytes <= 1000);
    }
  }
  parts.prune(5000);
  CHECK(folder.files() == std::set<std::string>{"run.10.lcmlog"});
}

TEST_CASE("Only file names of the recorder are log parts, sorted by number") {
  const TemporaryFolder folder;
  for (const char* name : {"run.10.lcmlog", "run.9.lcmlog", "run.lcmlog", "run.2.lcmlog", "run.1.lcmlog",
                           "run.02.lcmlog", "run.2.lcmlog.part", "run.x.lcmlog", "run.-3.lcmlog",
                           "run.99999999999.lcmlog", "other.lcmlog", "run.3.lcmlogs"})
    std::ofstream(folder.path / name) << "x";
  std::vector<std::string> names;
  for (const std::string& path : log_parts_in(folder.path))
    names.push_back(std::filesystem::path(path).filename());
  CHECK(names == std::vector<std::string>{"run.lcmlog", "run.2.lcmlog", "run.9.lcmlog", "run.10.lcmlog"});
  CHECK(log_parts_in(folder.path / "none").empty());
}
