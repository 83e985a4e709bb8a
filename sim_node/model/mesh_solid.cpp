#include "sim_node/model/mesh_solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "sim_node/model/mesh_shells.h"

namespace tactus::sim {
namespace {

using Place = std::size_t;
using Eigen::Vector3d;

// Below this share of surface times diagonal a volume is rounding: sixteen digits, less those of sums over many triangles.
// Design.
constexpr double kNoVolumeShare = 1e-9;
// A cap below this share of the surface closes a slit between two parts of a face, not an opening. Design.
constexpr double kSlitShare = 1e-6;
// An open mesh that encloses a smaller share of its bounding box is a sheet. Design.
constexpr double kSheetShare = 1e-3;
// The least thickness of a bounding box, as of bodies without collision. Design.
constexpr double kMinThickness_m = 1e-4;
// Solid angles that the search for cavities may compute: less than a second. Design.
constexpr Place kMaxSolidAngles = 10'000'000, kMaxNestedShells = 2'000;

// Integrals over the tetrahedra between triangles and the origin (Lien and Kajiya 1984, IEEE Computer Graphics 4(10)).
struct Moments {
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // of x x^T

  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double v = a.dot(b.cross(c)) / 6;
    const Vector3d sum = a + b + c;
    volume += v;
    first += v / 4 * sum;
    second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  void add(double factor, const Moments& other) {
    volume += factor * other.volume, first += factor * other.first, second += factor * other.second;
  }
};

struct ShellSolid {
  Moments moments;  // of the shell with caps
  double area_m2 = 0, cap_area_m2 = 0;
  std::size_t open_edges = 0;
  Eigen::AlignedBox3d box;
};

// The rims of a shell, each a list of edges that are connected.
std::vector<std::vector<RimEdge>> connected_rims(const std::vector<RimEdge>& rim) {
  std::map<int, std::vector<Place>> at_vertex;
  for (Place i = 0; i < rim.size(); ++i)
    at_vertex[rim[i].from].push_back(i), at_vertex[rim[i].to].push_back(i);
  std::vector<char> known(rim.size(), 0);
  std::vector<std::vector<RimEdge>> rims;
  for (Place seed = 0; seed < rim.size(); ++seed) {
    if (known[seed]) continue;
    std::vector<Place> members{seed};
    known[seed] = 1;
    for (Place i = 0; i < members.size(); ++i)
      for (const int vertex : {rim[members[i]].from, rim[members[i]].to}) {
        for (const Place next : at_vertex[vertex])
          if (!known[next]) known[next] = 1, members.push_back(next);
        at_vertex[vertex].clear();
      }
    rims.emplace_back();
    for (const Place i : members) rims.back().push_back(rim[i]);
  }
  return rims;
}

// vertices: about an origin near the mesh, so that nothing cancels far from the origin of the file.
ShellSolid solid_of_shell(const MeshShell& shell, const std::vector<Vector3d>& vertices) {
  const auto at = [&](int i) -> const Vector3d& { return vertices[static_cast<Place>(i)]; };
  ShellSolid solid;
  for (const auto& [a, b, c] : shell.triangles) {
    solid.moments.add(at(a), at(b), at(c));
    solid.area_m2 += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
    solid.box.extend(at(a)), solid.box.extend(at(b)), solid.box.extend(at(c));
  }
  for (const std::vector<RimEdge>& rim : connected_rims(shell.rim)) {
    Vector3d middle = Vector3d::Zero(), area = Vector3d::Zero();
    double length = 0;
    for (const RimEdge& e : rim) {
      const double l = (at(e.to) - at(e.from)).norm();
      middle += l / 2 * (at(e.from) + at(e.to)), length += l;
    }
    middle /= length;
    // The cap runs along each edge in the opposite direction.
    for (const RimEdge& e : rim) {
      solid.moments.add(at(e.to), at(e.from), middle);
      area += (at(e.from) - at(e.to)).cross(middle - at(e.to)) / 2;
    }
    solid.cap_area_m2 += area.norm();
  }
  solid.open_edges = shell.rim.size();
  return solid;
}

// Whether the shell winds around the point: the sum of the solid angles of its triangles (van Oosterom and Strackee 1983,
// IEEE Trans. Biomed. Eng. 30(2)) is 4 pi inside and 0 outside.
bool winds_around(const MeshShell& shell, const std::vector<Vector3d>& vertices, const Vector3d& point) {
  double angle = 0;
  for (const auto& [i, j, k] : shell.triangles) {
    const Vector3d a = vertices[static_cast<Place>(i)] - point, b = vertices[static_cast<Place>(j)] - point,
                   c = vertices[static_cast<Place>(k)] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

// The factor of each shell in the sum: +1 or -1 times the sign of its volume. Empty: there are too many shells to examine.
std::vector<double> factors(const MeshShells& mesh, const std::vector<Vector3d>& vertices, const std::vector<ShellSolid>& solids) {
  std::vector<double> sign(solids.size());
  for (Place i = 0; i < solids.size(); ++i) sign[i] = solids[i].moments.volume < 0 ? -1 : 1;
  if (std::all_of(sign.begin(), sign.end(), [&](double s) { return s == sign.front(); })) return sign;
  if (solids.size() > kMaxNestedShells) return {};
  std::vector<Place> largest_first(solids.size());
  for (Place i = 0; i < solids.size(); ++i) largest_first[i] = i;
  std::stable_sort(largest_first.begin(), largest_first.end(), [&](Place a, Place b) {
    return std::abs(solids[a].moments.volume) > std::abs(solids[b].moments.volume);
  });
  Place angles = 0;
  std::vector<double> outermost(solids.size());
  for (Place n = 0; n < solids.size(); ++n) {
    const Place inner = largest_first[n];
    outermost[inner] = sign[inner];
    const auto [i, j, k] = mesh.shells[inner].triangles.front();
    const Vector3d point =
        (vertices[static_cast<Place>(i)] + vertices[static_cast<Place>(j)] + vertices[static_cast<Place>(k)]) / 3;
    for (Place m = 0; m < n; ++m) {
      const Place outer = largest_first[m];
      if (!solids[outer].box.contains(solids[inner].box)) continue;
      if ((angles += mesh.shells[outer].triangles.size()) > kMaxSolidAngles) return {};
      if (!winds_around(mesh.shells[outer], vertices, point)) continue;
      outermost[inner] = sign[outer];
      break;
    }
  }
  return outermost;
}

// Inertia and centroid about the centroid, moved by `origin`. Nothing without a volume or with an impossible inertia.
std::optional<VolumeIntegral> integral_of(Moments m, const Vector3d& origin) {
  if (!(m.volume > 0)) return std::nullopt;
  VolumeIntegral v;
  v.volume_m3 = m.volume;
  const Vector3d centroid = m.first / m.volume;
  m.second -= m.volume * centroid * centroid.transpose();
  v.inertia = m.second.trace() * Eigen::Matrix3d::Identity() - m.second;
  v.centroid_m = origin + centroid;
  // Masses are positive, so that the second moments are, too; then the inertia obeys the triangle inequality.
  if (!v.inertia.allFinite() || !m.second.ldlt().isPositive() || !(m.second.determinant() > 0)) return std::nullopt;
  return v;
}

VolumeIntegral integral_of_box(const Eigen::AlignedBox3d& box) {
  const Vector3d size = box.sizes().cwiseMax(kMinThickness_m), s = size.cwiseAbs2() * size.prod() / 12;
  VolumeIntegral v;
  v.volume_m3 = size.prod(), v.centroid_m = box.center();
  v.inertia.diagonal() << s.y() + s.z(), s.z() + s.x(), s.x() + s.y();
  return v;
}

constexpr const char* kBoxIsUsed = ": the volume of its bounding box is used";

}  // namespace

MeshSolid solid_of(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh, Eigen::Isometry3d::Identity());
  const auto as_box = [&](const std::string& reason) { return MeshSolid{integral_of_box(box), reason + kBoxIsUsed}; };
  const MeshShells shells = shells_of(mesh);
  // The origin of the file, unless it lies outside the mesh, where differences of large numbers would remain.
  const Vector3d origin = box.contains(Vector3d::Zero().eval()) ? Vector3d(Vector3d::Zero()) : Vector3d(box.center());
  std::vector<Vector3d> vertices = shells.vertices;
  for (Vector3d& v : vertices) v -= origin;
  std::vector<ShellSolid> solids;
  double area_m2 = 0, cap_area_m2 = 0;
  std::size_t open_edges = 0;
  for (const MeshShell& shell : shells.shells) {
    if (shell.one_sided) return as_box("has a one-sided surface, which has no inside");
    solids.push_back(solid_of_shell(shell, vertices));
    area_m2 += solids.back().area_m2, cap_area_m2 += solids.back().cap_area_m2, open_edges += solids.back().open_edges;
  }
  const bool open = cap_area_m2 > kSlitShare * area_m2;
  const std::string rims = "is open (" + std::to_string(open_edges) + (open_edges == 1 ? " edge has" : " edges have") +
                           " a triangle on one side only)";
  std::vector<double> factor = factors(shells, vertices, solids);
  std::string remark = open ? rims + ": its volume with its openings closed is used" : "";
  if (factor.empty()) {
    factor.assign(solids.size(), 1);
    remark = "has too many shells that face different sides: the sum of their signed volumes is used";
  }
  Moments sum;
  for (Place i = 0; i < solids.size(); ++i) sum.add(factor[i], solids[i].moments);
  if (sum.volume < 0) sum.add(-2, Moments(sum));
  if (sum.volume > 1.001 * box.volume() && sum.volume > kNoVolumeShare * area_m2 * box.diagonal().norm())
    return as_box("overlaps itself, so that it encloses more than its bounding box");
  if (open && sum.volume < kSheetShare * box.volume()) return as_box(rims + " and encloses nearly no volume");
  const auto integral = sum.volume > kNoVolumeShare * area_m2 * box.diagonal().norm() ? integral_of(sum, origin) : std::nullopt;
  if (!integral) return as_box(open ? rims + " and encloses no volume" : "encloses no volume");
  return {*integral, remark};
}

TurnedTriangles turn_outwards(TriangleMesh& mesh) {
  const MeshShells shells = shells_of(mesh);
  TurnedTriangles result;
  if (std::ranges::any_of(shells.shells, &MeshShell::one_sided)) return result;
  const Vector3d origin = bounds(mesh, Eigen::Isometry3d::Identity()).center();
  std::vector<Vector3d> vertices = shells.vertices;
  for (Vector3d& v : vertices) v -= origin;
  // Only closed shells have an outside.
  MeshShells closed;
  std::vector<ShellSolid> solids;
  std::vector<int> closed_number(shells.shells.size(), -1);
  for (Place i = 0; i < shells.shells.size(); ++i) {
    const ShellSolid solid = solid_of_shell(shells.shells[i], vertices);
    const double rounding = kNoVolumeShare * solid.area_m2 * solid.box.diagonal().norm();
    if (solid.cap_area_m2 > kSlitShare * solid.area_m2 || !(std::abs(solid.moments.volume) > rounding)) continue;
    closed_number[i] = static_cast<int>(solids.size());
    solids.push_back(solid), closed.shells.push_back(shells.shells[i]);
  }
  std::vector<double> factor = factors(closed, vertices, solids);
  if (factor.empty()) {
    double sum = 0;
    for (const ShellSolid& solid : solids) sum += solid.moments.volume;
    factor.assign(solids.size(), sum < 0 ? -1 : 1);
  }
  const Place count = mesh.indices.size() / 3;
  std::vector<char> repeats(count, 0), turn(count, 0), dropped(count, 0), in_closed(count, 0);
  for (const auto& [triangle, first] : shells.repeated) repeats[static_cast<Place>(first)] = 1;
  for (Place i = 0; i < shells.shells.size(); ++i) {
    const MeshShell& shell = shells.shells[i];
    const bool is_closed = closed_number[i] >= 0, inwards = is_closed && factor[static_cast<Place>(closed_number[i])] < 0;
    result.shells += inwards;
    const auto repeated = [&](int t) { return repeats[static_cast<Place>(t)] != 0; };
    if (!is_closed && std::ranges::any_of(shell.source, repeated)) continue;
    for (Place k = 0; k < shell.source.size(); ++k) {
      const auto t = static_cast<Place>(shell.source[k]);
      in_closed[t] = is_closed;
      turn[t] = (shell.turned[k] != 0) != inwards;
      result.turned += turn[t] != 0;
    }
  }
  for (const auto& [triangle, first] : shells.repeated)
    if (in_closed[static_cast<Place>(first)]) dropped[static_cast<Place>(triangle)] = 1, ++result.repeated;
  if (!result.any()) return result;
  // A normal belongs to a vertex: it turns if all triangles around it turn.
  std::vector<char> stays(mesh.vertices.size(), 0), turns(mesh.vertices.size(), 0);
  std::vector<int> indices;
  for (Place t = 0; t < count; ++t) {
    if (dropped[t]) continue;
    int corner[3] = {mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]};
    for (const int v : corner) (turn[t] ? turns : stays)[static_cast<Place>(v)] = 1;
    if (turn[t]) std::swap(corner[1], corner[2]);
    indices.insert(indices.end(), std::begin(corner), std::end(corner));
  }
  mesh.indices = std::move(indices);
  for (Place v = 0; v < mesh.normals.size(); ++v)
    if (turns[v] && !stays[v]) mesh.normals[v] = -mesh.normals[v];
  return result;
}

}  // namespace tactus::sim
