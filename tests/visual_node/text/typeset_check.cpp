// Tests of typeset text with the installed fonts (scripts/setup fonts), in this process and through the confined
// program.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "visual_node/text/confined_text.h"
#include "visual_node/text/typeset/typesetter.h"

using namespace tactus;
using namespace tactus::visual;

namespace {

struct Sample {
  const char* script;
  std::string text;
  bool right_to_left;
};
// "Did they come together?" in the scripts that the group of fonts must cover.
const std::array<Sample, 7> kSamples{
    {{"Latin", "Kamen sie zusammen? \xc3\x84\xc3\xb6\xc3\xbc\xc3\x9f", false},
     {"Greek", "\u0389\u03c1\u03b8\u03b1\u03bd \u03bc\u03b1\u03b6\u03af;", false},
     {"Cyrillic", "\u041e\u043d\u0438 \u043f\u0440\u0438\u0448\u043b\u0438 \u0432\u043c\u0435\u0441\u0442\u0435?",
      false},
     {"Chinese", "\u5b83\u4eec\u662f\u540c\u65f6\u5230\u6765\u7684\u5417\uff1f", false},
     {"Arabic", "\u0647\u0644 \u062c\u0627\u0621\u0627 \u0645\u0639\u064b\u0627\u061f", true},
     {"Devanagari", "\u0915\u094d\u092f\u093e \u0935\u0947 \u090f\u0915 \u0938\u093e\u0925 \u0906\u090f?", false},
     {"Hebrew", "\u05d4\u05d0\u05dd \u05d4\u05dd \u05d1\u05d0\u05d5 \u05d9\u05d7\u05d3?", true}}};
// Of Cypro-Minoan (Unicode 14), which the fonts of Debian 12 and 13 lack, and of private use.
const std::string kUncovered = "\U00012f90\U0010fffd";

TextBlock block(const std::string& text, int size_px = 32, int width_px = 1000) {
  return {text, size_px, width_px, TextEdge::kNatural};
}

// Sum of the coverage of columns [from, to) of a block.
long ink(const DrawnText& text, std::size_t block, int from, int to) {
  long sum = 0;
  for (int row = text.blocks[block].first_row; row < text.blocks[block].first_row + text.blocks[block].rows; ++row)
    for (int column = from; column < to; ++column)
      sum += text.picture.coverage[static_cast<std::size_t>(row * text.picture.width + column)];
  return sum;
}

// The clusters of a text from left to right, by their first bytes.
std::vector<std::size_t> order(Typesetter& typesetter, const std::string& text) {
  std::vector<TextCluster> found = typesetter.clusters(block(text));
  std::stable_sort(found.begin(), found.end(),
                   [](const TextCluster& a, const TextCluster& b) { return a.x_px < b.x_px; });
  std::vector<std::size_t> bytes;
  for (const TextCluster& c : found) bytes.push_back(c.first_byte);
  return bytes;
}

}  // namespace

TEST_CASE("A text in each of seven scripts is drawn with the installed fonts, at its edge of the line") {
  ConfinedText confined;
  Typesetter typesetter;
  TextRequest request{{}, false};
  for (const Sample& s : kSamples) request.blocks.push_back(block(s.text));
  const DrawnText text = confined.draw(request);
  INFO("missing: " << names_of(text.missing) << "; scripts/setup fonts installs the fonts");
  REQUIRE(text.missing.empty());
  CHECK(text.picture.coverage == typesetter.draw(request).picture.coverage);
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    CAPTURE(kSamples[i].script);
    const DrawnBlock& b = text.blocks[i];
    CHECK(b.right_to_left == kSamples[i].right_to_left);
    CHECK((b.rows >= 32 && b.rows < 4 * 32));
    const long left = ink(text, i, 0, 500), right = ink(text, i, 500, 1000);
    CHECK((kSamples[i].right_to_left ? right : left) > 20'000);
    CHECK((kSamples[i].right_to_left ? left : right) == 0);
  }
}

TEST_CASE("The rows of a block are those that were measured, and a block has no pixel in the rows of another") {
  Typesetter typesetter;
  TextRequest request{{}, true};
  for (const Sample& s : kSamples) request.blocks.push_back(block(s.text, 20, 120));
  const DrawnText measured = typesetter.draw(request);
  request.measure = false;
  const DrawnText whole = typesetter.draw(request);
  REQUIRE(measured.blocks.size() == whole.blocks.size());
  for (std::size_t i = 0; i < request.blocks.size(); ++i) {
    CHECK(measured.blocks[i].rows == whole.blocks[i].rows);
    const DrawnText alone = typesetter.draw({{request.blocks[i]}, false});
    CHECK(ink(alone, 0, 0, 120) == ink(whole, i, 0, 120));
  }
}

TEST_CASE("Arabic and Hebrew run from right to left, with words and numbers of other scripts within") {
  Typesetter typesetter;
  CHECK(order(typesetter, "abc") == std::vector<std::size_t>{0, 1, 2});
  CHECK(order(typesetter, "\u05d0\u05d1\u05d2") == std::vector<std::size_t>{4, 2, 0});
  CHECK(order(typesetter, "\u0628\u062a\u062b") == std::vector<std::size_t>{4, 2, 0});
  // Hebrew, a number, Hebrew: the digits keep their order (Unicode Standard Annex 9). Bytes: 0 2 4 | 5 6 | 7 8.
  CHECK(order(typesetter, "\u05d0\u05d1 12 \u05d2") == std::vector<std::size_t>{8, 7, 5, 6, 4, 2, 0});
  // Latin around Hebrew: only the Hebrew letters are reversed.
  CHECK(order(typesetter, "a\u05d0\u05d1z") == std::vector<std::size_t>{0, 3, 1, 5});
}

