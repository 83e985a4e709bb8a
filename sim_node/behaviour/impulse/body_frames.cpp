#include "sim_node/behaviour/impulse/body_frames.h"

namespace tactus::sim::impulse {

BodyFrames::BodyFrames(const WorldDef& def) {
  for (const BodyDef& b : def.bodies) frames_.push_back({b.centre_of_mass_m, Eigen::Quaterniond::Identity()});
  for (const JointDef& j : def.joints)
    for (const int body : {j.parent, j.child}) {
      if (body < 0) continue;
      const auto i = static_cast<std::size_t>(body);
      if (!def.bodies[i].is_static) frames_[i].at_rest = Eigen::Quaterniond(def.bodies[i].pose.linear()).normalized();
    }
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    Frame& f = frames_[i];
    const BodyDef& b = def.bodies[i];
    f.in_body = b.is_static || b.tool >= 0 ? b.pose.inverse()
                                           : Eigen::Translation3d(f.centre_in_body_m) * f.at_rest.conjugate();
  }
}

std::vector<BodyMotion> BodyFrames::at_start(const WorldDef& def) const {
  std::vector<BodyMotion> out;
  for (const BodyDef& b : def.bodies) {
    BodyMotion& m = out.emplace_back();
    m.position_m = b.pose.translation();
    m.orientation = Eigen::Quaterniond(b.pose.linear()).normalized();
    m.centre_m = b.pose * b.centre_of_mass_m;
    if (b.is_static || b.tool >= 0) continue;
    const Eigen::Matrix3d r = m.orientation.toRotationMatrix();
    m.inverse_mass_1_kg = 1 / b.mass_kg;
    m.inverse_inertia = r * b.inertia_kg_m2.inverse() * r.transpose();
    m.velocity_m_s = b.velocity_m_s;
  }
  return out;
}

BodyMotion BodyFrames::motion(int body, const BodyMotion& moved) const {
  const Frame& f = frames_[static_cast<std::size_t>(body)];
  BodyMotion m = moved;
  m.orientation = moved.orientation * f.at_rest;
  m.position_m = m.centre_m - m.orientation * f.centre_in_body_m;
  return m;
}

void BodyFrames::place_impacts(std::span<Manifold> solved) const {
  for (Manifold& m : solved) {
    if (m.impact.count == 0) continue;
    m.impact.a_body_m = frames_[static_cast<std::size_t>(m.body_a)].in_body * m.impact.a_body_m;
    m.impact.b_body_m = frames_[static_cast<std::size_t>(m.body_b)].in_body * m.impact.b_body_m;
  }
}

}  // namespace tactus::sim::impulse
