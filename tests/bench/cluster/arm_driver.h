// The driver of the external device "arm" of pressed.sdf, as a program of virtual time: a weight on springs whose rest
// position strokes and taps. ForceGuard of the examples stands before it, as before every real device.
#pragma once

#include <array>
#include <functional>

#include "examples/device_driver/guards.h"
#include "sync/time/time.h"

namespace tactus::bench {

// The force on the hand in one tick of the driver, after its guard.
struct ArmTick {
  sync::HostTime time;
  examples::Exerted exerted;
  examples::Vector position_m{}, velocity_m_s{};
};

// A weight of 0.1 kg, held by the springs and dampers of a hand (300 N/m, 10 N s/m, as in examples/device_driver/driver.cpp).
class ArmHardware {
 public:
  // One step of 1 ms with this force, N.
  void step(double time_s, const examples::Vector& force_N);
  const examples::Vector& position_m() const { return position_m_; }
  const examples::Vector& velocity_m_s() const { return velocity_m_s_; }

 private:
  examples::Vector position_m_{-0.03, 0, 0.03}, velocity_m_s_{};
};

// Runs until it is asked to stop, at 1 kHz. on_tick: called after each tick.
int run_arm_driver(std::int64_t run_id, const std::function<void(const ArmTick&)>& on_tick);

}  // namespace tactus::bench
