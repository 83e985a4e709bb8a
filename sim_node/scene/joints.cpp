#include "sim_node/scene/joints.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim {
namespace {

// world_def.h: limits beyond 1e15 mean none. SDF writes none as 1e16 or inf.
constexpr double kNoLimit = 1e16;
// Target speed of a motor without one, rad/s or m/s: high enough for a constant torque.
constexpr double kFreeSpeed = 1000;

struct JointType {
  std::string_view name;
  std::optional<JointKind> kind;  // nullopt: not supported
};
constexpr JointType kTypes[] = {{"fixed", JointKind::kFixed},         {"revolute", JointKind::kRevolute},
                                {"continuous", JointKind::kRevolute}, {"prismatic", JointKind::kPrismatic},
                                {"universal", JointKind::kUniversal}, {"ball", JointKind::kBall},
                                {"revolute2", std::nullopt},          {"gearbox", std::nullopt},
                                {"screw", std::nullopt}};

const JointType& type_of(const sdf::Element& joint) {
  std::string name(joint.value("type"));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const JointType& type : kTypes)
    if (name == type.name) return type;
  std::string names;
  for (const JointType& type : kTypes) names += (names.empty() ? "" : ", ") + std::string(type.name);
  sdf::reject(joint, "has type \"" + name + "\": there are " + names);
}

// The body that an end of the joint moves with; -1: the world.
int body_of(const LoadContext& context, const sdf::Element& joint, const char* name) {
  const sdf::Element* end = joint.child(name);
  if (!end || end->text.empty()) context.reject(joint, "lacks its <" + std::string(name) + ">");
  const sdf::Element* link = context.frames.link(*end);
  if (link) return context.body_of_link.at(link);
  if (end->name == "child") context.reject(*end, "is the world, which does not move: exchange parent and child");
  return -1;
}

void read_dynamics(const LoadContext& context, const sdf::Element* dynamics, JointAxis& axis) {
  const auto value = [&](const char* name) { return sdf::child_number(dynamics, name, 0); };
  axis.damping = value("damping"), axis.friction = value("friction");
  axis.stiffness = value("spring_stiffness"), axis.reference = value("spring_reference");
  for (const double each : {axis.damping, axis.friction, axis.stiffness})
    if (!(each >= 0 && each < 1e9))
      context.reject(*dynamics, "has a damping, friction or stiffness that is negative or not finite");
}

void read_limit(const LoadContext& context, const sdf::Element* limit, bool has_limits, JointAxis& axis) {
  const auto value = [&](const char* name, double missing) {
    const sdf::Element* given = sdf::child_of(limit, name);
    return given ? sdf::number_or_infinity(*given) : missing;
  };
  if (has_limits) {
    const double lower = value("lower", -kNoLimit), upper = value("upper", kNoLimit);
    if (lower > upper) context.reject(*limit, "has a lower limit above its upper limit");
    axis.lower = std::max(lower, -kNoLimit), axis.upper = std::min(upper, kNoLimit);
    if (lower > 0 || upper < 0)
      context.warn(*limit, "excludes 0, at which the joint starts: the simulation moves it to the nearer limit within seconds");
  }
  const double effort = value("effort", -1);
  if (effort >= 0 && effort < 1e15) axis.effort = effort;
}

JointAxis read_axis(const LoadContext& context, const sdf::Element& from, bool has_limits,
                    const Eigen::Isometry3d& model_pose) {
  JointAxis axis;
  axis.axis = model_pose.linear() * context.frames.direction(from);
  if (!axis.axis.allFinite() || axis.axis.norm() < 1e-9)
    context.reject(from, "has no direction: its <xyz> is zero");
  axis.axis.normalize();
  read_dynamics(context, from.child("dynamics"), axis);
  read_limit(context, from.child("limit"), has_limits, axis);
  return axis;
}

void read_motor(const LoadContext& context, const sdf::Element& element, JointDef& joint) {
  const sdf::Element* motor = element.child("tactus:motor");
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

void add_joint(LoadContext& context, const sdf::Element& from, const Eigen::Isometry3d& model_pose,
               const std::string& scope) {
  const JointType& type = type_of(from);
  const auto& kind = type.kind;
  if (!kind) {
    context.warn(from, "has type \"" + std::string(type.name) + "\", which is not supported: it is left out");
    return;
  }
  JointDef joint;
  joint.name = scope + std::string(from.value("name"));
  joint.kind = *kind;
  joint.parent = body_of(context, from, "parent");
  joint.child = body_of(context, from, "child");
  if (joint.parent == joint.child) {
    context.warn(from, "connects a link with itself and has no effect");
    return;
  }
  joint.anchor_m = (model_pose * context.resolve(from)).translation();
  const unsigned axes = *kind == JointKind::kUniversal ? 2 : *kind == JointKind::kFixed || *kind == JointKind::kBall ? 0 : 1;
  for (unsigned i = 0; i < axes; ++i) {
    const sdf::Element* axis = from.child(i ? "axis2" : "axis");
    if (!axis) context.reject(from, "lacks its <axis" + std::string(i ? "2" : "") + ">");
    joint.axes[i] = read_axis(context, *axis, type.name != "continuous", model_pose);
  }
  if (axes == 2 && joint.axes[0].axis.cross(joint.axes[1].axis).norm() < 1e-6)
    context.reject(from, "has two axes in one direction");
  read_motor(context, from, joint);
  if (joint.parent >= 0 && joint.child >= 0) {
    context.world.no_collision.emplace_back(std::min(joint.parent, joint.child), std::max(joint.parent, joint.child));
    const auto is_static = [&](int b) { return context.world.bodies[static_cast<std::size_t>(b)].is_static; };
    if (is_static(joint.parent) && is_static(joint.child)) return;  // the joint cannot move anything
  }
  context.world.joints.push_back(joint);
}

}  // namespace tactus::sim
