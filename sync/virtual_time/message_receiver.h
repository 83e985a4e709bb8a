// The receiving end of a wire: a subscriber of one channel.
#pragma once

#include <cstddef>

#include "sync/time/time.h"

namespace tactus::sync {

class MessageReceiver {
 public:
  virtual ~MessageReceiver() = default;
  // Processes one encoded message. Never throws: it is called through the C code of LCM.
  virtual void accept(const void* data, std::size_t size, HostTime arrival) noexcept = 0;
};

}  // namespace tactus::sync
