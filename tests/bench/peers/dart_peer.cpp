#include "tests/bench/peers/dart_peer.h"

#include <algorithm>
#include <cmath>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BallJoint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/UniversalJoint.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <stdexcept>

namespace tactus::sim::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
namespace dd = dart::dynamics;

constexpr double kPlaneSize_m = 200;

// DART uses the smaller friction of a pair, so that a static surface receives the least geometric mean with a moving one.
double friction_of(const WorldDef& w, const ShapeDef& s) {
  if (!w.bodies[static_cast<std::size_t>(s.body)].is_static) return s.friction;
  double least = 1e9;
  for (const ShapeDef& other : w.shapes)
    if (!w.bodies[static_cast<std::size_t>(other.body)].is_static) least = std::min(least, std::sqrt(s.friction * other.friction));
  return least;
}

void add_shape_node(const WorldDef& w, const ShapeDef& s, dd::BodyNode& node) {
  dd::ShapePtr shape;
  Isometry3d pose = s.pose;
  if (s.kind == ShapeKind::kBox) {
    shape = std::make_shared<dd::BoxShape>(s.size_m);
  } else if (s.kind == ShapeKind::kSphere) {
    shape = std::make_shared<dd::SphereShape>(s.size_m.x());
  } else if (s.kind == ShapeKind::kPlane) {
    shape = std::make_shared<dd::BoxShape>(Vector3d::Constant(kPlaneSize_m));
    pose = pose * Eigen::Translation3d(0, 0, -kPlaneSize_m / 2);
  } else {
    throw std::runtime_error("dart: the shape " + s.name + " is neither a box nor a ball nor a plane; leave out DART for this world");
  }
  auto* const made = node.createShapeNodeWith<dd::CollisionAspect, dd::DynamicsAspect>(shape);
  made->setRelativeTransform(pose);
  made->getDynamicsAspect()->setFrictionCoeff(friction_of(w, s));
  made->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(s.restitution));  // a pair has the product of both
}

}  // namespace

struct DartPeer::Engine {
  dart::simulation::WorldPtr world = dart::simulation::World::create();
  std::vector<dd::BodyNode*> bodies;

  dd::BodyNode* node_of(int body) const { return body < 0 ? nullptr : bodies[static_cast<std::size_t>(body)]; }

  // The joint that holds a body; null: none.
  static const JointDef* holder(const WorldDef& w, int body) {
    for (const JointDef& j : w.joints)
      if (j.child == body) return &j;
    return nullptr;
  }
  template <class Joint>
  Joint* pair(const dd::SkeletonPtr& skeleton, dd::BodyNode* parent) {
    typename Joint::Properties properties;
    properties.mName = "joint" + std::to_string(bodies.size());
    const auto [joint, node] = skeleton->createJointAndBodyNodePair<Joint>(parent, properties, dd::BodyNode::AspectProperties("body" + std::to_string(bodies.size())));
    bodies.push_back(node);
    return joint;
  }
  dd::Joint* make_joint(const JointDef& j, const dd::SkeletonPtr& skeleton, dd::BodyNode* parent) {
    switch (j.kind) {
      case JointKind::kRevolute: {
        auto* const joint = pair<dd::RevoluteJoint>(skeleton, parent);
        joint->setAxis(j.axes[0].axis.normalized());
        return joint;
      }
      case JointKind::kPrismatic: {
        auto* const joint = pair<dd::PrismaticJoint>(skeleton, parent);
        joint->setAxis(j.axes[0].axis.normalized());
        return joint;
      }
      case JointKind::kUniversal: {
        auto* const joint = pair<dd::UniversalJoint>(skeleton, parent);
        joint->setAxis1(j.axes[0].axis.normalized());
        joint->setAxis2(j.axes[1].axis.normalized());
        return joint;
      }
      case JointKind::kBall: return pair<dd::BallJoint>(skeleton, parent);
      default: return pair<dd::WeldJoint>(skeleton, parent);
    }
  }
  void add(const WorldDef& w, int body) {
    const BodyDef& b = w.bodies[static_cast<std::size_t>(body)];
    const JointDef* const held = holder(w, body);
    dd::BodyNode* parent = held ? node_of(held->parent) : nullptr;
    if (parent && !parent->getSkeleton()->isMobile()) parent = nullptr;
    const dd::SkeletonPtr skeleton = parent ? parent->getSkeleton() : dd::Skeleton::create(b.name + std::to_string(body));
    if (held) {
      // Axes are those of the world at the start, so that the frame of a joint is its anchor in world axes.
      const Isometry3d anchor(Eigen::Translation3d(held->anchor_m));
      dd::Joint* const joint = make_joint(*held, skeleton, parent);
      joint->setTransformFromParentBodyNode(parent ? Isometry3d(parent->getTransform().inverse() * anchor) : anchor);
      joint->setTransformFromChildBodyNode(b.pose.inverse() * anchor);
    } else if (b.is_static) {
      pair<dd::WeldJoint>(skeleton, nullptr)->setTransformFromParentBodyNode(b.pose);
    } else {
      auto* const joint = pair<dd::FreeJoint>(skeleton, nullptr);
      joint->setTransform(b.pose);
      joint->setLinearVelocity(b.velocity_m_s - b.spin_rad_s.cross(b.pose.linear() * b.centre_of_mass_m));
      joint->setAngularVelocity(b.spin_rad_s);
    }
    dd::BodyNode& node = *bodies.back();
    if (!b.is_static) node.setInertia(dd::Inertia(b.mass_kg, b.centre_of_mass_m, b.inertia_kg_m2));
    node.setGravityMode(b.gravity);
    for (const ShapeDef& s : w.shapes)
      if (s.body == body) add_shape_node(w, s, node);
    skeleton->setMobile(!b.is_static);
    if (!parent) world->addSkeleton(skeleton);
  }
};

DartPeer::DartPeer(const WorldDef& world, const Settings& settings)
    : def_(world, settings.step_s), step_s_(settings.step_s), engine_(std::make_unique<Engine>()) {
  const WorldDef& w = def_.earlier;
  engine_->world->setTimeStep(step_s_);
  engine_->world->setGravity(w.gravity_m_s2);
  engine_->world->getConstraintSolver()->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
  for (std::size_t i = 0; i < w.bodies.size(); ++i) engine_->add(w, static_cast<int>(i));
  motions_.resize(w.bodies.size());
  read();
}

DartPeer::~DartPeer() = default;

void DartPeer::add_force(int body, const Vector3d& force_N, const Vector3d& point_m) {
  engine_->bodies[static_cast<std::size_t>(body)]->addExtForce(force_N, point_m, false, false);
}

void DartPeer::step() {
  engine_->world->step();
  read();
}

void DartPeer::read() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const dd::BodyNode& node = *engine_->bodies[i];
    const BodyDef& b = def_.earlier.bodies[i];
    BodyMotion& m = motions_[i];
    const Isometry3d& pose = node.getTransform();
    m.position_m = pose.translation();
    m.orientation = Eigen::Quaterniond(pose.linear()).normalized();
    m.centre_m = pose * b.centre_of_mass_m;
    if (b.is_static) continue;
    m.velocity_m_s = node.getCOMLinearVelocity();
    m.spin_rad_s = node.getAngularVelocity();
    m.inverse_mass_1_kg = 1 / b.mass_kg;
    m.inverse_inertia = pose.linear() * b.inertia_kg_m2.inverse() * pose.linear().transpose();
  }
}

}  // namespace tactus::sim::test
