#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim_node/behaviour/behaviour_checks.h"
#include "sim_node/behaviour/impulse_solver.h"
#include "sim_node/behaviour/ode_engine.h"
#include "sync/time/phases.h"

namespace tactus::sim {
namespace {

using ode::to_eigen;

// A tangential speed below this has no direction, m/s.
constexpr double kStill_m_s = 1e-9;

dMass mass_of(const BodyDef& body) {
  const Eigen::Matrix3d& i = body.inertia_kg_m2;
  const Eigen::LLT<Eigen::Matrix3d> cholesky(i);
  if (!(body.mass_kg > 0) || !std::isfinite(body.mass_kg) || !i.allFinite() || cholesky.info() != Eigen::Success)
    throw std::runtime_error("sim_node: body \"" + body.name +
                             "\" has a mass or inertia that is not positive; correct its <inertial>");
  dMass mass;
  dMassSetParameters(&mass, body.mass_kg, 0, 0, 0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2));
  return mass;
}

// Transform from the world to the frame of a body.
Eigen::Isometry3d to_body(const BodyMotion& m) {
  return (Eigen::Translation3d(m.position_m) * m.orientation).inverse();
}

}  // namespace

dBodyID Solver::Engine::make_body(const BodyDef& def, const Eigen::Vector3d& gravity_m_s2, double step_s) {
  if (def.is_static || def.tool >= 0) return nullptr;
  const dMass mass = mass_of(def);
  const dBodyID id = dBodyCreate(world.get());
  dBodySetMass(id, &mass);
  const Eigen::Vector3d p = def.pose * def.centre_of_mass_m;
  dBodySetPosition(id, p.x(), p.y(), p.z());
  dQuaternion q;
  ode::set_quaternion(Eigen::Quaterniond(def.pose.linear()).normalized(), q);
  dBodySetQuaternion(id, q);
  // ODE's step, v += g h then x += v h, follows the parabola exactly when the speed belongs to the middle of the
  // previous step: half a step of gravity earlier.
  Eigen::Vector3d v = def.velocity_m_s;
  if (def.gravity) v -= gravity_m_s2 * (step_s / 2);
  dBodySetLinearVel(id, v.x(), v.y(), v.z());
  dBodySetAngularVel(id, def.spin_rad_s.x(), def.spin_rad_s.y(), def.spin_rad_s.z());
  dBodySetGravityMode(id, def.gravity);
  dBodySetAutoDisableFlag(id, 0);
  dBodySetLinearDamping(id, std::min(1.0, def.linear_damping_1_s * step_s));
  dBodySetAngularDamping(id, std::min(1.0, def.angular_damping_1_s * step_s));
  dBodySetLinearDampingThreshold(id, 0);
  dBodySetAngularDampingThreshold(id, 0);
  return id;
}

Solver::Solver(const WorldDef& world, const Settings& settings) : settings_(settings) {
  if (const std::string why = unsupported_reason(world, settings); !why.empty()) throw std::runtime_error(why);
  if (behaviour_model(settings.solver).impulses)
    impulse_ = std::make_unique<ImpulseSolver>(world, settings);
  else
    start(world);
}

void Solver::start(const WorldDef& world) {
  const Settings& settings = settings_;
  engine_ = std::make_unique<Engine>();
  motions_.resize(world.bodies.size());
  const dWorldID w = engine_->world.get();
  const Eigen::Vector3d g = world.gravity_m_s2;
  dWorldSetGravity(w, g.x(), g.y(), g.z());
  dWorldSetERP(w, settings.joint_erp);
  dWorldSetCFM(w, settings.joint_cfm);
  dWorldSetAutoDisableFlag(w, 0);
  dWorldSetQuickStepNumIterations(w, settings.iterations);
  dWorldSetQuickStepW(w, settings.over_relaxation);
  dWorldSetContactMaxCorrectingVel(w, settings.correcting_speed_m_s);
  dWorldSetContactSurfaceLayer(w, settings.surface_layer_m);
  engine_->exact = settings.solver == "step";
  for (const BodyDef& b : world.bodies) engine_->bodies.push_back(engine_->make_body(b, g, settings.step_s));
  engine_->jointed.resize(world.bodies.size());
  for (const JointDef& j : world.joints)
    for (const int body : {j.parent, j.child})
      if (body >= 0) engine_->jointed[static_cast<std::size_t>(body)] = true;
  engine_->joints = std::make_unique<ode::Joints>(world, w, engine_->bodies, settings.joint_erp, settings.joint_cfm);
  engine_->shapes = std::make_unique<ode::Shapes>(world, engine_->bodies, settings);
  engine_->feedback.resize(kMaxPoints);
  engine_->joint_points.reserve(kMaxPoints);
  friction_maps_ = std::make_unique<const FrictionMaps>(world);
  for (const ShapeDef& s : world.shapes) {
    friction_.push_back(s.friction);
    restitution_.push_back(s.restitution);
    body_of_.push_back(s.body);
  }
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const BodyDef& b = world.bodies[i];
    const bool moves = engine_->bodies[i] != nullptr;
    has_gravity_.push_back(moves && b.gravity);
    inertias_.push_back(
        {b.centre_of_mass_m,
         moves ? Eigen::Matrix3d(b.inertia_kg_m2.inverse()) : Eigen::Matrix3d(Eigen::Matrix3d::Zero()),
         moves && b.gravity ? Eigen::Vector3d(g * settings.step_s) : Eigen::Vector3d(0, 0, 0)});
    BodyMotion& m = motions_[i];
    m.position_m = b.pose.translation();
    m.orientation = Eigen::Quaterniond(b.pose.linear()).normalized();
    m.centre_m = b.pose * b.centre_of_mass_m;
    m.inverse_mass_1_kg = moves ? 1 / b.mass_kg : 0;
    free_fall_m_s_.push_back(inertias_[i].gravity_m_s);
  }
  moved_back_m_.resize(world.bodies.size());
  read_bodies();
  engine_->shapes->collide(contacts_);
}

