// Faces, edges and vertices of a mesh, each one once, with what limits the directions to the nearest point of
// another surface. Pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim::features {

// A point nearest only to within a millionth of its distance deviates from the allowed directions by at most this,
// rad: for distances from kNear_m to 0.95 m, and faces with at least kMinHeight_m.
inline constexpr double kDirectionSlack_rad = 0.02;
// Nearer features are not filtered by direction, m. From (1 - cos 0.02) * 1e-5 m > kOn_m of gaps/mesh_pair.cpp.
inline constexpr double kNear_m = 1e-5;
// Smaller faces and shorter edges limit no direction, m.
inline constexpr double kMinHeight_m = 5e-5;

// Double cone of directions. A cosine of 0 allows all directions.
struct DirectionCone {
  Eigen::Vector3d axis{0, 0, 1};
  double cosine = 0, sine = 1;
  bool empty = false;  // no direction at all
};
// half_angle_rad: open when above 1.4.
DirectionCone direction_cone(const Eigen::Vector3d& axis, double half_angle_rad);

struct MeshFeatures {
  // Works on any soup: equal positions are one vertex. The triangles must outlive this object.
  explicit MeshFeatures(const std::vector<Triangle>& triangles);

  struct Edge {
    int triangle, side;       // the edge from v[side] to the next vertex of that triangle
    std::array<int, 2> ends;  // vertices
    Eigen::Vector3d along;    // unit
    double length_m;
    Eigen::Vector3d inward[2];  // within two of its faces, unit; 0: no face
    bool leaves(const Eigen::Vector3d& direction, double slack) const {
      return inward[0].dot(direction) <= slack && inward[1].dot(direction) <= slack;
    }
  };

  // Unit vectors along the edges at a vertex, and their lengths.
  struct Neighbour {
    Eigen::Vector3d along;
    double length_m;
  };
  std::span<const Neighbour> around(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return {neighbours.data() + first_neighbour[v], neighbours.data() + first_neighbour[v + 1]};
  }
  // Whether the vertex can be the nearest point in that direction (unit).
  bool leaves(int vertex, const Eigen::Vector3d& direction, double slack) const {
    for (const Neighbour& n : around(vertex))
      if (n.along.dot(direction) > slack) return false;
    return true;
  }
  // Whether no edge at the vertex comes nearer than `limit_m` to the place at `offset_m` from the vertex.
  bool nearest(int vertex, const Eigen::Vector3d& offset_m, double limit_m) const {
    for (const Neighbour& n : around(vertex)) {
      const double along = n.along.dot(offset_m);
      if (along <= 0) continue;
      if ((offset_m - std::min(along, n.length_m) * n.along).squaredNorm() < limit_m * limit_m) return false;
    }
    return true;
  }
  // Directions from a feature to the nearest point of another surface.
  DirectionCone cone_of_edge(int edge) const;
  DirectionCone cone_of_vertex(int vertex) const;

  // Of the triangles at a vertex, the one that faces least along or against the direction (unit).
  int triangle_across(int vertex, const Eigen::Vector3d& direction) const;

  const std::vector<Triangle>& triangles;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Edge> edges;
  std::vector<std::size_t> first_neighbour;  // per vertex, and one more
  std::vector<Neighbour> neighbours;
  std::vector<std::size_t> first_triangle;  // per vertex, and one more
  std::vector<int> triangles_at;
};

}  // namespace tactus::sim::features
