// Properties of a contact from the geometry of its two surfaces and their materials. Pure.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/contact_kind.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Kind of the contact by the points of the manifold: one point is a point; two points, or all on a line, are an
// edge; others are a surface.
ContactKind kind_of(const Manifold& contact);

// Properties of one surface for its contacts.
struct SurfaceTraits {
  int body = -1;
  int material = -1;
  double compliance_1_Pa = 1e-9;  // (1 - nu^2) / E
  double friction_static = 0.5, friction_dynamic = 0.5;
  ShapeKind kind = ShapeKind::kBox;
  Eigen::Vector3d size_m{1, 1, 1};
  Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  double edge_radius_m = 0.0005;
  std::shared_ptr<const std::vector<double>> triangle_curvature_1_m;  // of a mesh, shared by all its shapes
  double mean_curvature_1_m = 0;               // of a mesh, over its triangles
};

std::vector<SurfaceTraits> surface_traits(const WorldDef& world, const Settings& settings);

// Mean curvature, 1/m, >= 0, at a position in the body frame. Edges and corners are rounded by edge_radius_m. A patch
// has zero curvature. triangle: of a mesh; -1: unknown.
double curvature(const SurfaceTraits& surface, ContactKind kind, const Eigen::Vector3d& in_body, int triangle);

// For each triangle, the mean over its edges of the change of the vertex normal per length (after Rusinkiewicz 2004).
std::vector<double> triangle_curvatures(const TriangleMesh& mesh);

// Effective mass of a collision along n at the point, kg: 1 / (sum of both mobilities). Joints are ignored, so a
// jointed body may seem lighter than it is. 1e9 when neither body moves.
double effective_mass(const BodyMotion& a, const BodyMotion& b, const Eigen::Vector3d& point, const Eigen::Vector3d& n);

// Contact area of pressed bodies, m^2. Point: circle of Hertz, radius (3 F R / 4 E*)^(1/3) (Johnson 1985, Contact
// Mechanics, equation 4.22). Edge of length L: strip of Hertz, half width (4 F R / pi E* L)^(1/2) (equation 4.43). R
// is the inverse of the sum of curvatures. The contact is at most as wide as R.
double hertz_point_area(double force_N, double curvature_1_m, double compliance_1_Pa);
double hertz_line_area(double force_N, double curvature_1_m, double compliance_1_Pa, double length_m);

// The same for a manifold. A patch has the area of the convex hull of its points in the tangent plane.
double contact_area(const Manifold& contact, ContactKind kind, double force_N, double curvature_1_m,
                    double compliance_1_Pa);

}  // namespace tactus::sim
