#include "sim_node/contacts/contact_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tactus/material_def_t.hpp>

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// A patch narrower than this share of its length is a line.
constexpr double kLine = 0.01;
constexpr double kImmovable_kg = 1e9;
constexpr double kPoissonDefault = 0.3;

// Returns the distance between the two points furthest apart, and the largest distance of a point from the line
// through them.
std::pair<double, double> extent(const Manifold& c) {
  double length = 0;
  Vector3d from = Vector3d::Zero(), along = Vector3d::UnitX();
  for (const ManifoldPoint& p : c.used())
    for (const ManifoldPoint& q : c.used())
      if ((q.point_m - p.point_m).norm() > length) {
        length = (q.point_m - p.point_m).norm();
        from = p.point_m;
        along = (q.point_m - p.point_m) / length;
      }
  double width = 0;
  for (const ManifoldPoint& p : c.used()) width = std::max(width, (p.point_m - from).cross(along).norm());
  return {length, width};
}

// Area of at most four points in the plane normal to n: the largest of the three quadrilaterals, or the triangle.
double hull_area(const Manifold& c, const Vector3d& n) {
  const auto p = [&](int i) { return c.points[static_cast<std::size_t>(i)].point_m; };
  const auto triangle = [&](int i, int j, int k) { return 0.5 * std::abs((p(j) - p(i)).cross(p(k) - p(i)).dot(n)); };
  if (c.count < 3) return 0;
  if (c.count == 3) return triangle(0, 1, 2);
  const auto four = [&](int i, int j, int k, int l) { return 0.5 * std::abs((p(k) - p(i)).cross(p(l) - p(j)).dot(n)); };
  const double triangles = std::max({triangle(0, 1, 2), triangle(0, 1, 3), triangle(0, 2, 3), triangle(1, 2, 3)});
  return std::max({triangles, four(0, 1, 2, 3), four(0, 2, 1, 3), four(0, 1, 3, 2)});
}

double box_curvature(const SurfaceTraits& s, const Vector3d& p) {
  int edges = 0;
  for (int k = 0; k < 3; ++k)
    if (std::abs(p[k]) > 0.5 * s.size_m[k] - s.edge_radius_m) ++edges;
  // An edge is a quarter of a cylinder, a corner an eighth of a sphere.
  return edges >= 3 ? 1 / s.edge_radius_m : edges == 2 ? 0.5 / s.edge_radius_m : 0;
}

double cylinder_curvature(const SurfaceTraits& s, const Vector3d& p) {
  const bool at_cap = std::abs(p.z()) > 0.5 * s.size_m.z() - s.edge_radius_m;
  const bool at_side = std::hypot(p.x(), p.y()) > s.size_m.x() - s.edge_radius_m;
  return at_cap && at_side ? 0.5 / s.edge_radius_m : at_side ? 0.5 / s.size_m.x() : 0;
}

}  // namespace

ContactKind kind_of(const Manifold& c) {
  if (c.count <= 1) return ContactKind::kPoint;
  const auto [length, width] = extent(c);
  return width > kLine * length ? ContactKind::kSurface : ContactKind::kEdge;
}

std::vector<double> triangle_curvatures(const TriangleMesh& mesh) {
  std::vector<double> out;
  if (mesh.normals.size() != mesh.vertices.size()) return std::vector<double>(mesh.indices.size() / 3, 0.0);
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(mesh.indices[t + k]);
      const auto j = static_cast<std::size_t>(mesh.indices[t + (k + 1) % 3]);
      const Vector3d edge = mesh.vertices[j] - mesh.vertices[i];
      const double square = edge.squaredNorm();
      if (square > 0) sum += (mesh.normals[j] - mesh.normals[i]).dot(edge) / square;
    }
    out.push_back(std::max(0.0, sum / 3));
  }
  return out;
}

