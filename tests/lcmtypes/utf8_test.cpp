// Tests of the characters of UTF-8, and of cuts between them.
#include "lcmtypes/utf8.h"

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

using namespace tactus;

namespace {

// One to four bytes each.
const std::vector<std::string> kCharacters{"a",
                                           "~",
                                           "\xc3\xa9",
                                           "\xd1\x8f",
                                           "\xd8\xb9",
                                           "\xe0\xa4\xa8",
                                           "\xe4\xbd\xa0",
                                           "\xef\xbf\xbd",
                                           "\xf0\x9f\x98\x80"};

}  // namespace

TEST_CASE("Characters of one to four bytes are counted, and cut only between them") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::string> parts;
    std::string text;
    for (auto n = random() % 12; n > 0; --n)
      text += parts.emplace_back(kCharacters[random() % kCharacters.size()]);
    CHECK(character_count(text) == parts.size());
    CHECK(is_text_line(text));
    std::string first;
    for (std::size_t n = 0; n <= parts.size(); ++n) {
      CHECK(first_characters(text, n) == first);
      // As many whole characters as the bytes hold.
      for (std::size_t bytes = first.size(); n < parts.size() && bytes < first.size() + parts[n].size(); ++bytes)
        CHECK(first_bytes(text, bytes) == first);
      if (n < parts.size()) first += parts[n];
    }
    CHECK(first_bytes(text, text.size() + random() % 3) == text);
  }
}

TEST_CASE("Bytes that are no UTF-8 end a text line, and count as one character each") {
  for (const char* wrong :
       {"\xff", "\xc3", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xc0\xaf", "\x80"}) {
    CHECK(utf8_bytes(wrong) == 0);
    CHECK_FALSE(is_text_line("a" + std::string(wrong)));
    CHECK(character_count(wrong) == std::string_view(wrong).size());
  }
  CHECK(first_bytes("\x80\x80\x80\x80\x80\x80", 5) == "\x80\x80\x80\x80\x80");
}

TEST_CASE("Control characters and separators of lines and paragraphs end a text line") {
  for (const char* wrong : {"a\nb", "\t", "\x7f", "\xc2\x85", "\xe2\x80\xa8", "\xe2\x80\xa9", "\x1b[2J"})
    CHECK_FALSE(is_text_line(wrong));
  CHECK_FALSE(is_text_line(std::string_view("\0", 1)));
  CHECK(is_text_line("\xc2\xa0\xe2\x80\x8d\xe2\x80\x8f"));  // blank, joiner and mark of direction belong to texts
}
