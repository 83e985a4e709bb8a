// The Weber deadband: an update is sent only when it differs noticeably from the last update that was sent (Hinterseer,
// Hirche, Chaudhuri, Steinbach and Buss 2008, "Perception-based data reduction and transmission of haptic data"). Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <span>

#include "sync/time/time.h"

namespace tactus::sync {

// The first three are quantities of a profile. An impulse is input of TouchForces only; a stiffness (of a surface of touch) is
// scaled by a gain of force, because the force with which the surface responds is proportional to it, and changed by no other
// operator.
enum class Quantity : std::uint8_t { kForce, kVelocity, kPosition, kImpulse, kStiffness };

// One signal of a snapshot: its id (of a contact, body or plane) and its value in N, m/s, m or N s.
struct Signal {
  std::int64_t id = 0;
  Quantity quantity = Quantity::kForce;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

// "10% velocity floor=0.01m/s lowpass=20Hz adaptive=0.2s/m".
struct DeadbandDef {
  double fraction = 0;  // k, as a share of the last value sent
  Quantity quantity = Quantity::kVelocity;
  double floor = 0;       // minimum size of the band, in the unit of the quantity
  double lowpass_Hz = 0;  // of the signal before it is compared, first order; 0: none
  // Growth of the fraction per m/s of speed, in s/m (Kammerl, Vittorias, Nitsch, Faerber, Steinbach and Hirche 2010,
  // "Perception-based data reduction for haptic force-feedback signals using velocity-adaptive deadbands").
  double adaptive_s_m = 0;
};

class Deadband {
 public:
  explicit Deadband(const DeadbandDef& def) : def_(def) {}

  // Returns true when the snapshot must be sent: a signal left its band, appeared or disappeared. speed_m_s: of the moving
  // object, for the adaptive form.
  bool send(SimTime t, std::span<const Signal> signals, double speed_m_s);

 private:
  struct Memory {
    Eigen::Vector3d filtered, sent;
    bool present;  // present in this snapshot
  };
  DeadbandDef def_;
  std::map<std::int64_t, Memory> memory_;
  SimTime last_{};
  bool started_ = false;
};

}  // namespace tactus::sync