TEST_CASE("A letter and its combining marks are one cluster") {
  Typesetter typesetter;
  for (const std::string& text : {std::string("e\u0301"), std::string("\u0436\u0301"), std::string("\u0915\u093f"),
                                  std::string("\u0628\u064b"), std::string("a\u0323\u0302")}) {
    CAPTURE(text);
    CHECK(typesetter.clusters(block(text)).size() == 1);
    CHECK(typesetter.clusters(block(text + text)).size() == 2);
  }
  // Composed and decomposed letters look the same.
  const auto drawn = [&](const std::string& text) {
    return typesetter.draw({{block(text)}, false}).picture.coverage;
  };
  CHECK(drawn("\u00e9") == drawn("e\u0301"));
  // A joined pair of consonants is narrower than the two.
  const auto width = [&](const std::string& text) {
    int sum = 0;
    for (const TextCluster& c : typesetter.clusters(block(text))) sum += c.width_px;
    return sum;
  };
  CHECK(width("\u0915\u094d\u092f") < width("\u0915") + width("\u092f"));
}

TEST_CASE("Lines break between words, and between characters of Chinese, within the width") {
  Typesetter typesetter;
  std::string words, chinese;
  for (int i = 0; i < 30; ++i) words += "\u0432\u043c\u0435\u0441\u0442\u0435 ", chinese += "\u540c\u65f6";
  for (const std::string& text : {words, chinese}) {
    const auto clusters = typesetter.clusters(block(text, 20, 300));
    CHECK(clusters.back().line >= 2);
    for (const TextCluster& c : clusters)
      if (text[c.first_byte] != ' ') CHECK((c.x_px >= 0 && c.x_px + c.width_px <= 300));
  }
}

TEST_CASE("A character that no installed font covers is named, and no picture is drawn") {
  Typesetter typesetter;
  ConfinedText confined;
  const TextRequest request{{block("a" + kUncovered + "b" + kUncovered)}, false};
  for (const DrawnText& text : {typesetter.draw(request), confined.draw(request)}) {
    CHECK(text.missing == std::vector<char32_t>{0x12f90, 0x10fffd});
    CHECK(text.picture.coverage.empty());
  }
}

TEST_CASE("A hostile text is drawn within its rows, or refused with one clause") {
  Typesetter typesetter;
  std::string pile = "a";
  while (pile.size() + 2 <= kMaxTextBytes) pile += "\u0301";
  const DrawnText text = typesetter.draw({{block(pile)}, false});
  REQUIRE(text.missing.empty());
  CHECK(text.blocks[0].rows <= 6 * 32);
  for (const char* wrong : {"\xff", "a\xe0\xa4", "\x1b[2J", "a\nb"}) {
    CHECK_THROWS_WITH(typesetter.draw({{block(wrong)}, false}),
                      Catch::Contains("not UTF-8, or has a control character"));
    CHECK_THROWS_AS(ConfinedText().draw({{block(wrong)}, false}), std::runtime_error);
  }
  const TextRequest large{{block(std::string(2000, 'W'), 400, 400)}, false};
  CHECK_THROWS_WITH(typesetter.draw(large), Catch::Contains("larger than a picture"));
  CHECK(typesetter.draw({large.blocks, true}).blocks.front().rows == kMaxTextRows);
}

TEST_CASE("draw_text --check prints the characters without a font, and refuses text that is not UTF-8") {
  namespace fs = std::filesystem;
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "draw_text";
  const fs::path input = fs::temp_directory_path() / ("tactus_draw_text." + std::to_string(getpid()));
  const auto said = [&](const std::string& text) {
    std::ofstream(input) << text;
    FILE* const pipe = popen((program.string() + " --check < " + input.string() + " 2>&1").c_str(), "r");
    std::string output;
    for (int c; (c = std::fgetc(pipe)) != EOF;) output += static_cast<char>(c);
    const int status = pclose(pipe);
    fs::remove(input);
    return output + (status == 0 ? "" : "failed");
  };
  CHECK(said("ok\n" + kSamples[2].text + "\n\n") == "");
  CHECK(said(kUncovered + "\nb" + kUncovered) == "U+12F90\nU+10FFFD\n");
  CHECK_THAT(said("\xff"), Catch::StartsWith("draw_text: the text cannot be checked: it is not UTF-8"));
  CHECK_THAT(said(std::string(2 << 20, 'a')), Catch::StartsWith("draw_text: the text cannot be checked: the text has more than 1 MiB"));
}

TEST_CASE("draw_text --check draws in a second process, which is confined") {
  namespace fs = std::filesystem;
  // Without draw_text in its folder, a copy under another name finds no program that draws.
  const fs::path folder = fs::temp_directory_path() / ("tactus_draw_text_copy." + std::to_string(getpid()));
  fs::create_directory(folder);
  fs::copy_file(fs::read_symlink("/proc/self/exe").parent_path() / "draw_text", folder / "copy");
  FILE* const pipe = popen(("echo \u00e4 | env -u TACTUS_BIN " + (folder / "copy").string() + " --check 2>&1").c_str(), "r");
  std::string output;
  for (int c; (c = std::fgetc(pipe)) != EOF;) output += static_cast<char>(c);
  CHECK(pclose(pipe) != 0);
  fs::remove_all(folder);
  CHECK_THAT(output, Catch::Contains((folder / "draw_text").string() + ", which reads such files, is missing"));
}
