// Tests of the sentences for exceptions.
#include "sync/text/error_text.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>

using tactus::sync::error_text;

TEST_CASE("An error of the file system names path, reason and remedy, and no function of a library") {
  try {
    std::filesystem::create_directories("/proc/none/x");
    FAIL("no error");
  } catch (const std::exception& e) {
    CHECK_THAT(error_text(e), Catch::StartsWith("/proc/none") && Catch::EndsWith("No such file or directory; check the path and its permissions"));
  }
  const std::filesystem::filesystem_error copy("cannot copy", "a b", "c", std::make_error_code(std::errc::no_space_on_device));
  CHECK(error_text(copy) == "a b to c: No space left on device; check the path and its permissions");
}

TEST_CASE("Any other exception keeps its own sentence") { CHECK(error_text(std::runtime_error("too late")) == "too late"); }
