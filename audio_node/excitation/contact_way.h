// How a contact goes over the surfaces of its two bodies: what of it is sliding, what rolling. Pure.
//
// Let c_a and c_b be the velocities of the contact over the two surfaces, and s that of b's surface past a's: then
// c_a - c_b = s. What both have in common is rolling: a ball that rolls has c_a = c_b, a tip that slides c_b = 0.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <tactus/contact_t.hpp>

namespace tactus::audio {

// m/s, world frame.
struct Over {
  std::array<Eigen::Vector3d, 2> surface{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // c_a, c_b
  Eigen::Vector3d rolling = Eigen::Vector3d::Zero();
};
// Continuous: while either of the two stays where it is, or they go apart, nothing rolls.
Eigen::Vector3d rolling_of(const Eigen::Vector3d& over_a, const Eigen::Vector3d& over_b);

// Whether something moves at all: a contact that rests under load creeps and jitters without slipping, since the
// junctions give first, by some 10 um (Rabinowicz 1951, Proc. Phys. Soc. A 64, p. 668).
class Presliding {
 public:
  void step(const Eigen::Vector3d& velocity_m_s, double dt_s);
  // 0: it has not left its place lately; 1: it has.
  double moving() const;

 private:
  Eigen::Vector3d way_m_ = Eigen::Vector3d::Zero();  // lately
};

// Of one contact, as long as it lasts.
class ContactWay {
 public:
  // to_body: how the bodies are turned, where that is known; at least one is, and `surest` is one of these.
  // past_m_s: of b's surface past a's, bounded.
  void step(const contact_t& contact, const std::array<std::optional<Eigen::Quaterniond>, 2>& to_body,
            std::size_t surest, const Eigen::Vector3d& past_m_s, double dt_s);

  const Over& over() const { return over_; }
  // In the frame of each body: as told, but steady between what is told, at 1 kHz or at 60 Hz.
  const Eigen::Vector3d& place_m(std::size_t side) const { return sides_[side].place_m; }
  // Of the pairs of points that were told last that which the contact is at.
  std::size_t point() const { return point_; }
  // 0 .. 1: whether it slides, or rolls, at all.
  double slides() const { return slid_.moving(); }
  double rolls() const { return rolled_.moving(); }

 private:
  struct Side {
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> told_m;
    double since_s = 0;  // it was told
  };
  double share(const Eigen::Vector3d& place, const Eigen::Vector3d& along);
  static void follow(Side& side, const Eigen::Vector3d& told_m, const Eigen::Vector3d& step_m, double dt_s);

  std::array<Side, 2> sides_;
  Over over_;
  std::size_t point_ = 0;
  Presliding slid_, rolled_;
  // What of the sliding was a way over the surest surface, lately.
  std::optional<Eigen::Vector3d> looked_at_m_;
  double looked_way_m_ = 0, looked_s_ = 0, share_ = 1;
};

}  // namespace tactus::audio
