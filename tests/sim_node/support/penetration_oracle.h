// Penetration depth by other methods than the detectors with gaps. Round shapes, planes and boxes use ODE's closed
// forms. Cylinders, for which ODE's depth has a wrong direction, use a search over all directions for the least
// overlap. Meshes test all triangles of one against points all over the other: the depth is the distance of the
// deepest inside point from the surface.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/collision/detector.h"
#include "sim_node/model/triangles.h"
#include "sim_node/model/world_def.h"
#include "tests/sim_node/support/triangle_oracle.h"

namespace tactus::sim::test {

class PenetrationOracle {
 public:
  explicit PenetrationOracle(const WorldDef& world) : world_(world), ode_(make_detector("ode")) {
    for (const ShapeDef& s : world.shapes) {
      Shape& shape = shapes_.emplace_back();
      shape.ode = ode_->add(s, world);
      shape.bound_m = s.size_m.norm();
      if (s.kind == ShapeKind::kMesh) shape.mesh = &world.meshes[static_cast<std::size_t>(s.mesh)];
      if (shape.mesh) {
        shape.bound_m = 0;
        for (const auto& v : shape.mesh->vertices) shape.bound_m = std::max(shape.bound_m, v.norm());
      }
      if (s.kind == ShapeKind::kPlane || s.kind == ShapeKind::kHeightfield) shape.bound_m = 1e9;
    }
    for (const auto& [a, b] : world.no_collision) excluded_pairs_.emplace_back(std::min(a, b), std::max(a, b));
  }

  struct Deepest {
    double depth_m = 0;
    int shape_a = -1, shape_b = -1;
  };
  // Over all pairs of shapes of different bodies of which one moves.
  Deepest deepest(std::span<const BodyMotion> bodies) {
    Deepest out;
    const std::size_t n = world_.shapes.size();
    poses_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const BodyMotion& b = bodies[static_cast<std::size_t>(world_.shapes[i].body)];
      poses_[i] = Eigen::Translation3d(b.position_m) * b.orientation * world_.shapes[i].pose;
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        if (!may_touch(world_.shapes[i].body, world_.shapes[j].body)) continue;
        const double reach = shapes_[i].bound_m + shapes_[j].bound_m;
        if ((poses_[i].translation() - poses_[j].translation()).squaredNorm() > reach * reach) continue;
        const double depth = pair(i, j);
        if (depth > out.depth_m) out = {depth, static_cast<int>(i), static_cast<int>(j)};
      }
    return out;
  }

 private:
  using Vector3d = Eigen::Vector3d;
  struct Shape {
    int ode = -1;
    double bound_m = 0;
    const TriangleMesh* mesh = nullptr;
  };

  bool may_touch(int a, int b) const {
    const auto moves = [&](int i) { return !world_.bodies[static_cast<std::size_t>(i)].is_static; };
    const auto tool = [&](int i) { return world_.bodies[static_cast<std::size_t>(i)].tool >= 0; };
    if (a == b || tool(a) || tool(b) || (!moves(a) && !moves(b))) return false;
    const std::pair<int, int> key(std::min(a, b), std::max(a, b));
    return std::find(excluded_pairs_.begin(), excluded_pairs_.end(), key) == excluded_pairs_.end();
  }

  double pair(std::size_t i, std::size_t j) {
    if (!shapes_[i].mesh && !shapes_[j].mesh) {
      ode_->query(shapes_[i].ode, poses_[i], shapes_[j].ode, poses_[j], 0, pairs_);
      double depth = 0;
      Vector3d direction = Vector3d::UnitZ();
      for (const PointPair& p : pairs_)
        if (-p.gap_m > depth) depth = -p.gap_m, direction = p.normal;
      const auto is_cylinder = [&](std::size_t k) { return world_.shapes[k].kind == ShapeKind::kCylinder; };
      const bool plane = world_.shapes[i].kind == ShapeKind::kPlane || world_.shapes[j].kind == ShapeKind::kPlane;
      return depth > 0 && !plane && (is_cylinder(i) || is_cylinder(j)) ? min_overlap(i, j, direction) : depth;
    }
    return shapes_[i].mesh ? of_mesh(i, j) : of_mesh(j, i);
  }

