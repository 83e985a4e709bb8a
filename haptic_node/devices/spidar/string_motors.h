// The motors of a string frame as their amplifier shows them: counts in, tensions out. What drives real ones
// implements this; SimulatedStrings is a frame of mathematics.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptic_node/devices/spidar/string_frame.h"
#include "sync/time/time.h"

namespace tactus::haptic {

// Counts since the grip was held in the middle of its frame; positive is longer.
using Counts = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1, 0, kMaxStrings, 1>;

class StringMotors {
 public:
  virtual ~StringMotors() = default;
  virtual void begin(sync::HostTime) {}
  // Call once a tick, then write once.
  virtual Counts read(sync::HostTime now) = 0;
  virtual void write(const PerString& tensions_N) = 0;
};

}  // namespace tactus::haptic
