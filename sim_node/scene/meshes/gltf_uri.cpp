// Paths and bytes in URIs.
#include <array>
#include <cctype>
#include <string_view>

#include "sim_node/scene/meshes/gltf_document.h"

namespace tactus::sim {
namespace {

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";  // RFC 4648, table 1

constexpr std::array<int, 256> make_digits() {
  std::array<int, 256> digits{};
  for (int& d : digits) d = -1;
  for (std::size_t i = 0; i < kBase64.size(); ++i)
    digits[static_cast<unsigned char>(kBase64[i])] = static_cast<int>(i);
  return digits;
}
constexpr std::array<int, 256> kDigits = make_digits();

}  // namespace

bool decode_data_uri(const std::string& uri, sync::Bytes& bytes) {
  const auto comma = uri.find(',');
  if (!uri.starts_with("data:") || comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64"))
    return false;
  unsigned bits = 0;
  int count = 0;
  bytes.clear();
  for (std::size_t i = comma + 1; i < uri.size() && uri[i] != '='; ++i) {
    const int digit = kDigits[static_cast<unsigned char>(uri[i])];
    if (digit < 0) return false;
    bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffffff;
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return true;
}

std::string encode_base64(const sync::Bytes& bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kBase64[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string decode_path(const std::string& uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto hex = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at]));
    };
    if (uri[i] == '%' && hex(i + 1) && hex(i + 2)) {
      path += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      path += uri[i];
    }
  }
  return path;
}

std::string encode_path(const std::string& path) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string uri;
  for (const char c : path) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) || std::string_view("-._~/").find(c) != std::string_view::npos)
      uri += c;
    else
      uri += {'%', kHex[u >> 4], kHex[u & 15]};
  }
  return uri;
}

}  // namespace tactus::sim
