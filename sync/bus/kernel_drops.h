// Datagrams that the kernel dropped at this process' own sockets because their buffers were full.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace tactus::sync {

// Sums the `drops` column of a table in the format of /proc/net/udp over the sockets with these inodes.
std::int64_t sum_drops(const std::string& proc_net_udp, const std::set<std::string>& inodes);

// Reads /proc. Sockets with a filter do not count: the kernel counts what that refuses among their drops. -1 when
// that cannot be read. Not realtime-safe: call it once a second or less.
std::int64_t kernel_drops();

}  // namespace tactus::sync
