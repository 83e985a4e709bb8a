// Who may talk to the server: the page that it has served itself, and nobody else's. A foreign page in the same browser could
// otherwise move a haptic device. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tactus::live {

struct Access {
  int port = 0;
  bool loopback = true;  // bound to 127.0.0.1: then only its names are answered to
  std::string token;     // of the address that was printed
};

// The Host of a request: one of our own names. With a name of its own, which an attacker's name server lets point here, a
// foreign page would count as ours.
bool host_allowed(std::string_view host, const Access& access);
// Of a WebSocket: it comes from the page of that very host. A browser always says where it comes from.
bool origin_allowed(std::string_view origin, std::string_view host);
// What follows "token=" in the target of a request is the token. Takes the same time whatever is guessed.
bool token_right(std::string_view target, const Access& access);

}  // namespace tactus::live
