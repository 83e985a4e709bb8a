// Access control of the server: only its own page may connect. A foreign page in the same browser could otherwise move a
// haptic device. Pure.
#pragma once

#include <string>
#include <string_view>

namespace tactus::live {

struct Access {
  int port = 0;
  bool loopback = true;  // bound to 127.0.0.1: only names of this host are accepted
  std::string token;     // of the printed address
};

// Checks the Host of a request: it must be a name of this server. Otherwise a foreign page could use a name of its own that
// an attacker's name server resolves to this address (DNS rebinding).
bool host_allowed(std::string_view host, const Access& access);
// Checks the Origin of a WebSocket: it must be the page of that very host. A browser always sends it.
bool origin_allowed(std::string_view origin, std::string_view host);
// True when the text after "token=" in the target of a request is the token. The comparison takes constant time.
bool token_matches(std::string_view target, const Access& access);

}  // namespace tactus::live
