#include "sim_node/model/mesh_shells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "sim_node/model/triangles.h"

namespace tactus::sim {
namespace {

using Place = std::size_t;
using Triangle = std::array<int, 3>;

// Vertices nearer than this share of the diagonal are one: files in text have about six digits, and single precision seven.
// Far from the origin of its file, single precision moves vertices further, by up to the larger share. Design.
constexpr double kWeldShare = 1e-6, kMaxWeldShare = 1e-3;

// Sets of equal elements (union-find).
class Groups {
 public:
  explicit Groups(Place count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Place{0}); }
  Place of(Place i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Place a, Place b) { parent_[of(a)] = of(b); }

 private:
  std::vector<Place> parent_;
};

// Merges vertices nearer than a tolerance, by cells of a grid: large enough that most vertices lie in one cell with all their
// neighbours, small enough that a cell holds at most some hundred vertices, however many a mesh has in a small place.
class VertexWelder {
 public:
  explicit VertexWelder(const TriangleMesh& mesh) : box_(bounds(mesh, Eigen::Isometry3d::Identity())) {
    const double rounding_m = 4 * double(std::numeric_limits<float>::epsilon()) *
                              std::max(box_.min().cwiseAbs().maxCoeff(), box_.max().cwiseAbs().maxCoeff());
    const double diagonal_m = box_.diagonal().norm();
    tolerance_m_ = std::max(kWeldShare * diagonal_m, std::min(rounding_m, kMaxWeldShare * diagonal_m));
    cell_m_ = 4 * tolerance_m_;
  }

  // Index of the vertex at this place.
  int add(const Eigen::Vector3d& p) {
    const Cell low = cell(p.array() - tolerance_m_), high = cell(p.array() + tolerance_m_);
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          if (const auto found = first_.find(key({x, y, z})); found != first_.end())
            for (int i = found->second; i >= 0; i = next_[static_cast<Place>(i)])
              if ((vertices[static_cast<Place>(i)] - p).norm() <= tolerance_m_) return i;
    const int index = static_cast<int>(vertices.size());
    vertices.push_back(p);
    const auto [at, is_new] = first_.try_emplace(key(cell(p.array())), index);
    next_.push_back(is_new ? -1 : std::exchange(at->second, index));
    return index;
  }

  std::vector<Eigen::Vector3d> vertices;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const Eigen::Array3d& p) const {
    const Eigen::Array3d c = ((p - box_.min().array()) / cell_m_).floor();
    return {static_cast<std::int64_t>(c.x()), static_cast<std::int64_t>(c.y()), static_cast<std::int64_t>(c.z())};
  }
  // A cell index is below 2^18, by kWeldShare; the distance separates vertices of cells with the same key.
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>((c[0] & 0x1fffff) | (c[1] & 0x1fffff) << 21 | (c[2] & 0x1fffff) << 42);
  }

  Eigen::AlignedBox3d box_;
  double tolerance_m_ = 0, cell_m_ = 0;
  std::unordered_map<std::uint64_t, int> first_;  // of each cell
  std::vector<int> next_;                         // in the same cell; -1: none
};

// source: the number of each triangle in the mesh.
std::vector<Triangle> welded_triangles(const TriangleMesh& mesh, std::vector<Eigen::Vector3d>& vertices, std::vector<int>& source) {
  VertexWelder welder(mesh);
  std::vector<int> index;
  index.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) index.push_back(welder.add(v));
  vertices = std::move(welder.vertices);
  std::vector<Triangle> triangles;
  for (Place i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto at = [&](Place k) { return index[static_cast<Place>(mesh.indices[i + k])]; };
    if (at(0) == at(1) || at(1) == at(2) || at(2) == at(0)) continue;
    triangles.push_back({at(0), at(1), at(2)});
    source.push_back(static_cast<int>(i / 3));
  }
  return triangles;
}

