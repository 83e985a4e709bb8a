#include "sync/text/printable.h"

#include <cstdio>

namespace tactus::sync {
namespace {

// Bytes of the character that begins here; 0: not printable. The ranges of the second byte are those of the Unicode Standard 15,
// table 3-7 (well-formed UTF-8): no longer form than necessary, no surrogates, nothing above U+10FFFF.
std::size_t shown_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t n = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
  if (n == 0 || text.size() < n) return 0;
  for (std::size_t i = 1; i < n; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte(1);
  switch (lead) {
    case 0xc2: return second < 0xa0 ? 0 : n;  // U+0080 .. U+009F are control characters
    case 0xe0: return second < 0xa0 ? 0 : n;
    case 0xed: return second > 0x9f ? 0 : n;
    case 0xf0: return second < 0x90 ? 0 : n;
    case 0xf4: return second > 0x8f ? 0 : n;
    default: return n;
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = shown_bytes(text);
    if (n > 0) {
      out += text.substr(0, n);
    } else {
      char escaped[5];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(text[0])));
      out += escaped;
    }
    text.remove_prefix(n > 0 ? n : 1);
  }
  return out;
}

}  // namespace tactus::sync
