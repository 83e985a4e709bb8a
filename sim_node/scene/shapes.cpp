#include "sim_node/scene/shapes.h"

#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Heightmap.hh>
#include <sdf/Mesh.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>
#include <sstream>
#include <stdexcept>

#include "lcmtypes/height_map.h"
#include "sim_node/scene/materials/height_image.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/scene/sdf/sdf_eigen.h"
#include "sim_node/model/triangles.h"

namespace tactus::sim {
namespace {

// Of all height maps of a scene, each size of one counts: two of the largest, 270 MB.
constexpr std::size_t kMaxHeightSamples = std::size_t{2} * kMaxHeightMapSide * kMaxHeightMapSide;

int heightfield_index(LoadContext& context, const sdf::Heightmap& map, const sdf::Element& element) {
  const Eigen::Vector3d size = to_eigen(map.Size()), centre = to_eigen(map.Position());
  if (!size.allFinite() || (size.array() <= 0).any() || !centre.allFinite())
    context.reject(element, "has a <size> that is not positive or a <pos> that is not finite");
  const std::filesystem::path file = context.asset_file(map.Uri(), element);
  std::ostringstream key;
  key << file.string() << "|height|" << size.transpose() << '|' << centre.transpose();
  const auto [at, is_new] = context.mesh_of.try_emplace(key.str(), static_cast<int>(context.world.heightfields.size()));
  if (is_new) try {
      Heightfield field = read_height_image(file, size, centre, context.pictures);
      std::size_t samples = field.heights_m.size();
      for (const Heightfield& other : context.world.heightfields) samples += other.heights_m.size();
      if (samples > kMaxHeightSamples)
        throw std::runtime_error("with it the height maps of the scene have more than " +
                                 std::to_string(kMaxHeightSamples) + " samples: use smaller ones, or fewer sizes of one");
      context.world.heightfields.push_back(std::move(field));
    } catch (const std::exception& e) {
      context.reject(element, "names height image \"" + map.Uri() + "\", which cannot be read: " + e.what());
    }
  return at->second;
}

void require_positive(const LoadContext& context, const sdf::Element& owner, const ShapeDef& shape) {
  // Unused sizes of a kind are 1.
  if (!shape.size_m.allFinite() || (shape.size_m.array() <= 0).any() || shape.size_m.maxCoeff() > 1e6)
    context.reject(owner, "has a size that is zero, negative or not finite: every length must be above 0 m");
}

}  // namespace

std::optional<ShapeDef> read_shape(LoadContext& context, const sdf::Geometry& geometry, const sdf::ElementPtr& owner,
                                   const Eigen::Isometry3d& pose) {
  ShapeDef shape;
  shape.pose = pose;
  const sdf::ElementPtr inside = geometry.Element() ? geometry.Element()->GetFirstElement() : nullptr;
  const sdf::Element& element = inside ? *inside : *owner;
  switch (geometry.Type()) {
    case sdf::GeometryType::BOX:
      shape.kind = ShapeKind::kBox;
      shape.size_m = to_eigen(geometry.BoxShape()->Size());
      break;
    case sdf::GeometryType::SPHERE:
      shape.kind = ShapeKind::kSphere;
      shape.size_m = {geometry.SphereShape()->Radius(), 1, 1};
      break;
    case sdf::GeometryType::CYLINDER:
      shape.kind = ShapeKind::kCylinder;
      shape.size_m = {geometry.CylinderShape()->Radius(), 1, geometry.CylinderShape()->Length()};
      break;
    case sdf::GeometryType::CAPSULE:
      shape.kind = ShapeKind::kCapsule;
      shape.size_m = {geometry.CapsuleShape()->Radius(), 1, geometry.CapsuleShape()->Length()};
      break;
    case sdf::GeometryType::PLANE: {
      const Eigen::Vector3d normal = to_eigen(geometry.PlaneShape()->Normal());
      if (!normal.allFinite() || normal.norm() < 1e-6) context.reject(element, "has a <normal> without direction");
      shape.kind = ShapeKind::kPlane;
      shape.size_m = {geometry.PlaneShape()->Size().X(), geometry.PlaneShape()->Size().Y(), 1};
      shape.pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal));
      break;
    }
    case sdf::GeometryType::MESH:
      shape.kind = ShapeKind::kMesh;
      shape.mesh = collision_mesh(context, named_mesh(context, *geometry.MeshShape(), element), element);
      break;
    case sdf::GeometryType::HEIGHTMAP:
      shape.kind = ShapeKind::kHeightfield;
      shape.mesh = heightfield_index(context, *geometry.HeightmapShape(), element);
      break;
    default:
      return std::nullopt;
  }
  require_positive(context, element, shape);
  if (shape.kind == ShapeKind::kSphere) shape.size_m.y() = shape.size_m.z() = 0;
  if (shape.kind == ShapeKind::kCylinder || shape.kind == ShapeKind::kCapsule) shape.size_m.y() = 0;
  if (shape.kind == ShapeKind::kPlane) shape.size_m.z() = 0;
  return shape;
}

Eigen::AlignedBox3d bounds(const WorldDef& world, const ShapeDef& shape) {
  const Eigen::Matrix3d turn = shape.pose.linear();
  const Eigen::Vector3d centre = shape.pose.translation();
  const auto box_around = [&](const Eigen::Vector3d& half) { return Eigen::AlignedBox3d(centre - half, centre + half); };
  const double r = shape.size_m.x(), half_length = shape.size_m.z() / 2;
  const Eigen::Vector3d z = turn.col(2).cwiseAbs();
  switch (shape.kind) {
    case ShapeKind::kBox:
      return box_around(turn.cwiseAbs() * shape.size_m / 2);
    case ShapeKind::kSphere:
      return box_around(Eigen::Vector3d::Constant(r));
    case ShapeKind::kCapsule:
      return box_around(z * half_length + Eigen::Vector3d::Constant(r));
    case ShapeKind::kCylinder:  // a disc of normal z reaches r sqrt(1 - z_i^2) along axis i
      return box_around(z * half_length + r * (1 - z.array().square()).max(0).sqrt().matrix());
    case ShapeKind::kMesh:
      return bounds(world.meshes[static_cast<std::size_t>(shape.mesh)], shape.pose);
    case ShapeKind::kHeightfield: {
      const Heightfield& field = world.heightfields[static_cast<std::size_t>(shape.mesh)];
      const Eigen::Vector3d middle = field.centre_m + Eigen::Vector3d(0, 0, field.size_m.z() / 2);
      const Eigen::Vector3d half = turn.cwiseAbs() * field.size_m / 2, at = shape.pose * middle;
      return Eigen::AlignedBox3d(at - half, at + half);
    }
    case ShapeKind::kPlane:
      break;
  }
  return {};
}

}  // namespace tactus::sim
