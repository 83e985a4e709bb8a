// Datagrams that the kernel dropped at this process' own sockets because their buffers were full.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace tactus::sync {

// Sums the `drops` column of a table in the format of /proc/net/udp over the sockets with these inodes.
std::int64_t sum_drops(const std::string& proc_net_udp, const std::set<std::string>& inodes);

// The same over the sockets that are bound to this port, whosever they are.
std::int64_t drops_of_port(const std::string& proc_net_udp, int port);

// Reads /proc. -1 when that cannot be read. Not realtime-safe: call it once a second or less.
std::int64_t kernel_drops();

}  // namespace tactus::sync