std::vector<SurfaceTraits> surface_traits(const WorldDef& world, const Settings& settings) {
  std::vector<SurfaceTraits> out;
  std::vector<std::shared_ptr<const std::vector<double>>> curvatures(world.meshes.size());
  for (const ShapeDef& shape : world.shapes) {
    SurfaceTraits& s = out.emplace_back();
    s.body = shape.body;
    s.material = shape.material;
    s.kind = shape.kind;
    s.size_m = shape.size_m;
    s.in_body = shape.pose;
    s.edge_radius_m = settings.edge_radius_m;
    s.friction_static = s.friction_dynamic = shape.friction;
    s.compliance_1_Pa = (1 - kPoissonDefault * kPoissonDefault) / settings.default_youngs_modulus_Pa;
    if (shape.material >= 0) {
      const material_def_t& m = world.materials[static_cast<std::size_t>(shape.material)];
      s.compliance_1_Pa = (1 - m.poissons_ratio * m.poissons_ratio) / m.youngs_modulus_Pa;
      // The dynamic coefficient is a share of the static one. The shape may override the material's.
      if (m.friction_static > 0) s.friction_dynamic = shape.friction * std::min(1.0, m.friction_dynamic / m.friction_static);
    }
    if (shape.kind != ShapeKind::kMesh || shape.mesh < 0) continue;
    auto& of_mesh = curvatures[static_cast<std::size_t>(shape.mesh)];
    if (!of_mesh)
      of_mesh = std::make_shared<const std::vector<double>>(
          triangle_curvatures(world.meshes[static_cast<std::size_t>(shape.mesh)]));
    s.triangle_curvature_1_m = of_mesh;
    for (const double c : *of_mesh) s.mean_curvature_1_m += c / static_cast<double>(of_mesh->size());
  }
  return out;
}

double curvature(const SurfaceTraits& s, ContactKind kind, const Vector3d& in_body, int triangle) {
  const Vector3d p = s.in_body.inverse() * in_body;
  switch (s.kind) {
    case ShapeKind::kSphere: return 1 / s.size_m.x();
    case ShapeKind::kCapsule: return (std::abs(p.z()) < 0.5 * s.size_m.z() ? 0.5 : 1.0) / s.size_m.x();
    case ShapeKind::kPlane:
    case ShapeKind::kHeightfield: return 0;
    case ShapeKind::kBox: return kind == ContactKind::kSurface ? 0 : box_curvature(s, p);
    case ShapeKind::kCylinder:
      if (kind == ContactKind::kSurface) return 0;
      return kind == ContactKind::kEdge ? 0.5 / s.size_m.x() : cylinder_curvature(s, p);
    case ShapeKind::kMesh:
      if (kind == ContactKind::kSurface) return 0;
      return s.triangle_curvature_1_m && triangle >= 0 &&
                     static_cast<std::size_t>(triangle) < s.triangle_curvature_1_m->size()
                 ? (*s.triangle_curvature_1_m)[static_cast<std::size_t>(triangle)]
                 : s.mean_curvature_1_m;
  }
  return 0;
}

double effective_mass(const BodyMotion& a, const BodyMotion& b, const Vector3d& point, const Vector3d& n) {
  const double sum = mobility(a, point, n) + mobility(b, point, n);
  return sum > 1 / kImmovable_kg ? 1 / sum : kImmovable_kg;
}

double hertz_point_area(double force_N, double curvature_1_m, double compliance_1_Pa) {
  if (!(force_N > 0) || !(curvature_1_m > 0)) return 0;
  const double radius = 1 / curvature_1_m;
  const double a = std::min(radius, std::cbrt(0.75 * force_N * radius * compliance_1_Pa));
  return std::numbers::pi * a * a;
}

double hertz_line_area(double force_N, double curvature_1_m, double compliance_1_Pa, double length_m) {
  if (!(force_N > 0) || !(curvature_1_m > 0) || !(length_m > 0)) return 0;
  // The curvature at a line is all across it: twice the mean of the two principal curvatures.
  const double radius = 0.5 / curvature_1_m;
  const double half = std::min(radius, std::sqrt(4 * force_N * radius * compliance_1_Pa / (std::numbers::pi * length_m)));
  return 2 * half * length_m;
}

double contact_area(const Manifold& c, ContactKind kind, double force_N, double curvature_1_m, double compliance_1_Pa) {
  switch (kind) {
    case ContactKind::kPoint: return hertz_point_area(force_N, curvature_1_m, compliance_1_Pa);
    case ContactKind::kEdge: return hertz_line_area(force_N, curvature_1_m, compliance_1_Pa, extent(c).first);
    case ContactKind::kSurface: break;
  }
  return hull_area(c, c.points[0].normal);
}

}  // namespace tactus::sim
