#include "visual_node/text/text_blocks.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "sync/sandbox/records.h"

namespace tactus::visual {
namespace {

constexpr char32_t kLastCharacter = 0x10ffff;  // Unicode 15.0, 2.4

void require(bool right, const char* clause) {
  if (!right) throw std::runtime_error(clause);
}

bool within(std::int64_t value, std::int64_t least, std::int64_t most) { return value >= least && value <= most; }

}  // namespace

std::vector<std::uint8_t> pack(const TextRequest& request) {
  sync::Packer out;
  out.put(static_cast<std::uint8_t>(request.measure));
  out.put(static_cast<std::uint64_t>(request.blocks.size()));
  for (const TextBlock& b : request.blocks) {
    out.put_list(b.text);
    out.put(static_cast<std::int32_t>(b.size_px));
    out.put(static_cast<std::int32_t>(b.width_px));
    out.put(static_cast<std::uint8_t>(b.edge));
  }
  return out.take();
}

TextRequest unpack_text_request(std::span<const std::uint8_t> bytes) {
  sync::Unpacker in(bytes);
  TextRequest request;
  request.measure = in.get<std::uint8_t>() != 0;
  request.blocks.resize(in.get_count(17));
  require(request.blocks.size() <= kMaxBlocks, "it has too many texts");
  for (TextBlock& b : request.blocks) {
    b.text = in.get_list<std::string>();
    b.size_px = in.get<std::int32_t>(), b.width_px = in.get<std::int32_t>();
    const auto edge = in.get<std::uint8_t>();
    require(b.text.size() <= kMaxTextBytes, "its text is too long");
    require(within(b.size_px, kMinSize_px, kMaxSize_px) && within(b.width_px, 1, kMaxTextWidth_px) && edge <= 2,
            "its letters or lines have no possible size");
    b.edge = static_cast<TextEdge>(edge);
  }
  require(in.at_end(), "it has more bytes than texts");
  return request;
}

std::vector<std::uint8_t> pack(const DrawnText& text) {
  sync::Packer out;
  out.put(static_cast<std::int32_t>(text.picture.width));
  out.put(static_cast<std::int32_t>(text.picture.height));
  out.put_list(text.picture.coverage);
  out.put(static_cast<std::uint64_t>(text.blocks.size()));
  for (const DrawnBlock& b : text.blocks) {
    for (const std::int32_t number : {b.first_row, b.rows, b.line_rows}) out.put(number);
    out.put(static_cast<std::uint8_t>(b.right_to_left));
  }
  out.put_list(text.missing);
  return out.take();
}

DrawnText unpack_drawn_text(std::span<const std::uint8_t> bytes) {
  constexpr const char* kWrong = "its reader returned no picture of text";
  sync::Unpacker in(bytes);
  DrawnText text;
  text.picture.width = in.get<std::int32_t>(), text.picture.height = in.get<std::int32_t>();
  text.picture.coverage = in.get_list<std::vector<std::uint8_t>>();
  require(within(text.picture.width, 0, kMaxTextWidth_px) && within(text.picture.height, 0, kMaxTextRows) &&
              text.picture.coverage.size() ==
                  static_cast<std::size_t>(text.picture.width) * static_cast<std::size_t>(text.picture.height),
          kWrong);
  text.blocks.resize(in.get_count(13));
  for (DrawnBlock& b : text.blocks) {
    b.first_row = in.get<std::int32_t>(), b.rows = in.get<std::int32_t>(), b.line_rows = in.get<std::int32_t>();
    b.right_to_left = in.get<std::uint8_t>() != 0;
    require(within(b.first_row, 0, kMaxTextRows) && within(b.rows, 0, kMaxTextRows - b.first_row) &&
                within(b.line_rows, 0, b.rows),
            kWrong);
  }
  text.missing = in.get_list<std::vector<char32_t>>();
  for (const char32_t c : text.missing) require(c <= kLastCharacter, kWrong);
  require(in.at_end(), kWrong);
  return text;
}

std::string names_of(const std::vector<char32_t>& characters, std::size_t most) {
  std::string names;
  const std::size_t shown = characters.size() <= most ? characters.size() : most - 1;
  for (std::size_t i = 0; i < shown; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "U+%04X", static_cast<unsigned>(characters[i]));
    names += (i == 0 ? "" : i + 1 == characters.size() ? " and " : ", ") + std::string(name);
  }
  if (shown < characters.size())
    names += " and " + std::to_string(characters.size() - shown) + " other characters";
  return names;
}

}  // namespace tactus::visual
