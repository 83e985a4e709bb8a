#include "lcmtypes/utf8.h"

#include <algorithm>

namespace tactus {

std::size_t utf8_bytes(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t n = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
  if (n == 0 || text.size() < n) return 0;
  for (std::size_t i = 1; i < n; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // No longer form than necessary, no surrogates, nothing above U+10FFFF.
  const unsigned char second = byte(1);
  switch (lead) {
    case 0xe0: return second < 0xa0 ? 0 : n;
    case 0xed: return second > 0x9f ? 0 : n;
    case 0xf0: return second < 0x90 ? 0 : n;
    case 0xf4: return second > 0x8f ? 0 : n;
    default: return n;
  }
}

std::size_t shown_bytes(std::string_view text) {
  const std::size_t n = utf8_bytes(text);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (n == 1) return byte(0) >= 0x20 && byte(0) != 0x7f ? 1 : 0;
  return n == 2 && byte(0) == 0xc2 && byte(1) < 0xa0 ? 0 : n;
}

bool is_text_line(std::string_view text) {
  while (!text.empty()) {
    const std::size_t n = shown_bytes(text);
    if (n == 0 || text.starts_with("\xe2\x80\xa8") || text.starts_with("\xe2\x80\xa9")) return false;
    text.remove_prefix(n);
  }
  return true;
}

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (; !text.empty(); ++count) text.remove_prefix(std::max<std::size_t>(1, utf8_bytes(text)));
  return count;
}

std::string_view first_characters(std::string_view text, std::size_t count) {
  std::string_view rest = text;
  for (; count > 0 && !rest.empty(); --count) rest.remove_prefix(std::max<std::size_t>(1, utf8_bytes(rest)));
  return text.substr(0, text.size() - rest.size());
}

std::string_view first_bytes(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  // A character is at most four bytes long, so it begins at most three before the cut.
  for (std::size_t back = 0; back < 4 && back <= bytes; ++back)
    if ((static_cast<unsigned char>(text[bytes - back]) & 0xc0) != 0x80) return text.substr(0, bytes - back);
  return text.substr(0, bytes);  // no UTF-8
}

}  // namespace tactus
