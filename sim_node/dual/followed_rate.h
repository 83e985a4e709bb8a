// Visual steps as long as the pictures of a visual_node take: the rate that it says it reaches. Pure.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>

namespace tactus::sim {

class FollowedRate {
 public:
  // What differs by less is the same rate: pictures come and go by one in a second.
  static constexpr double kSame = 0.03;

  // process: its name; empty: nobody is followed.
  explicit FollowedRate(std::string process) : process_(std::move(process)) {}

  // The rate from now on, Hz, when this message changes it. One that has not begun, or shows nothing, changes nothing.
  std::optional<double> hear(const node_health_t& m) {
    if (process_.empty() || m.node != process_ || m.state != node_health_t::RUNNING || !(m.rate_Hz > 0)) return {};
    if (std::abs(m.rate_Hz - rate_Hz_) <= kSame * rate_Hz_) return {};
    return rate_Hz_ = m.rate_Hz;
  }

 private:
  std::string process_;
  double rate_Hz_ = 0;
};

}  // namespace tactus::sim
