// Interface of the motors of a string frame: counts in, tensions out. A driver of a real amplifier implements it;
// SimulatedStrings simulates one.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptic_node/devices/spidar/string_frame.h"
#include "sync/time/time.h"

namespace tactus::haptic {

// Counts relative to the grip in the middle of its frame; positive is longer.
using Counts = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1, 0, kMaxStrings, 1>;

class StringMotors {
 public:
  virtual ~StringMotors() = default;
  virtual void begin(sync::HostTime) {}
  // Call once per tick, before write.
  virtual Counts read(sync::HostTime now) = 0;
  virtual void write(const PerString& tensions_N) = 0;
};

}  // namespace tactus::haptic
