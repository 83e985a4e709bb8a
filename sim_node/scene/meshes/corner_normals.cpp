#include "sim_node/scene/meshes/corner_normals.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace tactus::sim {
namespace {

using Index = std::size_t;

// More triangles around one point than usual surfaces have. The cost of such a fan is quadratic, so it gets its plain
// mean, which is summed once.
constexpr Index kMaxAround = 256;

struct Around {
  std::vector<Index> triangles;
  Eigen::Vector3d sum{0, 0, 0};  // of the areas of all triangles
};

}  // namespace

void make_corner_normals(MeshPart& part, float crease_deg) {
  const auto at = [&](Index corner) { return static_cast<Index>(part.indices[corner]); };
  const double cosine = std::cos(crease_deg * std::numbers::pi / 180);
  std::vector<Eigen::Vector3d> areas, directions;  // per triangle
  std::map<std::array<float, 3>, Around> around;
  for (Index t = 0; t + 2 < part.indices.size(); t += 3) {
    const Eigen::Vector3d a = part.positions_m[at(t)].cast<double>();
    areas.push_back(
        (part.positions_m[at(t + 1)].cast<double>() - a).cross(part.positions_m[at(t + 2)].cast<double>() - a));
    directions.push_back(areas.back().stableNormalized());
    for (Index k = 0; k < 3; ++k) {
      const Eigen::Vector3f& p = part.positions_m[at(t + k)];
      Around& at_point = around[{p.x(), p.y(), p.z()}];
      at_point.triangles.push_back(t / 3);
      at_point.sum += areas.back();
    }
  }
  MeshPart out = part;
  out.positions_m.clear(), out.texcoords.clear(), out.tangents.clear(), out.normals.clear();
  std::map<std::pair<Index, std::array<float, 3>>, int> known;
  for (Index c = 0; c < part.indices.size(); ++c) {
    const Eigen::Vector3f& p = part.positions_m[at(c)];
    const Around& near = around[{p.x(), p.y(), p.z()}];
    Eigen::Vector3d sum = near.triangles.size() > kMaxAround ? near.sum : Eigen::Vector3d(0, 0, 0);
    if (near.triangles.size() <= kMaxAround)
      for (const Index t : near.triangles)
        if (t == c / 3 || directions[t].dot(directions[c / 3]) > cosine) sum += areas[t];
    const Eigen::Vector3f n = sum.stableNormalized().cast<float>();
    const auto [vertex, is_new] =
        known.try_emplace({at(c), {n.x(), n.y(), n.z()}}, static_cast<int>(out.positions_m.size()));
    if (is_new) {
      out.positions_m.push_back(p), out.normals.push_back(n);
      if (!part.texcoords.empty()) out.texcoords.push_back(part.texcoords[at(c)]);
    }
    out.indices[c] = vertex->second;
  }
  part = std::move(out);
}

}  // namespace tactus::sim
