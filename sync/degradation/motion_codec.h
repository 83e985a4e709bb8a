// The motion of a hand at the receiver of a deadband: between two messages that are sent, it holds the value that the deadband
// compares, or predicts it. With a deadband on velocity the receiver integrates the velocity, with one on position the velocity
// is that of the last message. Orientations are held. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <tactus/tool_state_t.hpp>

#include "sync/degradation/deadband.h"
#include "sync/time/time.h"

namespace tactus::sync {

class MotionCodec {
 public:
  // A message that was sent; t: the time of the deadband.
  void add(SimTime t, const tool_state_t& sent, const DeadbandDef& deadband);
  // Replaces the motion in a message that was suppressed by the motion that the receiver has at t; forces, constraints and
  // header stay. Returns false, and changes nothing, when no message of its sender was sent before.
  bool reconstruct(SimTime t, tool_state_t& suppressed) const;

 private:
  // Device, or proxy. Values are in m, m/s, rad/s.
  struct Part {
    Prediction value;  // of the quantity that the deadband compares
    Eigen::Vector3d position_m, velocity_m_s;
    quat_t orientation;
  };
  std::array<Part, 2> parts_;
  Quantity quantity_ = Quantity::kVelocity;
  Predictor predictor_ = Predictor::kHold;
  std::int64_t incarnation_ = 0;
  bool any_ = false;
};

}  // namespace tactus::sync
