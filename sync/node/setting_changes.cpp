#include "sync/node/setting_changes.h"

#include <algorithm>
#include <stdexcept>

namespace tactus::sync {

void SettingChanges::process(const setting_change_t& change, const Apply& apply) {
  if (change.node != node_ || change.header.run_id != run_id_) return;
  if (const setting_reply_t* known = known_.find(change.id)) {
    replies_.push_back(*known);
    return;
  }
  setting_reply_t reply{};
  reply.header.sim_time_ns = -1;
  reply.id = change.id;
  try {
    apply(change.name, change.value);
    reply.done = 1;
    reply.text = node_ + ": " + change.name + " is " + change.value;
  } catch (const std::invalid_argument& e) {
    reply.text = node_ + ": " + e.what();
  }
  reply.text.resize(std::min<std::size_t>(reply.text.size(), 512));
  known_.try_emplace(reply.id, reply);
  replies_.push_back(reply);
}

}  // namespace tactus::sync
