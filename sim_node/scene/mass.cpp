#include "sim_node/scene/mass.h"

#include <algorithm>
#include <numbers>

#include "sim_node/model/mesh_solid.h"

namespace tactus::sim {
namespace {

constexpr double kPi = std::numbers::pi;

MassProperties box(const Eigen::Vector3d& size, double density) {
  MassProperties m;
  m.mass_kg = density * size.prod();
  const Eigen::Vector3d s = size.cwiseAbs2() * m.mass_kg / 12;
  m.inertia_kg_m2.diagonal() << s.y() + s.z(), s.z() + s.x(), s.x() + s.y();
  return m;
}

MassProperties cylinder(double r, double length, double density) {
  MassProperties m;
  m.mass_kg = density * kPi * r * r * length;
  const double across = m.mass_kg * (3 * r * r + length * length) / 12;
  m.inertia_kg_m2.diagonal() << across, across, m.mass_kg * r * r / 2;
  return m;
}

MassProperties sphere(double r, double density) {
  MassProperties m;
  m.mass_kg = density * 4 / 3 * kPi * r * r * r;
  m.inertia_kg_m2.diagonal().setConstant(0.4 * m.mass_kg * r * r);
  return m;
}

// A cylinder and two half spheres, whose centres of mass lie 3/8 r outside the ends of the cylinder.
MassProperties capsule(double r, double length, double density) {
  MassProperties m = cylinder(r, length, density);
  const MassProperties caps = sphere(r, density);
  const double offset = length / 2 + 3 * r / 8;
  const double across = caps.mass_kg * (0.4 * r * r - 9 * r * r / 64 + offset * offset);
  m.mass_kg += caps.mass_kg;
  m.inertia_kg_m2.diagonal() += Eigen::Vector3d(across, across, 0.4 * caps.mass_kg * r * r);
  return m;
}

// In the shape's frame.
MassProperties of_shape(const WorldDef& world, const ShapeDef& shape, double density, std::vector<MassRemark>* remarks) {
  const Eigen::Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::kBox:
      return box(size, density);
    case ShapeKind::kSphere:
      return sphere(size.x(), density);
    case ShapeKind::kCylinder:
      return cylinder(size.x(), size.z(), density);
    case ShapeKind::kCapsule:
      return capsule(size.x(), size.z(), density);
    case ShapeKind::kMesh: {
      const MeshSolid solid = solid_of(world.meshes[static_cast<std::size_t>(shape.mesh)]);
      if (remarks && !solid.remark.empty()) remarks->push_back({shape.name, solid.remark});
      return {density * solid.integral.volume_m3, solid.integral.centroid_m, density * solid.integral.inertia};
    }
    case ShapeKind::kPlane:
    case ShapeKind::kHeightfield:
      break;
  }
  return {};
}

// Huygens and Steiner: inertia about a point at `offset` from the centre of mass.
Eigen::Matrix3d steiner(double mass_kg, const Eigen::Vector3d& offset) {
  return mass_kg * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
}

}  // namespace

MassProperties mass_of(const WorldDef& world, std::span<const ShapeDef> shapes, bool& has_density,
                       std::vector<MassRemark>* remarks) {
  has_density = std::all_of(shapes.begin(), shapes.end(), [](const ShapeDef& s) { return s.material >= 0; });
  std::vector<MassProperties> parts;
  MassProperties sum;
  for (const ShapeDef& shape : shapes) {
    const double density = has_density ? world.materials[static_cast<std::size_t>(shape.material)].density_kg_m3 : 1;
    MassProperties part = of_shape(world, shape, density, remarks);
    const Eigen::Matrix3d turn = shape.pose.linear();
    part.centre_of_mass_m = shape.pose * part.centre_of_mass_m;
    part.inertia_kg_m2 = turn * part.inertia_kg_m2 * turn.transpose();
    sum.mass_kg += part.mass_kg;
    sum.centre_of_mass_m += part.mass_kg * part.centre_of_mass_m;
    parts.push_back(part);
  }
  if (sum.mass_kg <= 0) return {};
  sum.centre_of_mass_m /= sum.mass_kg;
  for (const MassProperties& part : parts)
    sum.inertia_kg_m2 += part.inertia_kg_m2 + steiner(part.mass_kg, part.centre_of_mass_m - sum.centre_of_mass_m);
  return sum;
}

MassProperties scaled_to(MassProperties properties, double mass_kg) {
  properties.inertia_kg_m2 *= mass_kg / properties.mass_kg;
  properties.mass_kg = mass_kg;
  return properties;
}

}  // namespace tactus::sim
