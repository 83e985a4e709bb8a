// Counts datagrams that the kernel dropped at the sockets of this process because their buffers were full.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace tactus::sync {

// Sums the `drops` column of a table in the format of /proc/net/udp over the sockets with these inodes.
std::int64_t sum_drops(const std::string& proc_net_udp, const std::set<std::string>& inodes);

// Reads /proc. Leaves out sockets with a filter: the kernel counts rejected messages among their drops. -1 when /proc cannot
// be read. Not realtime-safe: call it once a second or less.
std::int64_t kernel_drops();

}  // namespace tactus::sync
