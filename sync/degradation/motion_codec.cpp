#include "sync/degradation/motion_codec.h"

#include "lcmtypes/vectors.h"

namespace tactus::sync {
namespace {

struct MotionFields {
  pose_t tool_state_t::*pose;
  vec3f_t tool_state_t::*velocity_m_s;
  vec3f_t tool_state_t::*spin_rad_s;
};
constexpr std::array<MotionFields, 2> kMotionFields{{
    {&tool_state_t::device, &tool_state_t::device_velocity_m_s, &tool_state_t::device_spin_rad_s},
    {&tool_state_t::proxy, &tool_state_t::proxy_velocity_m_s, &tool_state_t::proxy_spin_rad_s},
}};

}  // namespace

void MotionCodec::add(SimTime t, const tool_state_t& sent, const DeadbandDef& deadband) {
  const bool continues = any_ && sent.header.incarnation == incarnation_ && deadband.quantity == quantity_ &&
                         deadband.predictor == predictor_;
  quantity_ = deadband.quantity;
  predictor_ = deadband.predictor;
  incarnation_ = sent.header.incarnation;
  any_ = true;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const MotionFields& fields = kMotionFields[i];
    Part& part = parts_[i];
    if (!continues) part.value = Prediction(predictor_);
    part.position_m = to_eigen((sent.*fields.pose).position_m);
    part.velocity_m_s = to_eigen(sent.*fields.velocity_m_s);
    part.orientation = (sent.*fields.pose).orientation;
    part.value.add(t, quantity_ == Quantity::kPosition ? part.position_m : part.velocity_m_s);
  }
}

bool MotionCodec::reconstruct(SimTime t, tool_state_t& suppressed) const {
  if (!any_ || suppressed.header.incarnation != incarnation_) return false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const MotionFields& fields = kMotionFields[i];
    const Part& part = parts_[i];
    const bool of_position = quantity_ == Quantity::kPosition;
    const Eigen::Vector3d position_m = of_position ? part.value.at(t) : part.position_m + part.value.integral(t);
    (suppressed.*fields.pose).position_m = to_vec3(position_m);
    (suppressed.*fields.pose).orientation = part.orientation;
    suppressed.*fields.velocity_m_s = to_vec3f(of_position ? part.velocity_m_s : part.value.at(t));
    suppressed.*fields.spin_rad_s = {};
  }
  return true;
}

}  // namespace tactus::sync
