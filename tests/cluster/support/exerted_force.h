// The force that examples/device_driver/driver.cpp exerts, from the motion of its weight in two states of adjacent numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tactus/device_state_t.hpp>
#include <vector>

#include "sync/bus/inbox.h"

namespace tactus::cluster {

class ExertedForce {
 public:
  // The force of one tick. The driver updates it after its message at after_ns and before the one at sent_ns, so all bounds
  // between these two times hold on a machine of any speed.
  struct Tick {
    std::int64_t after_ns, sent_ns;
    double force_N;
  };

  void receive(sync::Queue<device_state_t>& states) {
    while (const auto m = states.pop()) add(m->message);
  }
  const std::vector<Tick>& ticks() const { return ticks_; }

  // Limits that the force has passed, in words; empty: none.
  std::string faults() const {
    std::string text;
    std::int64_t zero_ns = -1;  // the last force of 0 was updated after this time
    for (std::size_t i = 0; i < ticks_.size(); ++i) {
      const Tick& t = ticks_[i];
      const double size = std::abs(t.force_N);
      if (size > kForceLimit_N + kRounding_N) text += "force of " + std::to_string(size) + " N; ";
      if (size < kZero_N) zero_ns = t.after_ns;
      if (i == 0 || ticks_[i - 1].sent_ns != t.after_ns) {
        if (size >= kZero_N) zero_ns = -1;  // a state is missing
        continue;
      }
      const Tick& before = ticks_[i - 1];
      const double rise_N = size - std::abs(before.force_N) - kSlew_N_s * 1e-9 * static_cast<double>(t.sent_ns - before.after_ns);
      if (rise_N > kRounding_N) text += "rise beyond the limit by " + std::to_string(rise_N) + " N; ";
      const double since_s = 1e-9 * static_cast<double>(t.sent_ns - zero_ns);
      if (zero_ns >= 0 && since_s < kFade_s && size > kForceLimit_N * since_s / kFade_s + kRounding_N)
        text += "return faster than the fade: " + std::to_string(size) + " N after " + std::to_string(since_s) + " s; ";
    }
    return text;
  }
  // The largest force of the updates that lie surely between these times, N.
  double largest_N(std::int64_t from_ns, std::int64_t to_ns) const {
    double largest = 0;
    for (const Tick& t : ticks_)
      if (t.after_ns >= from_ns && t.sent_ns <= to_ns) largest = std::max(largest, std::abs(t.force_N));
    return largest;
  }
  // Forgets all ticks, such as those of the landing of a weight, which begins without a fade.
  void clear() { ticks_.clear(); }

 private:
  static constexpr double kForceLimit_N = 8, kSlew_N_s = 2000, kFade_s = 0.02, kZero_N = 1e-3, kRounding_N = 1e-2;

  void add(const device_state_t& m) {
    states_.push_back(m);
    if (states_.size() > 3) states_.erase(states_.begin());
    if (states_.size() < 3 || states_[2].header.seq != states_[0].header.seq + 2 || states_[1].header.seq != states_[0].header.seq + 1) return;
    // Mass, damper, spring and step of the weight of the driver.
    constexpr double kMass_kg = 0.1, kDamping_Ns_m = 10, kStiffness_N_m = 300, kRest_m = -0.005, kStep_s = 1e-3;
    const double v = states_[1].velocity_m_s.z, next = states_[2].velocity_m_s.z;
    const double force_N = kMass_kg / kStep_s * (next - v) + kDamping_Ns_m * v + kStiffness_N_m * (states_[1].pose.position_m.z - kRest_m);
    ticks_.push_back({states_[0].header.publish_time_ns, states_[1].header.publish_time_ns, force_N});
  }

  std::vector<device_state_t> states_;
  std::vector<Tick> ticks_;
};

}  // namespace tactus::cluster
