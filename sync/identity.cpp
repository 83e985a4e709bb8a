#include "sync/identity.h"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

namespace tactus::sync {

std::uint64_t fnv1a_64(std::uint64_t h, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) h = (h ^ bytes[i]) * 1099511628211ull;
  return h;
}

std::int64_t fnv1a_64(const void* data, std::size_t size) {
  return static_cast<std::int64_t>(fnv1a_64(kFnv1aBegin, data, size));
}

Identity Identity::fresh(std::string node, std::int64_t run_id) {
  std::uint64_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random)
    throw std::system_error(errno, std::generic_category(), "no random numbers for the incarnation");
  Identity id;
  id.source = static_cast<std::int32_t>(fnv1a_32(node));
  id.node = std::move(node);
  id.incarnation = static_cast<std::int64_t>(random >> 2) + 1;
  id.run_id = run_id;
  return id;
}

}  // namespace tactus::sync
