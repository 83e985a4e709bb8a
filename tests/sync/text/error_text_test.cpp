// Tests of the sentences for exceptions.
#include "sync/text/error_text.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

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

TEST_CASE("An exception of a library has a sentence with a remedy, without the name of a function or class") {
  CHECK_THAT(error_text(std::bad_alloc()), Catch::StartsWith("there is not enough memory; "));
  const std::system_error thread(std::make_error_code(std::errc::resource_unavailable_try_again));  // as std::thread throws it
  CHECK_THAT(error_text(thread), Catch::StartsWith("the system refuses a thread") && Catch::Contains("ulimit"));
  try {
    (void)nlohmann::json{{"seed", "x"}}.at("seed").get<int>();
    FAIL("no error");
  } catch (const std::exception& e) {
    CHECK(error_text(e) == "a value in this JSON is missing or has another type than expected (type must be number, but is string); correct it");
  }
}

TEST_CASE("Any other exception keeps its own sentence") { CHECK(error_text(std::runtime_error("too late")) == "too late"); }
