#include "sim_node/scene/shapes.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "lcmtypes/height_map.h"
#include "lcmtypes/turn_between.h"
#include "sim_node/scene/materials/height_image.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/scene/sdf/values.h"
#include "sim_node/model/triangles.h"

namespace tactus::sim {
namespace {

// Of all height maps of a scene, each size of one counts: two of the largest, 270 MB.
constexpr std::size_t kMaxHeightSamples = std::size_t{2} * kMaxHeightMapSide * kMaxHeightMapSide;

int heightfield_index(LoadContext& context, const sdf::Element& element) {
  const Eigen::Vector3d size = sdf::child_vector3(&element, "size", {1, 1, 1});
  const Eigen::Vector3d centre = sdf::child_vector3(&element, "pos", {0, 0, 0});
  if ((size.array() <= 0).any()) context.reject(element, "has a <size> that is not positive");
  const sdf::Element* named = element.child("uri");
  const std::string uri(named ? named->text : "");
  if (uri.empty()) context.reject(element, "lacks its <uri>");
  const std::filesystem::path file = context.asset_file(uri, element);
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
      context.reject(element, "names height image \"" + uri + "\", which cannot be read: " + e.what());
    }
  return at->second;
}

void require_positive(const LoadContext& context, const sdf::Element& owner, const ShapeDef& shape) {
  // Unused sizes of a kind are 1.
  if (!shape.size_m.allFinite() || (shape.size_m.array() <= 0).any() || shape.size_m.maxCoeff() > 1e6)
    context.reject(owner, "has a size that is zero, negative or not finite: every length must be above 0 m");
}

constexpr const char* kShapes[] = {"box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightmap"};

// SDF's defaults for lengths that are missing (cylinder_shape.sdf, capsule_shape.sdf, ...).
constexpr double kSdfRadius_m = 1, kSdfCapsuleRadius_m = 0.5, kSdfLength_m = 1;

void read_plane(const LoadContext& context, const sdf::Element& plane, ShapeDef& shape) {
  const sdf::Element* size = plane.child("size");
  const Eigen::Vector3d normal = sdf::child_vector3(&plane, "normal", {0, 0, 1});
  if (normal.norm() < 1e-6) context.reject(plane, "has a <normal> without direction");
  shape.size_m << (size ? sdf::vector2(*size) : Eigen::Vector2d(1, 1)), 1;
  // Normalized as libignition-math does, so that the world is the same to the bit.
  shape.pose.rotate(turn_between(Eigen::Vector3d::UnitZ(), normal / std::sqrt(normal.squaredNorm())));
}

// Kind, sizes (unused ones are 1) and mesh.
void read_sizes(LoadContext& context, const sdf::Element& element, ShapeDef& shape) {
  if (element.name == "box") {
    shape.kind = ShapeKind::kBox;
    shape.size_m = sdf::child_vector3(&element, "size", {1, 1, 1});
  } else if (element.name == "sphere") {
    shape.kind = ShapeKind::kSphere;
    shape.size_m = {sdf::child_number(&element, "radius", kSdfRadius_m), 1, 1};
  } else if (element.name == "cylinder" || element.name == "capsule") {
    const bool is_cylinder = element.name == "cylinder";
    shape.kind = is_cylinder ? ShapeKind::kCylinder : ShapeKind::kCapsule;
    shape.size_m = {sdf::child_number(&element, "radius", is_cylinder ? kSdfRadius_m : kSdfCapsuleRadius_m), 1,
                    sdf::child_number(&element, "length", kSdfLength_m)};
  } else if (element.name == "plane") {
    shape.kind = ShapeKind::kPlane;
    read_plane(context, element, shape);
  } else if (element.name == "mesh") {
    shape.kind = ShapeKind::kMesh;
    shape.mesh = collision_mesh(context, named_mesh(context, element), element);
  } else {
    shape.kind = ShapeKind::kHeightfield;
    shape.mesh = heightfield_index(context, element);
  }
}

}  // namespace

const sdf::Element* geometry_of(const sdf::Element& owner) {
  const sdf::Element* geometry = owner.child("geometry");
  for (const char* name : kShapes)
    if (const sdf::Element* found = sdf::child_of(geometry, name)) return found;
  return nullptr;
}

std::optional<ShapeDef> read_shape(LoadContext& context, const sdf::Element& owner, const Eigen::Isometry3d& pose) {
  const sdf::Element* element = geometry_of(owner);
  if (!owner.child("geometry")) context.warn(owner, "lacks its <geometry> and has no effect");
  if (!element) return std::nullopt;
  ShapeDef shape;
  shape.pose = pose;
  read_sizes(context, *element, shape);
  require_positive(context, *element, shape);
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
