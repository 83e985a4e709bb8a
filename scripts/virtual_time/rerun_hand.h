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
