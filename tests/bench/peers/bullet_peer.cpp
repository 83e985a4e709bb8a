#include "tests/bench/peers/bullet_peer.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sim_node/model/triangles.h"

namespace tactus::sim::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Bullet enlarges meshes and hulls by this margin, m; its default of 4 cm is half the size of the bodies here.
constexpr double kMeshMargin_m = 1e-4;

btVector3 to_bullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d to_vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btTransform to_bullet(const Isometry3d& t) {
  const Eigen::Quaterniond q(t.linear());
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(Vector3d(t.translation())));
}

// A pair has the geometric mean of friction and the smaller restitution.
btScalar pair_friction(const btCollisionObject* a, const btCollisionObject* b) { return std::sqrt(a->getFriction() * b->getFriction()); }
btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) {
  return std::min(a->getRestitution(), b->getRestitution());
}

// Frame of the principal axes about the centre of mass, in the body frame.
Isometry3d principal_frame(const BodyDef& b, Vector3d& moments) {
  const Eigen::Matrix3d off_diagonal = b.inertia_kg_m2 - Eigen::Matrix3d(b.inertia_kg_m2.diagonal().asDiagonal());
  Isometry3d frame = Isometry3d::Identity();
  frame.translation() = b.centre_of_mass_m;
  moments = b.inertia_kg_m2.diagonal();
  if (off_diagonal.isZero(0)) return frame;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(b.inertia_kg_m2);
  moments = axes.eigenvalues();
  frame.linear() = axes.eigenvectors();
  if (frame.linear().determinant() < 0) frame.linear().col(0) *= -1;
  return frame;
}

}  // namespace

struct BulletPeer::Engine {
  struct Body {
    btRigidBody* id = nullptr;  // null: static
    Isometry3d frame = Isometry3d::Identity();
  };

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<Body> bodies;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes;
  std::vector<std::unique_ptr<btRigidBody>> objects;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;

  ~Engine() {
    for (const auto& joint : joints) world.removeConstraint(joint.get());
    for (const auto& object : objects) world.removeRigidBody(object.get());
  }

  template <class Shape, class... Values>
  Shape* make(Values... values) {
    auto shape = std::make_unique<Shape>(values...);
    Shape* const made = shape.get();
    shapes.push_back(std::move(shape));
    return made;
  }
  btCollisionShape* triangles(const TriangleMesh& m) {
    meshes.push_back(std::make_unique<btTriangleMesh>());
    const auto corner = [&](std::size_t i) { return to_bullet(m.vertices[static_cast<std::size_t>(m.indices[i])]); };
    for (std::size_t i = 0; i + 2 < m.indices.size(); i += 3) meshes.back()->addTriangle(corner(i), corner(i + 1), corner(i + 2));
    auto* const shape = make<btBvhTriangleMeshShape>(static_cast<btStridingMeshInterface*>(meshes.back().get()), true);
    shape->setMargin(kMeshMargin_m);
    return shape;
  }
  btCollisionShape* hull(const TriangleMesh& m) {
    auto* const shape = make<btConvexHullShape>();
    for (const Vector3d& v : m.vertices) shape->addPoint(to_bullet(v), false);
    shape->recalcLocalAabb();
    shape->setMargin(kMeshMargin_m);
    return shape;
  }
  btCollisionShape* shape_of(const WorldDef& w, const ShapeDef& s, bool moves) {
    const Vector3d half = s.size_m / 2;
    switch (s.kind) {
      case ShapeKind::kBox: return make<btBoxShape>(to_bullet(half));
      case ShapeKind::kSphere: return make<btSphereShape>(s.size_m.x());
      case ShapeKind::kCylinder: return make<btCylinderShapeZ>(btVector3(s.size_m.x(), s.size_m.x(), half.z()));
      case ShapeKind::kCapsule: return make<btCapsuleShapeZ>(s.size_m.x(), s.size_m.z());
      case ShapeKind::kPlane: return make<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0);
      case ShapeKind::kHeightfield: return triangles(triangulate(w.heightfields[static_cast<std::size_t>(s.mesh)], 1000));
      default: break;
    }
    const TriangleMesh& mesh = w.meshes[static_cast<std::size_t>(s.mesh)];
    return moves ? hull(mesh) : triangles(mesh);
  }
  btRigidBody* add(double mass, const Vector3d& moments, btCollisionShape* shape, const Isometry3d& pose, const ShapeDef* surface) {
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, to_bullet(moments));
    info.m_startWorldTransform = to_bullet(pose);
    info.m_friction = surface ? surface->friction : 0;
    info.m_restitution = surface ? surface->restitution : 0;
    objects.push_back(std::make_unique<btRigidBody>(info));
    objects.back()->setActivationState(DISABLE_DEACTIVATION);
    return objects.back().get();
  }
  void add_moving(const WorldDef& w, int body) {
    const BodyDef& b = w.bodies[static_cast<std::size_t>(body)];
    Vector3d moments;
    Body& out = bodies.emplace_back();
    out.frame = principal_frame(b, moments);
    btCompoundShape* const compound = make<btCompoundShape>();
    const ShapeDef* surface = nullptr;
    for (const ShapeDef& s : w.shapes) {
      if (s.body != body) continue;
      compound->addChildShape(to_bullet(Isometry3d(out.frame.inverse() * s.pose)), shape_of(w, s, true));
      surface = &s;
    }
    const bool single = compound->getNumChildShapes() == 1 && compound->getChildTransform(0) == btTransform::getIdentity();
    out.id = add(b.mass_kg, moments, single ? compound->getChildShape(0) : compound, b.pose * out.frame, surface);
    out.id->setDamping(b.linear_damping_1_s, b.angular_damping_1_s);
    out.id->setLinearVelocity(to_bullet(b.velocity_m_s));
    out.id->setAngularVelocity(to_bullet(b.spin_rad_s));
    // Masks: bodies without a shape meet nothing.
    world.addRigidBody(out.id, surface ? 1 : 0, surface ? 1 : 0);
    if (!b.gravity) out.id->setGravity(btVector3(0, 0, 0));
  }
  void add_static(const WorldDef& w, int body) {
    bodies.emplace_back();
    for (const ShapeDef& s : w.shapes)
      if (s.body == body)
        world.addRigidBody(add(0, Vector3d::Zero(), shape_of(w, s, false), w.bodies[static_cast<std::size_t>(body)].pose * s.pose, &s), 1, 1);
  }
  // One constraint for all kinds. Its z axis belongs to the parent and its x axis to the child; limits with low > high are none.
  void add_joint(const WorldDef& w, const JointDef& j) {
    const Vector3d first = j.axes[0].axis.normalized();
    const bool universal = j.kind == JointKind::kUniversal;
    Isometry3d frame = Isometry3d::Identity();
    const Vector3d x = universal ? j.axes[1].axis.normalized() : first, z = universal ? first : first.unitOrthogonal();
    frame.linear() << x, z.cross(x), z;
    frame.translation() = j.anchor_m;
    const auto in_body = [&](int body) {
      if (body < 0 || !bodies[static_cast<std::size_t>(body)].id) return to_bullet(frame);
      const auto i = static_cast<std::size_t>(body);
      return to_bullet(Isometry3d((w.bodies[i].pose * bodies[i].frame).inverse() * frame));
    };
    const auto id = [&](int body) -> btRigidBody& {
      btRigidBody* const own = body < 0 ? nullptr : bodies[static_cast<std::size_t>(body)].id;
      return own ? *own : btTypedConstraint::getFixedBody();
    };
    auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(id(j.parent), id(j.child), in_body(j.parent), in_body(j.child));
    for (int i = 0; i < 6; ++i) joint->setLimit(i, 0, 0);
    const auto release = [&](int i) { joint->setLimit(i, 1, -1); };
    if (j.kind == JointKind::kPrismatic) release(0);
    if (j.kind == JointKind::kRevolute || universal) release(3);
    if (universal) release(5);
    if (j.kind == JointKind::kBall)
      for (const int i : {3, 4, 5}) release(i);
    world.addConstraint(joint.get());
    joints.push_back(std::move(joint));
  }
};

