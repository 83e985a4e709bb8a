// Visual rate taken from a visual_node: the frame rate that its health messages report. Pure.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <utility>

#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::sim {

class FollowedRate {
 public:
  // Smaller relative differences count as the same rate: the reported frame count varies by one per second.
  static constexpr double kMinRelativeChange = 0.03;

  // process: name of the visual_node process; empty: no process is followed.
  explicit FollowedRate(std::string process) : process_(std::move(process)) {}

  // The new rate in Hz when this message changes it. A process that is not running or reports no frames changes
  // nothing, and so does a second process with this name. arrival: on the own clock.
  std::optional<double> on_message(const node_health_t& m, sync::HostTime arrival) {
    if (process_.empty() || m.node != process_ || !sync::accepted(sender_.on_message(m.header, arrival))) return {};
    if (m.state != node_health_t::RUNNING || !(m.rate_Hz > 0)) return {};
    if (std::abs(m.rate_Hz - rate_Hz_) <= kMinRelativeChange * rate_Hz_) return {};
    return rate_Hz_ = m.rate_Hz;
  }

 private:
  std::string process_;
  sync::SingleSender sender_;
  double rate_Hz_ = 0;
};

}  // namespace tactus::sim
