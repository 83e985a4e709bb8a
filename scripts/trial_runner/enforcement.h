// Whether every sense has the profile of the trial: it is sent until all that live say so. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/degradation/profile_exchange.h"

namespace tactus::conductor {

class Enforcement {
 public:
  static constexpr sync::Nanoseconds kRepeat{100'000'000};     // a datagram may be lost
  static constexpr sync::Nanoseconds kForgotten{500'000'000};  // health comes every 100 ms: such a node is gone
  static constexpr std::size_t kMaxSenses = 64;

  // To be put in force from now on.
  void begin(sync::ProfileInForce profile) { profile_ = std::move(profile), told_ = false, next_.reset(); }
  void push(const node_health_t& m, sync::HostTime arrival);
  // The profile, when it is time to send it (again).
  const sync::ProfileInForce* to_send(sync::HostTime now);
  // The senses that have it, the first time that all that are there do; nothing else.
  std::optional<std::vector<std::string>> take_in_force(sync::HostTime now);
  // Those that are there and have it not.
  std::vector<std::string> missing(sync::HostTime now) const;
  const std::optional<sync::ProfileInForce>& profile() const { return profile_; }

 private:
  struct ModalityEndpoint {
    std::int64_t profile = 0;
    sync::HostTime heard{};
  };
  std::optional<sync::ProfileInForce> profile_;
  bool told_ = false;
  std::optional<sync::HostTime> next_;
  std::map<std::string, ModalityEndpoint> senses_;  // by node
};

}  // namespace tactus::conductor