BulletPeer::BulletPeer(const WorldDef& world, const Settings& settings)
    : def_(world, settings.step_s), step_s_(settings.step_s), engine_(std::make_unique<Engine>()) {
  const WorldDef& w = def_.earlier;
  gCalculateCombinedFrictionCallback = pair_friction;
  gCalculateCombinedRestitutionCallback = pair_restitution;
  engine_->world.setGravity(to_bullet(w.gravity_m_s2));
  for (std::size_t i = 0; i < w.bodies.size(); ++i)
    w.bodies[i].is_static ? engine_->add_static(w, static_cast<int>(i)) : engine_->add_moving(w, static_cast<int>(i));
  for (const auto& [a, b] : w.no_collision) {
    btRigidBody *const first = engine_->bodies[static_cast<std::size_t>(a)].id, *const second = engine_->bodies[static_cast<std::size_t>(b)].id;
    if (first && second) first->setIgnoreCollisionCheck(second, true), second->setIgnoreCollisionCheck(first, true);
  }
  for (const JointDef& j : w.joints) engine_->add_joint(w, j);
  motions_.resize(w.bodies.size());
  read();
}

BulletPeer::~BulletPeer() = default;

void BulletPeer::add_force(int body, const Vector3d& force_N, const Vector3d& point_m) {
  const auto i = static_cast<std::size_t>(body);
  if (btRigidBody* const id = engine_->bodies[i].id) id->applyForce(to_bullet(force_N), to_bullet(Vector3d(point_m - motions_[i].centre_m)));
}

void BulletPeer::step() {
  engine_->world.stepSimulation(step_s_, 0);
  read();
}

void BulletPeer::read() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const BodyDef& b = def_.earlier.bodies[i];
    BodyMotion& m = motions_[i];
    Isometry3d pose = b.pose;
    if (const btRigidBody* const id = engine_->bodies[i].id) {
      const btTransform& t = id->getWorldTransform();
      const btQuaternion q = t.getRotation();
      Isometry3d centre = Isometry3d::Identity();
      centre.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
      centre.translation() = to_vector(t.getOrigin());
      pose = centre * engine_->bodies[i].frame.inverse();
      m.velocity_m_s = to_vector(id->getLinearVelocity());
      m.spin_rad_s = to_vector(id->getAngularVelocity());
      m.inverse_mass_1_kg = 1 / b.mass_kg;
      const Eigen::Matrix3d r = pose.linear();
      m.inverse_inertia = r * b.inertia_kg_m2.inverse() * r.transpose();
    }
    m.position_m = pose.translation();
    m.orientation = Eigen::Quaterniond(pose.linear()).normalized();
    m.centre_m = pose * b.centre_of_mass_m;
  }
}

}  // namespace tactus::sim::test
