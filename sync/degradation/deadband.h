// The Weber deadband: an update is sent only when it differs noticeably from the value that the receiver has without it
// (Hinterseer, Hirche, Chaudhuri, Steinbach and Buss 2008, "Perception-based data reduction and transmission of haptic data").
// Sender and receiver compute that value in the same way, from the updates that were sent. Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
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

// The value of the receiver between two updates: the last one, or a line through the last two.
enum class Predictor : std::uint8_t { kHold, kLinear };

// "10% velocity floor=0.01m/s lowpass=20Hz adaptive=0.2s/m predict=linear resend=50ms".
struct DeadbandDef {
  double fraction = 0;  // k, as a share of the value that the receiver has
  Quantity quantity = Quantity::kVelocity;
  double floor = 0;       // minimum size of the band, in the unit of the quantity
  double lowpass_Hz = 0;  // of the signal before it is compared, first order; 0: none
  // Growth of the fraction per m/s of speed, in s/m (Kammerl, Vittorias, Nitsch, Faerber, Steinbach and Hirche 2010,
  // "Perception-based data reduction for haptic force-feedback signals using velocity-adaptive deadbands").
  double adaptive_s_m = 0;
  Predictor predictor = Predictor::kHold;
  double resend_s = 0;  // an update is sent at the latest this time after the last one, s; 0: no such limit
};

// The value that a receiver has between two updates.
class Prediction {
 public:
  // The line through two updates is followed for at most this multiple of the time between them, and at most kMaxReach_s: after
  // the loss of an update, the value does not run away. Design.
  static constexpr double kReach = 50, kMaxReach_s = 1;

  explicit Prediction(Predictor predictor = Predictor::kHold) : predictor_(predictor) {}
  // An update. An update that is not later than the last one begins a new line.
  void add(SimTime t, const Eigen::Vector3d& value);
  // The value at t; before the first update zero, before the newest one that update.
  Eigen::Vector3d at(SimTime t) const;
  // Integral of the value from the newest update to t, in its unit times s; 0 before the first update.
  Eigen::Vector3d integral(SimTime t) const;
  bool empty() const { return !time_; }

 private:
  Predictor predictor_;
  std::optional<SimTime> time_;  // of the newest update
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero(), slope_1_s_ = Eigen::Vector3d::Zero();
  double reach_s_ = 0;
};

class Deadband {
 public:
  explicit Deadband(const DeadbandDef& def) : def_(def) {}

  // Returns true when the snapshot must be sent: a signal left its band, appeared or disappeared, or the last update is too old.
  // speed_m_s: of the moving object, for the adaptive form.
  bool send(SimTime t, std::span<const Signal> signals, double speed_m_s);
  // True after the first update, which is always sent.
  bool has_sent() const { return started_; }

 private:
  struct Memory {
    Eigen::Vector3d filtered;
    Prediction received;
    bool present;  // present in this snapshot
  };
  DeadbandDef def_;
  std::map<std::int64_t, Memory> memory_;
  SimTime last_{}, last_sent_{};
  bool started_ = false;
};

}  // namespace tactus::sync
