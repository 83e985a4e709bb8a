// Tests of requests to draw_text and its answers.
#include "visual_node/text/text_blocks.h"

#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

using namespace tactus::visual;

namespace {

DrawnText two_blocks() {
  DrawnText text;
  text.picture = {3, 5, std::vector<std::uint8_t>(15, 7)};
  text.blocks = {{0, 2, 2, false}, {2, 3, 1, true}};
  return text;
}

}  // namespace

TEST_CASE("A request and an answer of draw_text are read as they were written") {
  const TextRequest request{{{"\xd0\xb4\xd0\xb0", 20, 300, TextEdge::kRight}, {"", 6, 1, TextEdge::kNatural}},
                            true};
  const TextRequest read = unpack_text_request(pack(request));
  REQUIRE(read.blocks.size() == 2);
  CHECK((read.measure && read.blocks[0].text == request.blocks[0].text && read.blocks[0].size_px == 20));
  CHECK(
      (read.blocks[0].width_px == 300 && read.blocks[0].edge == TextEdge::kRight && read.blocks[1].text.empty()));
  DrawnText text = two_blocks();
  text.missing = {U'\u0905'};
  const DrawnText drawn = unpack_drawn_text(pack(text));
  CHECK(
      (drawn.picture.width == 3 && drawn.picture.height == 5 && drawn.picture.coverage == text.picture.coverage));
  REQUIRE(drawn.blocks.size() == 2);
  CHECK((drawn.blocks[1].first_row == 2 && drawn.blocks[1].rows == 3 && drawn.blocks[1].line_rows == 1 &&
         drawn.blocks[1].right_to_left));
  CHECK(drawn.missing == text.missing);
}

TEST_CASE("An answer whose picture or rows do not fit each other is refused") {
  const auto refused = [](auto change) {
    DrawnText text = two_blocks();
    change(text);
    try {
      unpack_drawn_text(pack(text));
      return false;
    } catch (const std::runtime_error&) {
      return true;
    }
  };
  CHECK_FALSE(refused([](DrawnText&) {}));
  CHECK(refused([](DrawnText& t) { t.picture.width = 4; }));
  CHECK(refused([](DrawnText& t) { t.picture.width = -3, t.picture.height = -5; }));
  CHECK(refused([](DrawnText& t) { t.picture.height = kMaxTextRows + 1; }));
  CHECK(refused([](DrawnText& t) { t.blocks[0].rows = -1; }));
  CHECK(refused([](DrawnText& t) { t.blocks[1].first_row = kMaxTextRows; }));
  CHECK(refused([](DrawnText& t) { t.blocks[1].line_rows = 4; }));
  CHECK_FALSE(refused([](DrawnText& t) { t.missing = {U'\U0010ffff'}; }));
  CHECK(refused([](DrawnText& t) { t.missing = {static_cast<char32_t>(0x110000)}; }));
}

TEST_CASE("Any bytes are read as a request or an answer, or refused with one clause") {
  std::mt19937 random(2);
  const auto good = pack(TextRequest{{{"ab", 20, 300, TextEdge::kLeft}}, false}), answer = pack(two_blocks());
  for (int i = 0; i < 20'000; ++i) {
    auto bytes = i % 2 ? good : answer;
    for (auto n = random() % 4; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % 3 ? bytes.size() : random() % bytes.size());
    try {
      i % 2 ? (void)unpack_text_request(bytes) : (void)unpack_drawn_text(bytes);
    } catch (const std::runtime_error& e) {
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("Characters without a font are named by their codes") {
  CHECK(names_of({U'\u0905'}) == "U+0905");
  CHECK(names_of({U'\u0905', U'\U00012f90'}) == "U+0905 and U+12F90");
  CHECK(names_of({1, 2, 3, 4}) == "U+0001, U+0002, U+0003 and U+0004");
  CHECK(names_of({1, 2, 3, 4, 5, 6}) == "U+0001, U+0002, U+0003 and 3 other characters");
}