// Keeps the first of triangles with the same corners: files with two-sided faces name each twice.
std::vector<std::array<int, 2>> drop_repeated(std::vector<Triangle>& triangles, std::vector<int>& source) {
  std::vector<std::pair<Triangle, Place>> sorted;
  for (Place t = 0; t < triangles.size(); ++t) {
    sorted.emplace_back(triangles[t], t);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> keep(triangles.size(), 1);
  std::vector<std::array<int, 2>> repeated;
  for (Place i = 1, first = 0; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[first].first) {
      first = i;
      continue;
    }
    keep[sorted[i].second] = 0;
    repeated.push_back({source[sorted[i].second], source[sorted[first].second]});
  }
  Place kept = 0;
  for (Place t = 0; t < triangles.size(); ++t)
    if (keep[t]) source[kept] = source[t], triangles[kept++] = triangles[t];
  triangles.resize(kept), source.resize(kept);
  return repeated;
}

// One side of a triangle: an edge between two vertices, low < high.
struct Side {
  int low = 0, high = 0;
  Place triangle = 0;
  bool forward = true;  // the triangle runs from low to high
};

bool same_edge(const Side& a, const Side& b) { return a.low == b.low && a.high == b.high; }

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (Place t = 0; t < triangles.size(); ++t)
    for (Place k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

// Calls each(first, last) for the sides of each edge.
template <class Each>
void for_each_edge(const std::vector<Side>& sides, Each&& each) {
  for (Place first = 0, last = 0; first < sides.size(); first = last) {
    last = first + 1;
    while (last < sides.size() && same_edge(sides[first], sides[last])) ++last;
    each(first, last);
  }
}

// Triangles that are connected by edges of exactly two triangles, and which of them to turn so that all face one side.
struct Patches {
  std::vector<int> of;      // patch of each triangle
  std::vector<char> turned;  // of each triangle
  std::vector<char> one_sided;  // of each patch
  int count = 0;

  bool runs_forward(const Side& side) const { return side.forward != static_cast<bool>(turned[side.triangle]); }
};

struct Neighbour {
  Place triangle = 0;
  bool same_side = true;
};
using Neighbours = std::vector<std::array<Neighbour, 3>>;

Neighbours neighbours_of(const std::vector<Side>& sides, Place triangles, std::vector<int>& counts) {
  Neighbours neighbours(triangles);
  counts.assign(triangles, 0);
  for_each_edge(sides, [&](Place first, Place last) {
    if (last - first != 2) return;
    const Side &a = sides[first], &b = sides[first + 1];
    const bool same = a.forward != b.forward;
    neighbours[a.triangle][static_cast<Place>(counts[a.triangle]++)] = {b.triangle, same};
    neighbours[b.triangle][static_cast<Place>(counts[b.triangle]++)] = {a.triangle, same};
  });
  return neighbours;
}

Patches find_patches(const std::vector<Triangle>& triangles, const std::vector<Side>& sides,
                     const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<int> counts;
  const Neighbours neighbours = neighbours_of(sides, triangles.size(), counts);
  Patches patches{std::vector<int>(triangles.size(), -1), std::vector<char>(triangles.size(), 0), {}, 0};
  const auto area = [&](Place t) {
    const auto at = [&](Place k) -> const Eigen::Vector3d& { return vertices[static_cast<Place>(triangles[t][k])]; };
    return (at(1) - at(0)).cross(at(2) - at(0)).norm();
  };
  std::vector<Place> members;
  for (Place seed = 0; seed < triangles.size(); ++seed) {
    if (patches.of[seed] >= 0) continue;
    members.assign(1, seed);
    patches.of[seed] = patches.count;
    patches.one_sided.push_back(0);
    double turned_area = 0, kept_area = 0;
    for (Place i = 0; i < members.size(); ++i) {
      const Place t = members[i];
      (patches.turned[t] ? turned_area : kept_area) += area(t);
      for (Place k = 0; k < static_cast<Place>(counts[t]); ++k) {
        const Neighbour& n = neighbours[t][k];
        const char turn = n.same_side ? patches.turned[t] : !patches.turned[t];
        if (patches.of[n.triangle] < 0) {
          patches.of[n.triangle] = patches.count, patches.turned[n.triangle] = turn;
          members.push_back(n.triangle);
        } else if (patches.turned[n.triangle] != turn) {
          patches.one_sided.back() = 1;
        }
      }
    }
    if (turned_area > kept_area)
      for (const Place t : members) patches.turned[t] = !patches.turned[t];
    ++patches.count;
  }
  return patches;
}

// For each key of `turns`: the sum of its +1 and -1. Sorts `turns`, so that an edge of many triangles is fast.
template <class Each>
void for_each_sum(std::vector<std::pair<int, int>>& turns, Each&& each) {
  std::sort(turns.begin(), turns.end());
  for (Place first = 0, last = 0; first < turns.size(); first = last) {
    int net = 0;
    for (last = first; last < turns.size() && turns[last].first == turns[first].first; ++last) net += turns[last].second;
    each(turns[first].first, net);
  }
}

// Joins patches that do not close each other's edges alone: an edge of three or more triangles closes only with all of them.
Groups join_open_patches(const std::vector<Side>& sides, const Patches& patches) {
  Groups groups(static_cast<Place>(patches.count));
  std::vector<std::pair<int, int>> turns;  // patch of each side, and +1 or -1 for its direction
  for_each_edge(sides, [&](Place first, Place last) {
    if (last - first < 3) return;
    turns.clear();
    for (Place i = first; i < last; ++i)
      turns.emplace_back(patches.of[sides[i].triangle], patches.runs_forward(sides[i]) ? 1 : -1);
    int open = -1;
    for_each_sum(turns, [&](int patch, int net) {
      if (net == 0) return;
      if (open >= 0) groups.join(static_cast<Place>(open), static_cast<Place>(patch));
      open = patch;
    });
  });
  return groups;
}

}  // namespace

