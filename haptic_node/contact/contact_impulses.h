// Impulse of each contact and the time of its first force. An entry remains for a while after the force has ended,
// because the last part of the impulse is known one tick later and a message may be lost.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <tactus/tool_constraint_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::haptic {

struct ContactForce {
  std::int64_t contact_id = 0;
  std::int32_t body = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, world
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  // on the hand
};

class ContactImpulses {
 public:
  static constexpr std::size_t kMaxContacts = 128;  // stored; the least recently felt one is removed, and its sum begins again
  static constexpr std::size_t kMaxPublished = 12;  // maximum number in one message
  // time after the end of the force during which a contact is still published
  static constexpr sync::Nanoseconds kPublishAfter{50'000'000};

  ContactImpulses() { contacts_.reserve(kMaxContacts); }

  // One tick: adds the impulse of the forces of the last tick, then stores the forces that act from now on.
  void step(sync::HostTime now, double dt, std::span<const ContactForce> forces);
  // Time of the first force on that contact after its last pause of more than kPublishAfter.
  std::optional<sync::HostTime> first_force_time(std::int64_t contact_id) const;
  // Writes the contacts that act or recently acted, acting ones first. Realtime-safe once `out` has room for
  // kMaxPublished.
  void write_constraints(sync::HostTime now, std::vector<tool_constraint_t>& out) const;

 private:
  struct Entry {
    ContactForce force;
    Eigen::Vector3d impulse_N_s = Eigen::Vector3d::Zero();
    sync::HostTime first, last, since;  // since: begin of the sum
  };
  Entry& entry(std::int64_t contact_id, sync::HostTime now);

  std::vector<Entry> contacts_;
};

}  // namespace tactus::haptic
