#include "sim_node/collision/ode_shapes.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace tactus::sim::ode {
namespace {

// Two boxes have at most 8 points, meshes many more.
constexpr int kMostRaw = 64;
// What never moves is not tested against what never moves.
constexpr unsigned long kStatic = 1, kMoving = 2;
// A plane that moves is a plate of this thickness, m: ODE's planes cannot move.
constexpr double kPlate_m = 0.01;
// ODE's heightfields are solid down to so far below their lowest sample, m.
constexpr double kGround_m = 1;

// The pose of a shape about its body's centre of mass.
Eigen::Isometry3d about_centre(const BodyDef& body, const Eigen::Isometry3d& in_body) {
  return Eigen::Translation3d(-body.centre_of_mass_m) * in_body;
}

}  // namespace

Shapes::Shapes(const WorldDef& world, const std::vector<dBodyID>& bodies) : space_(dHashSpaceCreate(nullptr)) {
  dSpaceSetCleanup(space_.get(), 1);
  // ODE holds pointers to the lists in these, so they must not move.
  triangles_.reserve(world.shapes.size());
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const ShapeDef& shape = world.shapes[i];
    const BodyDef& body = world.bodies[static_cast<std::size_t>(shape.body)];
    body_of_.push_back(shape.body);
    is_mesh_.push_back(shape.kind == ShapeKind::kMesh);
    if (body.tool >= 0) continue;
    const dBodyID id = bodies[static_cast<std::size_t>(shape.body)];
    const dGeomID geom = make(world, shape, id == nullptr);
    dGeomSetData(geom, reinterpret_cast<void*>(i));
    dGeomSetCategoryBits(geom, id ? kMoving : kStatic);
    dGeomSetCollideBits(geom, id ? kMoving | kStatic : kMoving);
    dSpaceAdd(space_.get(), geom);
    if (shape.kind == ShapeKind::kPlane && !id) continue;
    Eigen::Isometry3d pose = id ? about_centre(body, shape.pose) : body.pose * shape.pose;
    if (shape.kind == ShapeKind::kPlane) pose.translate(Eigen::Vector3d(0, 0, -kPlate_m / 2));
    // ODE's heightfield has y up.
    if (shape.kind == ShapeKind::kHeightfield) {
      pose.translate(world.heightfields[static_cast<std::size_t>(shape.mesh)].centre_m);
      pose.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
    }
    dQuaternion q;
    set_quaternion(Eigen::Quaterniond(pose.linear()).normalized(), q);
    const Eigen::Vector3d p = pose.translation();
    if (id) {
      dGeomSetBody(geom, id);
      dGeomSetOffsetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetOffsetQuaternion(geom, q);
    } else {
      dGeomSetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetQuaternion(geom, q);
    }
  }
  for (const auto& [a, b] : world.no_collision) apart_.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(apart_.begin(), apart_.end());
  raw_.resize(kMostRaw);
  found_.reserve(kMostRaw);
}

dGeomID Shapes::make(const WorldDef& world, const ShapeDef& shape, bool is_static) {
  const Eigen::Vector3d& s = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::kBox: return dCreateBox(nullptr, s.x(), s.y(), s.z());
    case ShapeKind::kSphere: return dCreateSphere(nullptr, s.x());
    case ShapeKind::kCylinder: return dCreateCylinder(nullptr, s.x(), s.z());
    case ShapeKind::kCapsule: return dCreateCapsule(nullptr, s.x(), s.z());
    case ShapeKind::kMesh: return make_mesh(world.meshes.at(static_cast<std::size_t>(shape.mesh)));
    case ShapeKind::kHeightfield: return make_heightfield(world.heightfields.at(static_cast<std::size_t>(shape.mesh)));
    case ShapeKind::kPlane: break;
  }
  if (!is_static) return dCreateBox(nullptr, s.x(), s.y(), kPlate_m);
  const Eigen::Isometry3d pose = world.bodies[static_cast<std::size_t>(shape.body)].pose * shape.pose;
  const Eigen::Vector3d n = pose.linear().col(2).normalized();
  return dCreatePlane(nullptr, n.x(), n.y(), n.z(), n.dot(pose.translation()));
}

