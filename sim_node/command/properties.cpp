#include "sim_node/command/properties.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace tactus::sim {
namespace {

using Eigen::Vector3d;
using impulse::SceneChange;

// Ranges are design values for objects and motions in a room. 20 m/s is the speed up to which bodies are proven not
// to pass through each other; 200 rad/s is twice the speed of a fan at 16 Hz.
constexpr std::array kProperties{
    PropertyRow{Owner::kWorld, "gravity", "m/s^2", 3, -100, 100, "its direction and size"},
    PropertyRow{Owner::kBody, "mass", "kg", 1, 1e-4, 1e4,
                "the inertia follows in proportion; not of a body on a joint"},
    PropertyRow{Owner::kBody, "pose", "m, rad", 6, -100, 100,
                "x y z roll pitch yaw of its frame; not of a body on a joint"},
    PropertyRow{Owner::kBody, "velocity", "m/s", 3, -20, 20, "of its centre of mass"},
    PropertyRow{Owner::kBody, "spin", "rad/s", 3, -200, 200, "about the axes of the world"},
    PropertyRow{Owner::kBody, "friction", "1", 1, 0, 10, "of all its shapes; a pair takes the geometric mean"},
    PropertyRow{Owner::kBody, "restitution", "1", 1, 0, 1, "of all its shapes; a pair takes the smaller"},
    PropertyRow{Owner::kJoint, "motor", "N m, rad/s", 2, -1000, 1000,
                "torque, and the speed up to which it acts; of a slider N and m/s; 0 0 removes the motor"},
    PropertyRow{Owner::kJoint, "friction", "N m", 1, 0, 100, "dry friction; of a slider N"},
};

// design: five times the default of tool_force_limit, and the same force at the end of a rod of 10 cm
constexpr double kMaxForce_N = 100, kMaxTorque_N_m = 10;
constexpr sync::Nanoseconds kMaxPush = std::chrono::seconds(10);

const char* owner_text(Owner owner) {
  return owner == Owner::kWorld ? "the world" : owner == Owner::kBody ? "a body" : "a joint";
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

std::string unknown_name(const std::string& name) {
  return "there is no body and no joint " + quoted(name) + " in this scene; the world itself is called \"world\"";
}

std::string unknown_property(Owner owner, const std::string& name) {
  std::string known;
  for (const PropertyRow& row : kProperties)
    if (row.owner == owner) known += (known.empty() ? "" : ", ") + std::string(row.name);
  return std::string(owner_text(owner)) + " has no property " + quoted(name) + "; it has " + known;
}

std::string check_values(const PropertyRow& row, std::span<const double> values) {
  std::ostringstream error;
  if (values.size() != row.count)
    error << row.name << " takes " << row.count << (row.count == 1 ? " number" : " numbers") << " (" << row.unit
        << "), not " << values.size();
  else if (!std::all_of(values.begin(), values.end(), [&](double x) { return x >= row.low && x <= row.high; }))
    error << row.name << " must be between " << row.low << " and " << row.high << " " << row.unit;
  return error.str();
}

Eigen::Isometry3d pose_of(std::span<const double> n) {
  return Eigen::Translation3d(n[0], n[1], n[2]) * Eigen::AngleAxisd(n[5], Vector3d::UnitZ()) *
         Eigen::AngleAxisd(n[4], Vector3d::UnitY()) * Eigen::AngleAxisd(n[3], Vector3d::UnitX());
}

std::string check_movable(const WorldDef& world, int body) {
  const BodyDef& b = world.bodies[static_cast<std::size_t>(body)];
  if (b.tool >= 0) return quoted(b.name) + " is held by a hand and cannot be set";
  if (b.is_static) return quoted(b.name) + " is fixed in this scene";
  return "";
}

std::string set_of_body(Simulation& s, const WorldDef& world, int body, const std::string& property,
                        std::span<const double> v) {
  const std::string& name = world.bodies[static_cast<std::size_t>(body)].name;
  const std::string on_joint = quoted(name) + " is on a joint; its pose and mass cannot be set";
  if (property == "friction") {
    s.set_friction(body, v[0]);
    return "";
  }
  if (property == "restitution") {
    s.mechanics().apply({.kind = SceneChange::kRestitution, .body = body, .values = {v[0], 0, 0}});
    return "";
  }
  if (const std::string error = check_movable(world, body); !error.empty()) return error;
  if (property == "mass") 
    return s.mechanics().apply({.kind = SceneChange::kMass, .body = body, .values = {v[0], 0, 0}}) ? "" : on_joint;
  if (property == "pose") return s.mechanics().set_pose(body, pose_of(v)) ? "" : on_joint;
  if (property == "velocity") s.mechanics().set_velocity(body, Vector3d(v.data()));
  if (property == "spin") s.mechanics().set_spin(body, Vector3d(v.data()));
  return "";
}

std::string set_of_joint(Simulation& s, const std::string& joint, const std::string& property,
                         std::span<const double> v) {
  const std::string no_axis = quoted(joint) + " has no axis for a motor or friction";
  if (property == "friction")
    return s.mechanics().apply({.kind = SceneChange::kJointFriction, .joint = joint, .values = {v[0], 0, 0}}) ? ""
                                                                                                              : no_axis;
  // The same rule as in a scene file: a negative torque reverses the direction of the motor.
  const double speed = v[0] < 0 ? -std::abs(v[1]) : std::abs(v[1]);
  const bool set =
      s.mechanics().apply({.kind = SceneChange::kMotor, .joint = joint, .values = {std::abs(v[0]), speed, 0}});
  return set ? "" : no_axis;
}

}  // namespace

std::span<const PropertyRow> properties() { return kProperties; }

int find_body(const WorldDef& world, const std::string& name) {
  int found = -1, links = 0;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    if (world.bodies[i].name == name) return static_cast<int>(i);
    if (!world.bodies[i].name.starts_with(name + "::")) continue;
    found = static_cast<int>(i);
    ++links;
  }
  return links == 1 ? found : -1;
}

