#include <tactus/tool_state_t.hpp>

#include "sim_node/touch/tool_push.h"

namespace tactus::sim {

void ToolPush::archive(StateArchive& a, std::size_t bodies) {
  std::vector<std::pair<std::int64_t, ContactImpulses>> all(impulses_.begin(), impulses_.end());
  a.list(all, kMaxContacts, [&](auto& id_and_impulses) {
    auto& [id, c] = id_and_impulses;
    a(id), a(c.since_ns);
    a.index(c.body, bodies);
    a.require(c.body >= 0, "the state has a contact without a body");
    a(c.point), a(c.reported), a(c.received), a(c.pending), a(c.mean_N), a(c.applied), a(c.velocity);
    a(c.energy_J), a(c.used);
  });
  if (a.reads()) impulses_ = {all.begin(), all.end()};
  a(incarnation_), a(last_seq_), a(last_publish_ns_);
  bool has_message = last_message_.has_value();
  sync::SimTime when = last_message_.value_or(sync::SimTime{});
  a(has_message), a(when);
  last_message_ = has_message ? std::optional(when) : std::nullopt;
  if (a.reads()) pushes_.clear();
}

void ToolPush::hold(sync::SimTime now, std::span<const tool_state_t> new_messages, std::span<const BodyMotion> bodies) {
  receive(new_messages, now, bodies);
  for (auto& [id, c] : impulses_) c.received = c.pending = c.mean_N = Eigen::Vector3d::Zero();
  pushes_.clear();
}

void ToolPush::reset() {
  impulses_.clear();
  incarnation_ = 0;
  last_seq_ = -1;
  last_publish_ns_ = 0;
  last_message_.reset();
  pushes_.clear();
}

}  // namespace tactus::sim
