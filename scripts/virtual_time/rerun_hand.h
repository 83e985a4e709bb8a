// The program rerun_hand: the hand of a recorded run in place of a person, for virtual_time (tactus rerun). It holds an external device, follows its
// intention with the impedance of a hand, and repeats the commands that the recorded run sent to the simulation.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>
#include <tactus/sim_command_t.hpp>
#include <utility>
#include <vector>

#include "haptic_node/devices/virtual_hand.h"
#include "sync/time/time.h"

namespace tactus {

// Forces on the hand, each in effect from a constant delay after its arrival. Pure.
class DelayedForce {
 public:
  // delay: at least 0.
  explicit DelayedForce(sync::Nanoseconds delay) : delay_(delay) {}
  void push(sync::HostTime arrival, const Eigen::Vector3d& force_N) { waiting_.emplace_back(arrival + delay_, force_N); }
  // The force at `now`, N; empty: no new one since the last call.
  std::optional<Eigen::Vector3d> take(sync::HostTime now);

 private:
  sync::Nanoseconds delay_;
  std::deque<std::pair<sync::HostTime, Eigen::Vector3d>> waiting_;
};

// A hand of known impedance that follows a known intention, with the delay of its force. Pure.
class RerunHand {
 public:
  // intention: m over s of simulated time; the hand stays at its ends. force_delay: of a force after its arrival, at least 0.
  RerunHand(haptic::MonotoneCubic intention, const haptic::HandImpedance& impedance, sync::Nanoseconds force_delay)
      : hand_(std::move(intention), false, impedance), felt_(force_delay) {}
  // Host time at which the simulated time is 0. Before the call the hand is at the begin of its intention.
  void begin(sync::HostTime at) { hand_.begin(at); }
  // A force on the hand, N, that arrived at this time.
  void push(sync::HostTime arrival, const Eigen::Vector3d& force_N) { felt_.push(arrival, force_N); }
  // One tick: the hand at `now`. The newest force that is due acts from this tick until the next one; the hand is free when no force has
  // arrived for the time of haptic::Device::kWatchdog.
  haptic::DeviceState tick(sync::HostTime now);

 private:
  haptic::VirtualHand hand_;
  DelayedForce felt_;
  std::optional<sync::HostTime> renewed_;  // tick of the newest force; empty: no force acts
};

// A command to the simulation and its time after the first touch model of its run.
struct RecordedCommand {
  sync::Nanoseconds after{};
  sim_command_t command;
};

// The SIM_COMMAND messages of one run of a log, in the order of their times; those before the first touch model have the time 0. Throws
// std::runtime_error with one sentence.
std::vector<RecordedCommand> recorded_commands(const std::string& log, int run);

// Returns the exit status; when it is not 0, one sentence on stderr gives the reason.
int run_rerun_hand(int argc, char** argv);

}  // namespace tactus