Solver::~Solver() = default;

void Solver::read_bodies() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const dBodyID id = engine_->bodies[i];
    if (!id) continue;
    BodyMotion& m = motions_[i];
    m.centre_m = to_eigen(dBodyGetPosition(id));
    m.orientation = ode::quaternion(dBodyGetQuaternion(id));
    m.velocity_m_s = to_eigen(dBodyGetLinearVel(id));
    m.spin_rad_s = to_eigen(dBodyGetAngularVel(id));
    const Eigen::Matrix3d r = m.orientation.toRotationMatrix();
    m.position_m = m.centre_m - r * inertias_[i].centre_in_body_m;
    m.inverse_inertia = r * inertias_[i].inverse_inertia * r.transpose();
  }
}

void Solver::add_force(int body, const Eigen::Vector3d& f, const Eigen::Vector3d& p) {
  if (impulse_) return impulse_->add_force(body, f, p);
  const auto i = static_cast<std::size_t>(body);
  const dBodyID id = engine_->bodies[i];
  if (!id) return;
  dBodyAddForceAtPos(id, f.x(), f.y(), f.z(), p.x(), p.y(), p.z());
  free_fall_m_s_[i] += f * (motions_[i].inverse_mass_1_kg * settings_.step_s);
}

void Solver::add_torque(int body, const Eigen::Vector3d& t) {
  if (impulse_) return impulse_->add_torque(body, t);
  if (const dBodyID id = engine_->bodies[static_cast<std::size_t>(body)]) dBodyAddTorque(id, t.x(), t.y(), t.z());
}

// A newly arrived body overshot the surface within the step. It is moved back to the surface, so that it bounces from
// there and gets no later correction impulse. Jointed bodies are left to their joints.
void Solver::move_back(Manifold& c, bool is_new) {
  const auto a = static_cast<std::size_t>(c.body_a), b = static_cast<std::size_t>(c.body_b);
  for (ManifoldPoint& p : c.used()) p.depth_m -= p.normal.dot(moved_back_m_[b] - moved_back_m_[a]);
  if (!is_new) return;
  const ManifoldPoint& deepest = c.points[0];
  const double closing = -deepest.normal.dot(motions_[b].velocity_at(deepest.point_m) - motions_[a].velocity_at(deepest.point_m));
  const double overshot = std::min(deepest.depth_m - settings_.surface_layer_m / 2, closing * settings_.step_s);
  const double free_a = engine_->jointed[a] ? 0 : motions_[a].inverse_mass_1_kg;
  const double free_b = engine_->jointed[b] ? 0 : motions_[b].inverse_mass_1_kg;
  if (overshot <= 0 || free_a + free_b <= 0) return;
  const Eigen::Vector3d n = deepest.normal;
  const auto move = [&](std::size_t body, double by) {
    if (by == 0) return;
    moved_back_m_[body] += by * n;
    const Eigen::Vector3d p = motions_[body].centre_m + moved_back_m_[body];
    dBodySetPosition(engine_->bodies[body], p.x(), p.y(), p.z());
  };
  move(a, -overshot * free_a / (free_a + free_b));
  move(b, overshot * free_b / (free_a + free_b));
  for (ManifoldPoint& p : c.used()) p.depth_m -= overshot * p.normal.dot(n);
}

