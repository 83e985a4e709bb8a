// How a process joins the bus: the group, the ports, and how far its messages go.
#pragma once

#include <cstdint>
#include <string>

#include "lcmtypes/channels.h"

namespace tactus::sync {

struct BusOptions {
  std::string group = channels::kGroup;
  int port = channels::kDefaultPort;  // of the real-time port; the bulk port is the next one
  int ttl = 0;                        // 0: never leaves this machine
  bool memory = false;                // within this process only, for tests and logs: no network
  std::int32_t clock = 0;             // clock of the machine that a log was recorded on; 0: the clock of this process
};

enum class Port { kRealtime, kBulk, kBoth };

}  // namespace tactus::sync
