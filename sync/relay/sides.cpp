#include "sync/relay/sides.h"

#include <algorithm>

namespace tactus::sync {

bool SenderSides::belongs_to(const header_t& h, int side, HostTime now) {
  const auto [at, fresh] = senders_.try_emplace({h.source, h.incarnation}, Sender{side, now});
  Sender& sender = at->second;
  if (!fresh && sender.side != side && now - sender.last_seen < kTimeout) return false;
  sender = {side, now};
  if (senders_.size() > kMax)
    senders_.erase(std::min_element(senders_.begin(), senders_.end(),
                                    [](const auto& a, const auto& b) { return a.second.last_seen < b.second.last_seen; }));
  return true;
}

}  // namespace tactus::sync
