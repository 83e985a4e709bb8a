// What a body was given since the touch model told of it last, estimated: the pushes that it has not told of are
// played again on a mass that moves as it was told.
//
//   m du/dt = g - h,   W = integral of g u
//
//   u  speed of the body along the push, at first as it was told
//   g  push along its surface's normal, as it was felt
//   h  with which others held it against the push lately; below zero: drew it away
//
// Rather too much is taken for given than too little: what holds the body stops it and does not drive it back, and
// it comes towards the hand by its own motion alone. After a while nothing is believed to hold it any more (what
// draws it away still may), and one that came may have swung and be on its way back. Along the surface it moves on
// as it was told. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus::haptic {

class PendingEnergyEstimator {
 public:
  // As the touch model of sim_ns told of a body; impulse_N_s: that of all that give() was told of it, which had
  // reached the body then.
  struct Told {
    std::int64_t sim_ns = -1;
    double mass_kg = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d impulse_N_s = Eigen::Vector3d::Zero();
  };
  // most_N: no force on it is larger. Realtime-safe: yes.
  void tell(const Told& told, double most_N);
  // The same of a model that tells no more how it moves.
  void tell(const Eigen::Vector3d& impulse_N_s);
  // One tick has passed with this force on the body. Realtime-safe: yes.
  void give(const Eigen::Vector3d& force_N, double dt);
  // J; what was felt longer ago than window_s the model knew of. Realtime-safe: yes.
  double energy_J(double window_s, double most_N);

  // Estimated, now.
  Eigen::Vector3d velocity() const {
    return told_.velocity - (speed_m_s_ + told_.velocity.dot(told_.normal)) * told_.normal;
  }
  // Felt in all.
  const Eigen::Vector3d& given_N_s() const { return given_N_s_; }
  // Nothing is unseen, and so much was felt.
  void settle(const Eigen::Vector3d& impulse_N_s);
  void settle() { settle(told_.impulse_N_s); }

 private:
  // Of about a millisecond; longer delays than all of them leave a coupling next to nothing (coupling.h).
  struct Push {
    double impulse_N_s = 0, dt = 0;
  };
  void play(double window_s, double unseen_N_s);
  void advance(double push_N, double dt);
  double on_its_way_back_m_s() const;

  std::array<Push, 128> pushes_{};
  std::size_t newest_ = 0, count_ = 0;
  Eigen::Vector3d given_N_s_ = Eigen::Vector3d::Zero();
  Told told_;
  double held_N_ = 0;
  // Since it was told.
  double since_s_ = 0, speed_m_s_ = 0, work_J_ = 0;
  bool fresh_ = false;
};

}  // namespace tactus::haptic