  // Support distance of a convex shape along a world direction.
  double reach(std::size_t i, const Vector3d& along) const {
    const ShapeDef& s = world_.shapes[i];
    const Vector3d d = poses_[i].linear().transpose() * along;
    const double at = poses_[i].translation().dot(along), across = std::hypot(d.x(), d.y());
    switch (s.kind) {
      case ShapeKind::kSphere: return at + s.size_m.x();
      case ShapeKind::kCapsule: return at + s.size_m.x() + s.size_m.z() / 2 * std::abs(d.z());
      case ShapeKind::kCylinder: return at + s.size_m.x() * across + s.size_m.z() / 2 * std::abs(d.z());
      default: return at + s.size_m.cwiseProduct(d.cwiseAbs()).sum() / 2;
    }
  }
  // The least overlap over all directions, from i to j. 0: a direction separates the two, which proves that they do
  // not overlap.
  double min_overlap(std::size_t i, std::size_t j, const Vector3d& guess) const {
    const auto overlap = [&](const Vector3d& n) { return reach(i, n) + reach(j, -n); };
    std::vector<Vector3d> starts{guess, poses_[i].linear().col(2), poses_[j].linear().col(2),
                                 poses_[i].linear().col(2).cross(poses_[j].linear().col(2))};
    for (int k = 0; k < 200; ++k) {  // a spiral over the sphere
      const double z = 1 - (2 * k + 1) / 200.0, r = std::sqrt(1 - z * z), turn = 2.399963 * k;
      starts.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    double least = 1e9;
    for (const Vector3d& start : starts)
      for (const double sign : {1.0, -1.0}) {
        if (!(start.norm() > 1e-9)) continue;
        Vector3d n = sign * start.normalized();
        double best = overlap(n);
        if (best > least + 0.05) continue;
        for (double step = 0.2; step > 1e-7; step /= 2)
          for (bool better = true; better;) {
            better = false;
            const Vector3d u = n.unitOrthogonal(), v = n.cross(u);
            for (const Vector3d& by : {u, Vector3d(-u), v, Vector3d(-v)}) {
              const Vector3d m = (n + step * by).normalized();
              if (overlap(m) >= best) continue;
              best = overlap(m), n = m, better = true;
              break;
            }
          }
        least = std::min(least, best);
        if (least <= 0) return 0;
      }
    return least;
  }

  static Corners corners(const TriangleMesh& m, std::size_t t) {
    const auto at = [&](std::size_t k) { return m.vertices[static_cast<std::size_t>(m.indices[3 * t + k])]; };
    return {at(0), at(1), at(2)};
  }
  static std::size_t triangles(const TriangleMesh& m) { return m.indices.size() / 3; }

  // Winding number of the surface around a point: 1 inside a closed one (van Oosterom and Strackee 1983, equation 8).
  static double winding(const TriangleMesh& m, const Vector3d& p) {
    double sum = 0;
    for (std::size_t t = 0; t < triangles(m); ++t) {
      const Corners c = corners(m, t);
      const Vector3d x = c[0] - p, y = c[1] - p, z = c[2] - p;
      const double a = x.norm(), b = y.norm(), d = z.norm();
      sum += 2 * std::atan2(x.dot(y.cross(z)), a * b * d + x.dot(y) * d + y.dot(z) * a + z.dot(x) * b);
    }
    return sum / (4 * M_PI);
  }

  static Vector3d nearest(const Vector3d& p, const Corners& t) {
    // Ericson 2005, Real-Time Collision Detection, section 5.1.5: by the regions of the triangle.
    const Vector3d ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                 d6 = ac.dot(cp);
    if (d1 <= 0 && d2 <= 0) return t[0];
    if (d3 >= 0 && d4 <= d3) return t[1];
    if (d6 >= 0 && d5 <= d6) return t[2];
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + d1 / (d1 - d3) * ab;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + d2 / (d2 - d6) * ac;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]);
    return t[0] + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
  }
  static double distance(const TriangleMesh& m, const Vector3d& p) {
    double best = 1e9;
    for (std::size_t t = 0; t < triangles(m); ++t) best = std::min(best, (nearest(p, corners(m, t)) - p).norm());
    return best;
  }

  // Test points of a shape that may be inside a mesh: its corners or points on its edges, in its own frame, with
  // their rounding radius.
  struct Probe {
    Vector3d place;
    double round_m = 0;
  };
  static void probe_edge(const Vector3d& a, const Vector3d& b, double step_m, std::vector<Probe>& out) {
    const int n = std::clamp(static_cast<int>((b - a).norm() / step_m), 1, 40);
    for (int i = 0; i <= n; ++i) out.push_back({a + (b - a) * i / n, 0});
  }
  void probes_of(std::size_t j, std::vector<Probe>& out) const {
    const ShapeDef& s = world_.shapes[j];
    out.clear();
    const Vector3d h = s.size_m / 2;
    const auto corner = [&](int i) {
      return Vector3d(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
    };
    switch (s.kind) {
      case ShapeKind::kSphere: out.push_back({{0, 0, 0}, s.size_m.x()}); break;
      case ShapeKind::kCapsule:
        for (int i = 0; i <= 20; ++i) out.push_back({{0, 0, s.size_m.z() * (i / 20.0 - 0.5)}, s.size_m.x()});
        break;
      case ShapeKind::kCylinder:
        for (int i = 0; i < 32; ++i)
          for (const double z : {-h.z(), 0.0, h.z()})
            out.push_back(
                {{s.size_m.x() * std::cos(i * M_PI / 16), s.size_m.x() * std::sin(i * M_PI / 16), z}, 0});
        break;
      case ShapeKind::kMesh: {
        const TriangleMesh& m = *shapes_[j].mesh;
        for (std::size_t t = 0; t < triangles(m); ++t) {
          const Corners c = corners(m, t);
          for (std::size_t k = 0; k < 3; ++k) probe_edge(c[k], c[(k + 1) % 3], 0.002, out);
        }
        break;
      }
      default:
        for (int i = 0; i < 8; ++i)
          for (const int axis : {1, 2, 4})
            if (!(i & axis)) probe_edge(corner(i), corner(i | axis), 0.002, out);
        break;
    }
  }

  // i is a mesh. j may be one too: then each is tested with the other.
  double of_mesh(std::size_t i, std::size_t j) {
    const TriangleMesh& mesh = *shapes_[i].mesh;
    const ShapeDef& other = world_.shapes[j];
    const Eigen::Isometry3d to_mesh = poses_[i].inverse() * poses_[j], to_other = to_mesh.inverse();
    if (other.kind == ShapeKind::kPlane) {
      double depth = 0;
      for (const Vector3d& v : mesh.vertices) depth = std::max(depth, -(to_other * v).z());
      return depth;
    }
    double depth = probe(mesh, j, to_mesh);
    if (shapes_[j].mesh) return std::max(depth, probe(*shapes_[j].mesh, i, to_other));
    // The mesh's vertices inside a shape that is not a mesh.
    for (const Vector3d& v : mesh.vertices) depth = std::max(depth, inside(other, to_other * v));
    return depth;
  }
  static double inside(const ShapeDef& s, const Vector3d& p) {
    const double across = std::hypot(p.x(), p.y());
    switch (s.kind) {
      case ShapeKind::kSphere: return s.size_m.x() - p.norm();
      case ShapeKind::kCapsule: {
        const double z = std::clamp(p.z(), -s.size_m.z() / 2, s.size_m.z() / 2);
        return s.size_m.x() - (p - Vector3d(0, 0, z)).norm();
      }
      case ShapeKind::kCylinder: return std::min(s.size_m.x() - across, s.size_m.z() / 2 - std::abs(p.z()));
      case ShapeKind::kBox: return (s.size_m / 2 - p.cwiseAbs()).minCoeff();
      default: return 0;
    }
  }
  // Points of shape j inside the mesh.
  double probe(const TriangleMesh& mesh, std::size_t j, const Eigen::Isometry3d& to_mesh) {
    probes_of(j, probes_);
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : mesh.vertices) box.extend(v);
    double depth = 0;
    for (const Probe& p : probes_) {
      const Vector3d at = to_mesh * p.place;
      if (box.exteriorDistance(at) > p.round_m) continue;
      const bool is_inside = winding(mesh, at) > 0.5;
      if (!is_inside && p.round_m == 0) continue;
      const double d = distance(mesh, at);
      depth = std::max(depth, is_inside ? d + p.round_m : p.round_m - d);
    }
    return depth;
  }

  const WorldDef& world_;
  std::unique_ptr<Detector> ode_;
  std::vector<Shape> shapes_;
  std::vector<std::pair<int, int>> excluded_pairs_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<PointPair> pairs_;
  std::vector<Probe> probes_;
};

}  // namespace tactus::sim::test