std::string set_property(Simulation& simulation, const WorldDef& world, const std::string& of,
                         const std::string& property, std::span<const double> values) {
  const int body = find_body(world, of);
  const bool joint =
      std::any_of(world.joints.begin(), world.joints.end(), [&](const JointDef& j) { return j.name == of; });
  if (of != "world" && body < 0 && !joint) return unknown_name(of);
  const Owner owner = of == "world" ? Owner::kWorld : body >= 0 ? Owner::kBody : Owner::kJoint;
  const auto row = std::find_if(kProperties.begin(), kProperties.end(),
                                [&](const PropertyRow& r) { return r.owner == owner && r.name == property; });
  if (row == kProperties.end()) return unknown_property(owner, property);
  if (const std::string error = check_values(*row, values); !error.empty()) return error;
  if (owner == Owner::kBody) return set_of_body(simulation, world, body, property, values);
  if (owner == Owner::kJoint) return set_of_joint(simulation, of, property, values);
  simulation.mechanics().apply({.kind = SceneChange::kGravity, .values = Vector3d(values.data())});
  return "";
}

std::string push_body(Simulation& simulation, const WorldDef& world, const std::string& name,
                      const Vector3d& force_N, const Vector3d& torque_N_m, sync::Nanoseconds duration) {
  const int body = find_body(world, name);
  if (body < 0) return "there is no body " + quoted(name) + " in this scene";
  if (const std::string error = check_movable(world, body); !error.empty()) return error;
  std::ostringstream limit;
  if (!(force_N.norm() <= kMaxForce_N) || !(torque_N_m.norm() <= kMaxTorque_N_m))
    limit << "a push may have at most " << kMaxForce_N << " N and " << kMaxTorque_N_m << " N m";
  else if (duration < simulation.step_length() || duration > kMaxPush)
    limit << "a push lasts between one step of 1 ms and " << sync::to_seconds(kMaxPush) << " s";
  if (!limit.str().empty()) return limit.str();
  const std::int64_t steps = (duration + simulation.step_length() / 2) / simulation.step_length();
  if (!simulation.push({body, force_N, torque_N_m, steps}))
    return std::to_string(Simulation::kMaxWrenches) + " pushes are active, the maximum; wait until one ends";
  return "";
}

}  // namespace tactus::sim
