#include "sync/text/printable.h"

#include <cstdio>

#include "lcmtypes/utf8.h"

namespace tactus::sync {

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
