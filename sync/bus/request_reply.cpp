#include "sync/bus/request_reply.h"

#include <sys/random.h>

#include <stdexcept>

namespace tactus::sync {

std::int64_t request_id() {
  std::uint64_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random) throw std::runtime_error("the system provides no random numbers");
  return static_cast<std::int64_t>(random >> 2) + 1;
}

}  // namespace tactus::sync
