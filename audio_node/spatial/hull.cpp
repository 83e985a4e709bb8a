#include "audio_node/spatial/hull.h"

#include <Eigen/Geometry>
#include <cmath>
#include <set>
#include <utility>

namespace tactus::audio {
namespace {

using Eigen::Vector3d;

constexpr double kFlat = 1e-4;    // height of four points over their plane, below which they count as coplanar
constexpr double kNudge = 1e-6;   // moves points out of common planes: far below audible or measurable differences
constexpr double kAbove = 1e-12;  // rounding of a distance to a plane

struct Face {
  Triangle corners;
  Vector3d normal;
  double offset;
};

class Hull {
 public:
  explicit Hull(const std::vector<Vector3d>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto x = static_cast<double>(i + 1);
      // Fractional parts of multiples of irrational numbers: evenly distributed and reproducible.
      const Vector3d nudge(std::fmod(x * 0.6180339887, 1), std::fmod(x * 0.7548776662, 1),
                           std::fmod(x * 0.5698402910, 1));
      points_.push_back(points[i] + kNudge * (nudge - Vector3d::Constant(0.5)));
    }
  }

  bool build_tetrahedron() {
    if (points_.size() < 4) return false;
    const auto farthest = [&](auto distance) {
      int best = 0;
      for (int i = 1; i < static_cast<int>(points_.size()); ++i)
        if (distance(at(i)) > distance(at(best))) best = i;
      return best;
    };
    const Vector3d a = at(0);
    const int b = farthest([&](const Vector3d& p) { return (p - a).norm(); });
    const Vector3d ab = (at(b) - a).normalized();
    const int c = farthest([&](const Vector3d& p) { return (p - a).cross(ab).norm(); });
    const Vector3d normal = ab.cross(at(c) - a).normalized();
    const int d = farthest([&](const Vector3d& p) { return std::abs((p - a).dot(normal)); });
    if (!(std::abs((at(d) - a).dot(normal)) > kFlat)) return false;
    inside_ = (a + at(b) + at(c) + at(d)) / 4;
    for (const Triangle t : {Triangle{0, b, c}, {0, b, d}, {0, c, d}, {b, c, d}}) add(t);
    return true;
  }

  // Removes the faces that the point sees; new faces connect their rim to it.
  void add_point(int point) {
    std::set<std::pair<int, int>> rim;
    std::erase_if(faces_, [&](const Face& f) {
      if (f.normal.dot(at(point)) <= f.offset + kAbove) return false;
      for (std::size_t i = 0; i < 3; ++i) {
        const int from = f.corners[i], to = f.corners[(i + 1) % 3];
        if (!rim.erase({to, from})) rim.insert({from, to});
      }
      return true;
    });
    for (const auto& [from, to] : rim) add({from, to, point});
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> all;
    for (const Face& f : faces_) all.push_back(f.corners);
    return all;
  }

 private:
  const Vector3d& at(int i) const { return points_[static_cast<std::size_t>(i)]; }
  void add(Triangle t) {
    Vector3d normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).normalized();
    double offset = normal.dot(at(t[0]));
    if (normal.dot(inside_) > offset) {
      std::swap(t[1], t[2]);
      normal = -normal, offset = -offset;
    }
    faces_.push_back({t, normal, offset});
  }

  std::vector<Vector3d> points_;
  std::vector<Face> faces_;
  Vector3d inside_;
};

}  // namespace

std::vector<Triangle> convex_hull(const std::vector<Vector3d>& points) {
  Hull hull(points);
  if (!hull.build_tetrahedron()) return {};
  for (int i = 0; i < static_cast<int>(points.size()); ++i) hull.add_point(i);
  return hull.triangles();
}

std::vector<double> solid_angles(const std::vector<Vector3d>& directions) {
  std::vector<double> all(directions.size());
  for (const Triangle& t : convex_hull(directions)) {
    const auto at = [&](std::size_t k) { return directions[static_cast<std::size_t>(t[k])].normalized(); };
    const Vector3d a = at(0), b = at(1), c = at(2);
    // Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983, eq. 8.
    const double whole = 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
    for (const int k : t) all[static_cast<std::size_t>(k)] += whole / 3;
  }
  return all;
}

}  // namespace tactus::audio