MeshShells shells_of(const TriangleMesh& mesh) {
  MeshShells result;
  std::vector<int> source;
  std::vector<Triangle> triangles = welded_triangles(mesh, result.vertices, source);
  result.repeated = drop_repeated(triangles, source);
  const std::vector<Side> sides = sorted_sides(triangles);
  const Patches patches = find_patches(triangles, sides, result.vertices);
  Groups groups = join_open_patches(sides, patches);
  std::vector<int> shell_of_group(static_cast<Place>(patches.count), -1);
  const auto shell_of = [&](Place triangle) {
    int& shell = shell_of_group[groups.of(static_cast<Place>(patches.of[triangle]))];
    if (shell < 0) shell = static_cast<int>(result.shells.size()), result.shells.emplace_back();
    return shell;
  };
  for (Place t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    MeshShell& shell = result.shells[static_cast<Place>(shell_of(t))];
    shell.triangles.push_back(patches.turned[t] ? Triangle{a, c, b} : Triangle{a, b, c});
    shell.source.push_back(source[t]), shell.turned.push_back(patches.turned[t]);
    shell.one_sided = shell.one_sided || patches.one_sided[static_cast<Place>(patches.of[t])];
    result.turned_triangles += patches.turned[t];
  }
  std::vector<std::pair<int, int>> turns;
  for_each_edge(sides, [&](Place first, Place last) {
    turns.clear();
    for (Place i = first; i < last; ++i)
      turns.emplace_back(shell_of(sides[i].triangle), patches.runs_forward(sides[i]) ? 1 : -1);
    for_each_sum(turns, [&](int shell, int net) {
      for (int n = 0; n < std::abs(net); ++n)
        result.shells[static_cast<Place>(shell)].rim.push_back(net > 0 ? RimEdge{sides[first].low, sides[first].high}
                                                                       : RimEdge{sides[first].high, sides[first].low});
    });
  });
  return result;
}

}  // namespace tactus::sim
