#include "scripts/live/origin.h"

namespace tactus::live {

bool host_allowed(std::string_view host, const Access& access) {
  if (host.empty() || host.size() > 255) return false;
  if (!access.loopback) return true;
  const std::string port = ":" + std::to_string(access.port);
  for (const char* name : {"127.0.0.1", "localhost", "[::1]"})
    if (host == name + port || (access.port == 80 && host == name)) return true;
  return false;
}

bool origin_allowed(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return !host.empty() && origin.substr(0, kScheme.size()) == kScheme && origin.substr(kScheme.size()) == host;
}

bool token_matches(std::string_view target, const Access& access) {
  constexpr std::string_view kName = "token=";
  const std::size_t at = target.find(kName);
  if (access.token.empty() || at == std::string_view::npos) return false;
  std::string_view given = target.substr(at + kName.size());
  given = given.substr(0, given.find('&'));
  if (given.size() != access.token.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    differs |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(access.token[i]);
  return differs == 0;
}

}  // namespace tactus::live
