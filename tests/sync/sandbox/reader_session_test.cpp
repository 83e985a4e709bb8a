#include "sync/sandbox/reader_session.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <stdexcept>

using namespace tactus::sync;

namespace {

// Programs of the system as readers.
struct SystemPrograms {
  SystemPrograms() { setenv("TACTUS_BIN", "/bin", 1); }
  ~SystemPrograms() { unsetenv("TACTUS_BIN"); }
};

std::string why(ReaderSession& session, std::size_t bytes = 10) {
  try {
    session.request(std::vector<std::uint8_t>(bytes));
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

std::string why(const std::string& script, std::size_t bytes = 10, const ReaderLimits& limits = {}) {
  ReaderSession session("sh", {"-c", script}, limits);
  return why(session, bytes);
}

// An empty record 'R'.
const std::string kAnswer = R"(R\000\000\000\000\000\000\000\000)";

}  // namespace

TEST_CASE("A reader that ends badly costs one file, and few of them end the session") {
  const SystemPrograms programs;
  ReaderSession session("sh", {"-c", "kill -SEGV $$"});
  CHECK(session.started() == 0);
  for (int i = 1; i <= ReaderSession::kMaxFailures; ++i) {
    CHECK_THAT(why(session), Catch::StartsWith("its reader crashed (Segmentation fault)"));
    CHECK(session.started() == i);
  }
  for (int i = 0; i < 100; ++i) CHECK_THAT(why(session), Catch::StartsWith("it is left out, because 4 files"));
  CHECK(session.started() == ReaderSession::kMaxFailures);
}

TEST_CASE("A session with a hostile reader is one clause: too early, too much, twice, never, or without an end") {
  const SystemPrograms programs;
  CHECK(why("exit 0") == "its reader ended too early: the file is damaged or hostile; export it again");
  CHECK(why("exit 3") == "its reader failed: the file is damaged or hostile; export it again");
  // A record of 4 GiB.
  CHECK(why(R"(printf 'R\000\000\000\000\001\000\000\000'; cat /dev/zero)", 10, {.max_bytes = 1 << 20}) == "it has more than 1 MiB of content: simplify it");
  CHECK(why("head -c 18 >/dev/null; printf '" + kAnswer + "'; cat >/dev/null") == "");
  CHECK(why("head -c 18 >/dev/null; printf '" + kAnswer + kAnswer + "'") == "its reader returned another answer than one to its file");
  // Larger than the buffers of the connection, so that the answer precedes the end of the request.
  CHECK(why("printf '" + kAnswer + "'; exec sleep 1000", 4 << 20) == "its reader returned another answer than one to its file");
  CHECK(why("exec sleep 1000", 10, {.timeout = std::chrono::seconds(0)}) == "it takes too long to read: simplify it");
  CHECK_THAT(why("exec <&- >&-; exec sleep 1000", 10, {.grace = std::chrono::milliseconds(0)}), Catch::StartsWith("its reader crashed (Killed)"));
}

TEST_CASE("A reader that closes its output and waits is killed") {
  const SystemPrograms programs;
  const ReaderOutput output = run_reader("sh", {"-c", "exec >&-; exec sleep 1000"}, {.grace = std::chrono::milliseconds(0)});
  CHECK_THAT(output.failure, Catch::StartsWith("its reader crashed (Killed)"));
}

TEST_CASE("A missing reader program is named at each request") {
  ReaderSession session("no_such_reader", {});
  for (int i = 0; i < 3; ++i) CHECK_THAT(why(session), Catch::Contains("no_such_reader") && Catch::Contains("is missing"));
}
