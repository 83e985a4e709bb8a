// Texts of any bytes on their way to a browser.
#include <catch2/catch.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "sync/text/printable.h"

using tactus::sync::printable;

TEST_CASE("Any bytes become text that JSON accepts") {
  std::mt19937 random(5);
  for (int i = 0; i < 200'000; ++i) {
    std::string text;
    // Bytes at the limits of the ranges of UTF-8 are frequent, because uniform ones rarely begin a long character.
    constexpr unsigned char kLimits[] = {0x7f, 0x80, 0x8f, 0x90, 0x9f, 0xa0, 0xbf, 0xc0, 0xc1, 0xc2, 0xdf, 0xe0, 0xed, 0xef, 0xf0, 0xf4, 0xf5, 0xff};
    for (auto n = random() % 9; n > 0; --n)
      text += static_cast<char>(random() % 4 ? kLimits[random() % std::size(kLimits)] : random() % 256);
    REQUIRE_NOTHROW(nlohmann::json(printable(text)).dump());
  }
}
