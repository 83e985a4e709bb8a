// What each contact has received: the impulse of its force, and when it was first felt. Kept a while after the
// force has ended, because the last share of the impulse is known only a tick later and a message may be lost.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tactus/tool_constraint_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::haptic {

struct FeltForce {
  std::int64_t contact_id = 0;
  std::int32_t body = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, world
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  // on the hand
};

class ContactImpulses {
 public:
  static constexpr std::size_t kMaxContacts = 128;            // remembered; the least recently felt is forgotten
  static constexpr std::size_t kMaxTold = 12;                 // in one message
  static constexpr sync::Nanoseconds kToldAfter{50'000'000};  // the end of its force

  ContactImpulses() { contacts_.reserve(kMaxContacts); }

  // One tick: adds what the forces of the last tick did until now, then notes those that act from now on.
  void step(sync::HostTime now, double dt, std::span<const FeltForce> forces);
  // When force on that contact was first commanded since it was last without for longer than kToldAfter.
  std::optional<sync::HostTime> first_felt(std::int64_t contact_id) const;
  // Those that act or acted lately, latest first. Realtime-safe once `out` has room for kMaxTold.
  void tell(sync::HostTime now, std::vector<tool_constraint_t>& out) const;

 private:
  struct Entry {
    FeltForce felt;
    Eigen::Vector3d impulse_N_s = Eigen::Vector3d::Zero();
    sync::HostTime first, last;
  };
  Entry& entry(std::int64_t contact_id, sync::HostTime now);

  std::vector<Entry> contacts_;
};

}  // namespace tactus::haptic
