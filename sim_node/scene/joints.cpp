#include "sim_node/scene/joints.h"

#include <cmath>
#include <optional>
#include <sdf/JointAxis.hh>

#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/sdf/sdf_eigen.h"

namespace tactus::sim {
namespace {

// world_def.h: limits beyond 1e15 mean none. SDF writes none as 1e16 or inf.
constexpr double kNoLimit = 1e16;
// Target speed of a motor without one, rad/s or m/s: high enough for a constant torque.
constexpr double kFreeSpeed = 1000;

std::optional<JointKind> kind_of(sdf::JointType type) {
  switch (type) {
    case sdf::JointType::FIXED: return JointKind::kFixed;
    case sdf::JointType::REVOLUTE:
    case sdf::JointType::CONTINUOUS: return JointKind::kRevolute;
    case sdf::JointType::PRISMATIC: return JointKind::kPrismatic;
    case sdf::JointType::UNIVERSAL: return JointKind::kUniversal;
    case sdf::JointType::BALL: return JointKind::kBall;
    default: return std::nullopt;
  }
}

int body_of(const LoadContext& context, const std::string& scope, const std::string& link, const sdf::Element& element) {
  if (link == "world") return -1;
  const auto known = context.body_of.find(scope + link);
  if (known == context.body_of.end()) context.reject(element, "connects \"" + link + "\": there is no such link");
  return known->second;
}

JointAxis read_axis(const LoadContext& context, const sdf::JointAxis& from, bool has_limits,
                    const Eigen::Isometry3d& model_pose) {
  const sdf::Element& element = *from.Element();
  ignition::math::Vector3d xyz;
  const sdf::Errors errors = from.ResolveXyz(xyz, "__model__");
  if (!errors.empty()) context.reject(element, "has no direction: " + errors.front().Message());
  JointAxis axis;
  axis.axis = model_pose.linear() * to_eigen(xyz);
  if (!axis.axis.allFinite() || axis.axis.norm() < 1e-9)
    context.reject(element, "has no direction: its <xyz> is zero");
  axis.axis.normalize();
  axis.damping = from.Damping(), axis.friction = from.Friction();
  axis.stiffness = from.SpringStiffness(), axis.reference = from.SpringReference();
  for (const double value : {axis.damping, axis.friction, axis.stiffness})
    if (!(value >= 0 && value < 1e9))
      context.reject(element, "has a damping, friction or stiffness that is negative or not finite");
  if (!std::isfinite(axis.reference)) context.reject(element, "has a <spring_reference> that is not finite");
  if (has_limits) {
    if (std::isnan(from.Lower()) || std::isnan(from.Upper()) || from.Lower() > from.Upper())
      context.reject(element, "has a lower limit above its upper limit");
    axis.lower = std::max(from.Lower(), -kNoLimit), axis.upper = std::min(from.Upper(), kNoLimit);
  }
  if (from.Effort() >= 0 && from.Effort() < 1e15) axis.effort = from.Effort();
  return axis;
}

void read_motor(const LoadContext& context, const sdf::ElementPtr& element, JointDef& joint) {
  const sdf::ElementPtr motor = explicit_child(element, "tactus:motor");
  if (!motor) return;
  Attributes attributes(context, *motor);
  const bool linear = joint.kind == JointKind::kPrismatic;
  if (joint.kind == JointKind::kFixed || joint.kind == JointKind::kBall)
    context.reject(*motor, "is on a joint without an axis");
  const int axes = joint.kind == JointKind::kUniversal ? 2 : 1;
  const int index = static_cast<int>(attributes.quantity("axis", "1", 1, axes).value_or(1));
  const double effort = linear ? attributes.required_quantity("force", "N", -1e6, 1e6)
                               : attributes.required_quantity("torque", "N m", -1e6, 1e6);
  const double speed = attributes.quantity("velocity", linear ? "m/s" : "rad/s", 0, 1e6).value_or(kFreeSpeed);
  attributes.done();
  JointAxis& axis = joint.axes[index - 1];
  axis.motor_effort = axis.effort >= 0 ? std::min(std::abs(effort), axis.effort) : std::abs(effort);
  axis.motor_velocity = effort < 0 ? -speed : speed;
}

}  // namespace

void add_joint(LoadContext& context, const sdf::Joint& from, const Eigen::Isometry3d& model_pose,
               const std::string& scope) {
  const sdf::ElementPtr element = from.Element();
  const auto kind = kind_of(from.Type());
  if (!kind) {
    context.warn(*element, "has type \"" + element->Get<std::string>("type") + "\", which is not supported: it is left out");
    return;
  }
  std::string parent, child;
  const sdf::Errors no_parent = from.ResolveParentLink(parent), no_child = from.ResolveChildLink(child);
  for (const auto& errors : {no_parent, no_child})
    if (!errors.empty()) context.reject(*element, "connects nothing: " + errors.front().Message());
  JointDef joint;
  joint.name = scope + from.Name();
  joint.kind = *kind;
  joint.parent = body_of(context, scope, parent, *element);
  joint.child = body_of(context, scope, child, *element);
  if (joint.parent == joint.child) context.reject(*element, "connects a link with itself");
  joint.anchor_m = (model_pose * context.resolve(from.SemanticPose(), *element, "__model__")).translation();
  const unsigned axes = *kind == JointKind::kUniversal ? 2 : *kind == JointKind::kFixed || *kind == JointKind::kBall ? 0 : 1;
  for (unsigned i = 0; i < axes; ++i) {
    const sdf::JointAxis* axis = from.Axis(i);
    if (!axis) context.reject(*element, "lacks its <axis" + std::string(i ? "2" : "") + ">");
    joint.axes[i] = read_axis(context, *axis, from.Type() != sdf::JointType::CONTINUOUS, model_pose);
  }
  if (axes == 2 && joint.axes[0].axis.cross(joint.axes[1].axis).norm() < 1e-6)
    context.reject(*element, "has two axes in one direction");
  read_motor(context, element, joint);
  if (joint.parent >= 0 && joint.child >= 0) {
    context.world.no_collision.emplace_back(std::min(joint.parent, joint.child), std::max(joint.parent, joint.child));
    const auto is_static = [&](int b) { return context.world.bodies[static_cast<std::size_t>(b)].is_static; };
    if (is_static(joint.parent) && is_static(joint.child)) return;  // the joint cannot move anything
  }
  context.world.joints.push_back(joint);
}

}  // namespace tactus::sim
