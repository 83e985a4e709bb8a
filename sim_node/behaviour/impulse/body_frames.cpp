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

}  // namespace tactus::sim::impulse
