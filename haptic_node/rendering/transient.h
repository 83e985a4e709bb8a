// The hit transient: a short decaying vibration at each hit, which a coupling of finite stiffness cannot render
// (Kuchenbecker, Fiene and Niemeyer 2006). F(t) = A exp(-decay t) sin(2 pi f t), as tapped materials ring
// (Okamura, Cutkosky and Dennerlein 2001). Its first half wave carries the momentum of the hit: A = gain pi f m v.
//
// A transient acts on the hand only, and no body receives its reaction. So its impulse is taken back, slower than any
// vibration that it renders: a high pass of the first order, at 3 Hz. Hand and bodies then receive the same impulse.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "sync/presentation/late.h"
#include "sync/time/time.h"

namespace tactus::haptic {

// A late transient is dropped, not reduced: a weaker one would suggest another material.
inline constexpr sync::LateRule kLatePolicy = sync::LateRule::kDrop;

struct TransientShape {
  double gain = 1;
  double limit_N = 3;  // of each transient and of their sum
  double soft_frequency_Hz = 30;
  double hard_frequency_Hz = 300;
  double decay_1_s = 80;
  sync::LatePolicy late{kLatePolicy, sync::Nanoseconds(7'500'000), sync::Nanoseconds(15'000'000)};
};

struct Hit {
  std::int64_t event_id = 0;
  sync::HostTime scheduled{};
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // of the force on the hand, unit vector
  double approach_speed_m_s = 0;
  double effective_mass_kg = 0;
  double youngs_modulus_Pa = 0;  // of the hit body; 0: not known, treated as hard
};

// Interpolates between rubber and aluminium, on logarithmic scales of modulus and frequency.
double transient_frequency_Hz(double youngs_modulus_Pa, const TransientShape& shape);
double transient_amplitude_N(const Hit& hit, const TransientShape& shape);

class Transients {
 public:
  // Hits of a minute, the longest delay of a profile, at 60 a second; and the newest ringing ones.
  static constexpr std::size_t kMaxPending = 4096, kMaxActive = 16;

  explicit Transients(const TransientShape& shape) : shape_(shape) {
    pending_.reserve(kMaxPending);
    active_.reserve(kMaxActive);
  }

  // Applies to transients that begin from now on.
  void change(const TransientShape& shape) { shape_ = shape; }

  // Every hit gets exactly one report: here when the queue is full, otherwise in a later step.
  void schedule(const Hit& hit, std::vector<presentation_t>& reports);
  // Stores the impulse that transients gave to the hand since the last step, after all limits, N s.
  void add_felt_impulse(const Eigen::Vector3d& impulse_N_s) { felt_N_s_ += impulse_N_s; }
  // Stops all transients that have begun, without taking back their impulse: the device has dropped the force.
  void stop();
  // Force on the hand over the tick that begins now, N (value at mid tick). felt: false when no force reaches the
  // hand; due hits are then dropped. Realtime-safe: yes.
  Eigen::Vector3d step(sync::HostTime now, double dt, bool felt, sync::Nanoseconds uncertainty,
                       std::vector<presentation_t>& reports);

 private:
  struct ActiveTransient {
    Eigen::Vector3d direction;
    double amplitude_N, frequency_Hz;
    sync::HostTime start;
  };
  void begin(const Hit& hit, sync::HostTime now);

  TransientShape shape_;
  std::vector<Hit> pending_;
  std::vector<ActiveTransient> active_;
  Eigen::Vector3d felt_N_s_ = Eigen::Vector3d::Zero();  // given to the hand and not yet taken back
};

}  // namespace tactus::haptic