void Solver::add_contact_joint(Manifold& c) {
  const auto a = static_cast<std::size_t>(c.body_a), b = static_cast<std::size_t>(c.body_b);
  if (friction_maps_->applies(c.shape_a, c.shape_b)) friction_maps_->apply(to_body(motions_[a]), to_body(motions_[b]), c);
  const auto sa = static_cast<std::size_t>(c.shape_a), sb = static_cast<std::size_t>(c.shape_b);
  const bool first_is_b = engine_->bodies[a] == nullptr;
  const dBodyID first = engine_->bodies[first_is_b ? b : a], second = first_is_b ? nullptr : engine_->bodies[b];
  dContact contact{};
  dSurfaceParameters& s = contact.surface;
  s.mode = dContactApprox1 | dContactFDir1 | dContactSoftERP | dContactSoftCFM | dContactBounce;
  // A pair uses the geometric mean of friction and the smaller restitution, as scene.lcm specifies.
  const double friction = std::sqrt(friction_[sa] * friction_[sb]);
  s.bounce = std::min(restitution_[sa], restitution_[sb]);
  s.bounce_vel = settings_.bounce_speed_m_s;
  s.soft_erp = settings_.contact_erp;
  s.soft_cfm = settings_.contact_cfm;
  for (ManifoldPoint& p : c.used()) {
    if (engine_->joint_points.size() >= kMaxPoints) return;
    s.mu = friction * p.friction;
    // ODE bounds friction by a pyramid. With one side aligned to the expected sliding direction it is as wide as the
    // cone; at 45 degrees it would be 41 % too wide.
    Eigen::Vector3d sliding = motions_[b].velocity_at(p.point_m) + free_fall_m_s_[b] -
                              motions_[a].velocity_at(p.point_m) - free_fall_m_s_[a];
    sliding -= sliding.dot(p.normal) * p.normal;
    const Eigen::Vector3d along = sliding.norm() > kStill_m_s ? sliding.normalized() : p.normal.unitOrthogonal();
    const Eigen::Vector3d into_first = first_is_b ? p.normal : Eigen::Vector3d(-p.normal);
    for (int k = 0; k < 3; ++k) {
      contact.geom.pos[k] = p.point_m[k];
      contact.geom.normal[k] = into_first[k];
      contact.fdir1[k] = along[k];
    }
    contact.geom.depth = p.depth_m;
    const dJointID id = dJointCreateContact(engine_->world.get(), engine_->contact_joints, &contact);
    dJointAttach(id, first, second);
    dJointSetFeedback(id, &engine_->feedback[engine_->joint_points.size()]);
    engine_->joint_points.push_back({&p, first_is_b});
  }
}

void Solver::step() {
  if (impulse_) return impulse_->step(settings_.step_s);
  const sync::ScopedPhaseTimer phase(sync::Phase::kSolve);  // includes integration
  // ODE shuffles its rows with a global random generator. Seeding it by the step makes a run repeatable from any
  // step.
  dRandSetSeed(static_cast<unsigned long>(++steps_));
  engine_->joints->apply_passive(settings_.step_s);
  std::fill(moved_back_m_.begin(), moved_back_m_.end(), Eigen::Vector3d::Zero());
  engine_->joint_points.clear();
  auto before = solved_.begin();
  for (Manifold& c : contacts_) {
    while (before != solved_.end() && before->before(c)) ++before;
    move_back(c, before == solved_.end() || c.before(*before));
    add_contact_joint(c);
  }
  if (engine_->exact)
    dWorldStep(engine_->world.get(), settings_.step_s);
  else
    dWorldQuickStep(engine_->world.get(), settings_.step_s);
  for (std::size_t i = 0; i < engine_->joint_points.size(); ++i) {
    const auto [point, first_is_b] = engine_->joint_points[i];
    const double along = to_eigen(engine_->feedback[i].f1).dot(point->normal);
    point->normal_force_N = std::max(0.0, first_is_b ? along : -along);
  }
  dJointGroupEmpty(engine_->contact_joints);
  for (std::size_t i = 0; i < free_fall_m_s_.size(); ++i) free_fall_m_s_[i] = inertias_[i].gravity_m_s;
  std::swap(contacts_, solved_);
  read_bodies();
  const sync::ScopedPhaseTimer collision(sync::Phase::kCollision);
  engine_->shapes->collide(contacts_);
}

std::span<const BodyMotion> Solver::bodies() const { return impulse_ ? impulse_->bodies() : motions_; }
std::span<const Manifold> Solver::contacts() const { return impulse_ ? impulse_->contacts() : contacts_; }
std::span<const Manifold> Solver::solved() const { return impulse_ ? impulse_->solved() : solved_; }
const impulse::RecoveryReport* Solver::report() const { return impulse_ ? &impulse_->report() : nullptr; }

double Solver::mobility(int body, const Eigen::Vector3d& point, const Eigen::Vector3d& n) {
  return impulse_ ? impulse_->mobility(body, point, n) : sim::mobility(motions_[static_cast<std::size_t>(body)], point, n);
}

}  // namespace tactus::sim