dGeomID Shapes::make_mesh(const TriangleMesh& mesh) {
  Triangles& t = triangles_.emplace_back();
  for (const Eigen::Vector3d& v : mesh.vertices) t.vertices.insert(t.vertices.end(), {v.x(), v.y(), v.z()});
  for (const int i : mesh.indices) t.indices.push_back(static_cast<dTriIndex>(i));
  t.data.reset(dGeomTriMeshDataCreate());
  dGeomTriMeshDataBuildDouble(t.data.get(), t.vertices.data(), 3 * sizeof(double),
                              static_cast<int>(mesh.vertices.size()), t.indices.data(),
                              static_cast<int>(t.indices.size()), 3 * sizeof(dTriIndex));
  return dCreateTriMesh(nullptr, t.data.get(), nullptr, nullptr, nullptr);
}

dGeomID Shapes::make_heightfield(const Heightfield& field) {
  // ODE's z runs along our -y: the rows in reverse. It copies the heights.
  std::vector<double> heights;
  heights.reserve(field.heights_m.size());
  for (int row = field.rows - 1; row >= 0; --row) {
    const auto begin = field.heights_m.begin() + static_cast<std::ptrdiff_t>(row) * field.columns;
    heights.insert(heights.end(), begin, begin + field.columns);
  }
  auto& data = heightfields_.emplace_back(dGeomHeightfieldDataCreate());
  dGeomHeightfieldDataBuildDouble(data.get(), heights.data(), 1, field.size_m.x(), field.size_m.y(), field.columns,
                                  field.rows, 1, 0, kGround_m, 0);
  return dCreateHeightfield(nullptr, data.get(), 1);
}

bool Shapes::may_collide(int a, int b) const {
  return a != b && !std::binary_search(apart_.begin(), apart_.end(), std::pair(std::min(a, b), std::max(a, b)));
}

void Shapes::near(void* self, dGeomID ga, dGeomID gb) {
  Shapes& s = *static_cast<Shapes*>(self);
  auto a = reinterpret_cast<std::size_t>(dGeomGetData(ga));
  auto b = reinterpret_cast<std::size_t>(dGeomGetData(gb));
  int body_a = s.body_of_[a], body_b = s.body_of_[b];
  if (!s.may_collide(body_a, body_b)) return;
  if (body_a > body_b) {
    std::swap(ga, gb);
    std::swap(a, b);
    std::swap(body_a, body_b);
  }
  const int count = dCollide(ga, gb, kMostRaw, s.raw_.data(), sizeof(dContactGeom));
  s.found_.clear();
  for (int i = 0; i < count; ++i) {
    const dContactGeom& c = s.raw_[static_cast<std::size_t>(i)];
    ManifoldPoint p;
    p.point_m = to_eigen(c.pos);
    p.normal = -to_eigen(c.normal);  // ODE's points into its first geometry
    p.depth_m = c.depth;
    if (!p.normal.allFinite() || !p.point_m.allFinite() || std::abs(p.normal.norm() - 1) > 1e-3) continue;
    // A capsule against a mesh also reports the near side of its axis, without depth.
    if (p.depth_m <= 0 && count > 1) continue;
    p.triangle_a = s.is_mesh_[a] ? c.side1 : -1;
    p.triangle_b = s.is_mesh_[b] ? c.side2 : -1;
    s.found_.push_back(p);
  }
  if (s.found_.empty()) return;
  Manifold& m = s.out_->emplace_back();
  m.shape_a = static_cast<int>(a), m.shape_b = static_cast<int>(b);
  m.body_a = body_a, m.body_b = body_b;
  reduce_points(s.found_, m);
}

void Shapes::collide(std::vector<Manifold>& out) {
  out.clear();
  out_ = &out;
  dSpaceCollide(space_.get(), this, near);
  std::sort(out.begin(), out.end(), [](const Manifold& x, const Manifold& y) { return x.before(y); });
}

}  // namespace tactus::sim::ode
