// Motion of a contact over the surfaces of its two bodies, split into sliding and rolling. Pure.
//
// Let c_a and c_b be the velocities of the contact over the two surfaces, and s the velocity of the surface of b
// relative to that of a: then c_a - c_b = s. Their common part is rolling: a rolling ball has c_a = c_b, a sliding
// tip c_b = 0.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <tactus/contact_t.hpp>

namespace tactus::audio {

// m/s, world frame.
struct ContactVelocity {
  std::array<Eigen::Vector3d, 2> surface{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // c_a, c_b
  Eigen::Vector3d rolling = Eigen::Vector3d::Zero();
};
// Continuous; zero while one of the two is zero or they point in opposite directions.
Eigen::Vector3d rolling_of(const Eigen::Vector3d& over_a, const Eigen::Vector3d& over_b);

// Detects motion: a contact that rests under load creeps and jitters without slipping, since the junctions yield
// first, by about 10 um (Rabinowicz 1951, Proc. Phys. Soc. A 64, p. 668; unverified).
class Presliding {
 public:
  void step(const Eigen::Vector3d& velocity_m_s, double dt_s);
  // 0: has not left its place recently; 1: has left it.
  double moving() const;

 private:
  Eigen::Vector3d displacement_m_ = Eigen::Vector3d::Zero();  // recent displacement
};

// Motion of one contact, over its whole duration.
class ContactMotion {
 public:
  // to_body: rotations from world to body, where known; at least one is known, and `reference_side` is the index
  // of a known one. sliding_m_s: velocity of the surface of b relative to that of a, bounded.
  void step(const contact_t& contact, const std::array<std::optional<Eigen::Quaterniond>, 2>& to_body,
            std::size_t reference_side, const Eigen::Vector3d& sliding_m_s, double dt_s);

  const ContactVelocity& velocity() const { return velocity_; }
  // In the frame of each body: as received, but continuous between messages, at 1 kHz or at 60 Hz.
  const Eigen::Vector3d& place_m(std::size_t side) const { return sides_[side].place_m; }
  // Index of the contact point in use, of the latest message.
  std::size_t point() const { return point_; }
  // 0 .. 1: degree to which it slides, or rolls.
  double sliding_degree() const { return sliding_detector_.moving(); }
  double rolling_degree() const { return rolling_detector_.moving(); }

 private:
  struct Side {
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> received_m;
    double since_s = 0;  // time since the last message
  };
  double motion_share(const Eigen::Vector3d& place, const Eigen::Vector3d& along);
  static void track(Side& side, const Eigen::Vector3d& received_m, const Eigen::Vector3d& step_m, double dt_s);

  std::array<Side, 2> sides_;
  ContactVelocity velocity_;
  std::size_t point_ = 0;
  Presliding sliding_detector_, rolling_detector_;
  // Share of recent sliding that was motion over the reference surface.
  std::optional<Eigen::Vector3d> observed_at_m_;
  double observed_distance_m_ = 0, observed_s_ = 0, motion_share_ = 1;
};

}  // namespace tactus::audio
