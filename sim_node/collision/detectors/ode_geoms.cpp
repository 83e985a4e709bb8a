#include "sim_node/collision/detectors/ode_geoms.h"

#include <numbers>

namespace tactus::sim::ode {
namespace {

// Thickness of the plate that represents a moving plane, m. ODE's planes cannot move.
constexpr double kPlate_m = 0.01;
// Depth to which ODE's heightfields are solid below their lowest sample, m.
constexpr double kGround_m = 1;

}  // namespace

dGeomID Geoms::make(const WorldDef& world, const ShapeDef& shape, bool is_static, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d& s = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::kBox: return dCreateBox(nullptr, s.x(), s.y(), s.z());
    case ShapeKind::kSphere: return dCreateSphere(nullptr, s.x());
    case ShapeKind::kCylinder: return dCreateCylinder(nullptr, s.x(), s.z());
    case ShapeKind::kCapsule: return dCreateCapsule(nullptr, s.x(), s.z());
    case ShapeKind::kMesh: return make_mesh(world, shape.mesh);
    case ShapeKind::kHeightfield:
      return make_heightfield(world.heightfields.at(static_cast<std::size_t>(shape.mesh)));
    case ShapeKind::kPlane: break;
  }
  if (!is_static) return dCreateBox(nullptr, s.x(), s.y(), kPlate_m);
  const Eigen::Vector3d n = pose.linear().col(2).normalized();
  return dCreatePlane(nullptr, n.x(), n.y(), n.z(), n.dot(pose.translation()));
}

Eigen::Isometry3d Geoms::geom_pose(const WorldDef& world, const ShapeDef& shape, const Eigen::Isometry3d& pose) {
  Eigen::Isometry3d out = pose;
  if (shape.kind == ShapeKind::kPlane) out.translate(Eigen::Vector3d(0, 0, -kPlate_m / 2));
  if (shape.kind == ShapeKind::kHeightfield) {
    out.translate(world.heightfields[static_cast<std::size_t>(shape.mesh)].centre_m);
    out.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  }
  return out;
}

dGeomID Geoms::make_mesh(const WorldDef& world, int number) {
  const auto [at, is_new] = triangles_.try_emplace(number);
  Triangles& t = at->second;
  if (!is_new) return dCreateTriMesh(nullptr, t.data.get(), nullptr, nullptr, nullptr);
  const TriangleMesh& mesh = world.meshes.at(static_cast<std::size_t>(number));
  for (const Eigen::Vector3d& v : mesh.vertices) t.vertices.insert(t.vertices.end(), {v.x(), v.y(), v.z()});
  for (const int i : mesh.indices) t.indices.push_back(static_cast<dTriIndex>(i));
  t.data.reset(dGeomTriMeshDataCreate());
  dGeomTriMeshDataBuildDouble(t.data.get(), t.vertices.data(), 3 * sizeof(double),
                              static_cast<int>(mesh.vertices.size()), t.indices.data(),
                              static_cast<int>(t.indices.size()), 3 * sizeof(dTriIndex));
  return dCreateTriMesh(nullptr, t.data.get(), nullptr, nullptr, nullptr);
}

dGeomID Geoms::make_heightfield(const Heightfield& field) {
  // ODE's z axis is our -y axis, so the rows are reversed. ODE copies the heights.
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

}  // namespace tactus::sim::ode
