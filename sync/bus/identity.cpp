#include "sync/bus/identity.h"

#include <sys/random.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {

std::uint64_t fnv1a_64(std::uint64_t h, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) h = (h ^ bytes[i]) * 1099511628211ull;
  return h;
}

std::int64_t fnv1a_64(const void* data, std::size_t size) {
  return static_cast<std::int64_t>(fnv1a_64(kFnv1aBegin, data, size));
}

std::int32_t clock_id(std::string_view boot_id, std::uint64_t time_namespace, std::string_view monotonic_offset) {
  std::string text(boot_id);
  text.append("/").append(std::to_string(time_namespace)).append("/").append(monotonic_offset);
  return static_cast<std::int32_t>(fnv1a_32(text));
}

std::int32_t clock_of_this_process() {
  std::string boot_id, line, monotonic_offset;
  std::ifstream boot("/proc/sys/kernel/random/boot_id");
  std::getline(boot, boot_id);
  struct stat space {};
  const bool known = stat("/proc/self/ns/time", &space) == 0;
  // Two lines, "monotonic <s> <ns>" and "boottime <s> <ns>" (time_namespaces(7)).
  std::ifstream offsets("/proc/self/timens_offsets");
  while (std::getline(offsets, line))
    if (line.starts_with("monotonic")) monotonic_offset = line;
  return clock_id(boot_id, known ? space.st_ino : 0, monotonic_offset);
}

Identity Identity::fresh(std::string node, std::int64_t run_id) {
  std::uint64_t random = 0;
  VirtualTime* const time = VirtualTime::current();
  if (time)
    random = time->random();
  else if (getrandom(&random, sizeof random, 0) != sizeof random)
    throw std::system_error(errno, std::generic_category(), "the system provides no random numbers for the incarnation");
  Identity id;
  id.source = static_cast<std::int32_t>(fnv1a_32(node));
  id.node = std::move(node);
  id.incarnation = static_cast<std::int64_t>(random >> 2) + 1;
  id.run_id = run_id;
  id.clock = time ? VirtualTime::kClock : clock_of_this_process();
  return id;
}

}  // namespace tactus::sync
