#include "sim_node/behaviour/ode_joints.h"

#include <algorithm>

namespace tactus::sim::ode {
namespace {

constexpr double kNoLimit = 1e15;

// Parameter of an axis in ODE's numbering: the second axis has 0x100 added.
int group(int param, int axis) { return param + axis * dParamGroup; }

void set_param(dJointID id, JointKind kind, int param, double value) {
  switch (kind) {
    case JointKind::kRevolute: dJointSetHingeParam(id, param, value); break;
    case JointKind::kPrismatic: dJointSetSliderParam(id, param, value); break;
    case JointKind::kUniversal: dJointSetUniversalParam(id, param, value); break;
    case JointKind::kFixed:
    case JointKind::kBall: break;
  }
}

int axis_count(JointKind kind) {
  switch (kind) {
    case JointKind::kUniversal: return 2;
    case JointKind::kRevolute:
    case JointKind::kPrismatic: return 1;
    case JointKind::kFixed:
    case JointKind::kBall: return 0;
  }
  return 0;
}

// ODE's index of our axis. In ODE the first axis of a universal joint belongs to the first body, which is our child;
// our first axis belongs to the parent. Angles then count as in SDF, child relative to parent.
int ode_axis(JointKind kind, int axis) { return kind == JointKind::kUniversal ? 1 - axis : axis; }

void set_axis_params(dJointID id, const JointDef& def, int axis, double erp, double cfm) {
  const JointAxis& a = def.axes[axis];
  const int g = ode_axis(def.kind, axis);
  const auto set = [&](int param, double value) { set_param(id, def.kind, group(param, g), value); };
  const double low = a.lower < -kNoLimit ? -dInfinity : a.lower, high = a.upper > kNoLimit ? dInfinity : a.upper;
  // Set twice: ODE rejects a lower stop above the current upper one.
  for (int twice = 0; twice < 2; ++twice) {
    set(dParamLoStop, low);
    set(dParamHiStop, high);
  }
  set(dParamStopERP, erp);
  set(dParamStopCFM, cfm);
  set(dParamBounce, 0);
}

// Coulomb friction is a motor with target speed zero. A motor's available effort is reduced by it.
void set_motor_params(dJointID id, const JointDef& def, int axis) {
  const JointAxis& a = def.axes[axis];
  const int g = ode_axis(def.kind, axis);
  const bool motor = a.motor_effort > 0;
  set_param(id, def.kind, group(dParamVel, g), motor ? a.motor_velocity : 0);
  set_param(id, def.kind, group(dParamFMax, g), motor ? std::max(0.0, a.motor_effort - a.friction) : a.friction);
}

// Inertia of a body about a line through the anchor, kg m^2; infinite for a static body.
double inverse_inertia_about(dBodyID body, const Eigen::Vector3d& anchor, const Eigen::Vector3d& axis) {
  if (!body) return 0;
  dMass mass;
  dBodyGetMass(body, &mass);
  dVector3 in_body;
  dBodyVectorFromWorld(body, axis.x(), axis.y(), axis.z(), in_body);
  const Eigen::Vector3d u = to_eigen(in_body);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> inertia(mass.I);
  const double lever = (to_eigen(dBodyGetPosition(body)) - anchor).cross(axis).norm();
  return 1 / (u.dot(inertia.leftCols<3>() * u) + mass.mass * lever * lever);
}

double inverse_mass(dBodyID body) {
  if (!body) return 0;
  dMass mass;
  dBodyGetMass(body, &mass);
  return 1 / mass.mass;
}

double pair_inertia(const JointDef& def, dBodyID child, dBodyID parent, const Eigen::Vector3d& axis) {
  const double inverse = def.kind == JointKind::kPrismatic
                             ? inverse_mass(child) + inverse_mass(parent)
                             : inverse_inertia_about(child, def.anchor_m, axis) +
                                   inverse_inertia_about(parent, def.anchor_m, axis);
  return inverse > 0 ? 1 / inverse : 0;
}

bool passive(const JointAxis& a) { return a.damping > 0 || a.stiffness > 0; }

void turn(dBodyID child, dBodyID parent, const Eigen::Vector3d& torque) {
  if (child) dBodyAddTorque(child, torque.x(), torque.y(), torque.z());
  if (parent) dBodyAddTorque(parent, -torque.x(), -torque.y(), -torque.z());
}

Eigen::Vector3d spin(dBodyID body) { return body ? to_eigen(dBodyGetAngularVel(body)) : Eigen::Vector3d::Zero(); }

dJointID create(JointKind kind, dWorldID ode) {
  switch (kind) {
    case JointKind::kFixed: return dJointCreateFixed(ode, nullptr);
    case JointKind::kBall: return dJointCreateBall(ode, nullptr);
    case JointKind::kRevolute: return dJointCreateHinge(ode, nullptr);
    case JointKind::kPrismatic: return dJointCreateSlider(ode, nullptr);
    case JointKind::kUniversal: break;
  }
  return dJointCreateUniversal(ode, nullptr);
}

}  // namespace

double passive_force(double position, double rate, double stiffness, double reference, double damping, double inertia,
                     double step_s) {
  const double wanted = -stiffness * (position + step_s * rate - reference) - damping * rate;
  const double stiffening = inertia > 0 ? step_s * (damping + step_s * stiffness) / inertia : 0;
  return wanted / (1 + stiffening);
}

Joints::Joints(const WorldDef& world, dWorldID ode, const std::vector<dBodyID>& bodies, double erp, double cfm) {
  const auto body = [&](int i) { return i < 0 ? nullptr : bodies[static_cast<std::size_t>(i)]; };
  joints_.reserve(world.joints.size());
  for (const JointDef& def : world.joints) {
    const dBodyID child = body(def.child), parent = body(def.parent);
    if (!child && !parent) continue;
    const dJointID id = create(def.kind, ode);
    dJointAttach(id, child, parent);
    const Eigen::Vector3d &p = def.anchor_m, a = def.axes[0].axis.normalized(), b = def.axes[1].axis.normalized();
    switch (def.kind) {
      case JointKind::kFixed: dJointSetFixed(id); break;
      case JointKind::kBall: dJointSetBallAnchor(id, p.x(), p.y(), p.z()); break;
      case JointKind::kRevolute:
        dJointSetHingeAnchor(id, p.x(), p.y(), p.z());
        dJointSetHingeAxis(id, a.x(), a.y(), a.z());
        break;
      case JointKind::kPrismatic: dJointSetSliderAxis(id, a.x(), a.y(), a.z()); break;
      case JointKind::kUniversal:
        dJointSetUniversalAnchor(id, p.x(), p.y(), p.z());
        dJointSetUniversalAxis1(id, b.x(), b.y(), b.z());
        dJointSetUniversalAxis2(id, a.x(), a.y(), a.z());
        break;
    }
    for (int axis = 0; axis < axis_count(def.kind); ++axis) {
      set_axis_params(id, def, axis, erp, cfm);
      set_motor_params(id, def, axis);
    }
    joints_.push_back({id, def, child, parent, {pair_inertia(def, child, parent, a), pair_inertia(def, child, parent, b)},
                       Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  }
}

// The implicit step needs the joint rate without spring and damper. The other effects of the previous step are
// assumed to continue.
void Joints::apply(Joint& j, double h) {
  const JointAxis* a = j.def.axes;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), position = Eigen::Vector3d::Zero();
  switch (j.def.kind) {
    case JointKind::kRevolute:
      position[0] = dJointGetHingeAngle(j.id), rate[0] = dJointGetHingeAngleRate(j.id);
      break;
    case JointKind::kPrismatic:
      position[0] = dJointGetSliderPosition(j.id), rate[0] = dJointGetSliderPositionRate(j.id);
      break;
    case JointKind::kUniversal:
      position[1] = dJointGetUniversalAngle1(j.id), rate[1] = dJointGetUniversalAngle1Rate(j.id);
      position[0] = dJointGetUniversalAngle2(j.id), rate[0] = dJointGetUniversalAngle2Rate(j.id);
      break;
    case JointKind::kBall: rate = spin(j.child) - spin(j.parent); break;
    case JointKind::kFixed: return;
  }
  const bool ball = j.def.kind == JointKind::kBall;
  const auto axis = [&](int k) { return ball ? 0 : k; };
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int k = 0; k < (ball ? 3 : axis_count(j.def.kind)); ++k) {
    const double inertia = j.inertia[axis(k)];
    const double others = j.begun && inertia > 0 ? rate[k] - j.last_rate[k] - h * j.last_force[k] / inertia : 0;
    force[k] = passive_force(position[k], rate[k] + others, ball ? 0 : a[k].stiffness, a[axis(k)].reference,
                             a[axis(k)].damping, inertia, h);
  }
  j.last_rate = rate;
  j.last_force = force;
  j.begun = true;
  if (ball) turn(j.child, j.parent, force);
  if (j.def.kind == JointKind::kRevolute) dJointAddHingeTorque(j.id, force[0]);
  if (j.def.kind == JointKind::kPrismatic) dJointAddSliderForce(j.id, force[0]);
  if (j.def.kind == JointKind::kUniversal) dJointAddUniversalTorques(j.id, force[1], force[0]);
}

void Joints::apply_passive(double h) {
  for (Joint& j : joints_)
    if (passive(j.def.axes[0]) || passive(j.def.axes[1])) apply(j, h);
}

JointAxis* Joints::axis_of(const std::string& name, int axis) {
  for (Joint& j : joints_)
    if (j.def.name == name) return axis >= 0 && axis < axis_count(j.def.kind) ? &j.def.axes[axis] : nullptr;
  return nullptr;
}

bool Joints::set_motor(const std::string& name, int axis, double effort, double velocity) {
  JointAxis* a = axis_of(name, axis);
  if (a == nullptr) return false;
  a->motor_effort = effort;
  a->motor_velocity = velocity;
  for (Joint& j : joints_)
    if (j.def.name == name) set_motor_params(j.id, j.def, axis);
  return true;
}

bool Joints::set_friction(const std::string& name, int axis, double friction) {
  JointAxis* a = axis_of(name, axis);
  if (a == nullptr) return false;
  a->friction = friction;
  for (Joint& j : joints_)
    if (j.def.name == name) set_motor_params(j.id, j.def, axis);
  return true;
}

void Joints::archive(StateArchive& a) {
  a.fixed(joints_, [&](Joint& j) {
    a(j.last_rate), a(j.last_force), a(j.begun);
    for (int axis = 0; axis < axis_count(j.def.kind); ++axis) {
      JointAxis& x = j.def.axes[axis];
      a(x.motor_effort), a(x.motor_velocity), a(x.friction);
      if (a.reads()) set_motor_params(j.id, j.def, axis);
    }
  });
}

}  // namespace tactus::sim::ode
