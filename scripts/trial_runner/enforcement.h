// Publishes the profile of the trial until every running modality reports that it is in force. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/degradation/profile_exchange.h"

namespace tactus::trial_runner {

class Enforcement {
 public:
  static constexpr sync::Nanoseconds kRepeat{100'000'000};     // a datagram may be lost
  static constexpr sync::Nanoseconds kHealthTimeout{500'000'000};  // health comes every 100 ms: a node silent for this time is gone
  static constexpr std::size_t kMaxModalities = 64;

  // Puts this profile in force from now on.
  void begin(sync::ProfileInForce profile) { profile_ = std::move(profile), confirmed_ = false, next_.reset(); }
  void push(const node_health_t& m, sync::HostTime arrival);
  // The profile, when it is due to be sent (again).
  const sync::ProfileInForce* to_send(sync::HostTime now);
  // Returns the running modalities once, when all of them have the profile in force; nullopt otherwise.
  std::optional<std::vector<std::string>> take_in_force(sync::HostTime now);
  // The running modalities without the profile.
  std::vector<std::string> missing(sync::HostTime now) const;
  const std::optional<sync::ProfileInForce>& profile() const { return profile_; }

 private:
  struct NodeStatus {
    std::int64_t profile = 0;
    sync::HostTime received{};
  };
  std::optional<sync::ProfileInForce> profile_;
  bool confirmed_ = false;
  std::optional<sync::HostTime> next_;
  std::map<std::string, NodeStatus> modalities_;  // by node
};

}  // namespace tactus::trial_runner
