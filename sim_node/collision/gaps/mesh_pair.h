// Contacts of meshes with what has no triangles, and which of the point pairs of a mesh are contacts at all. Pure.
#pragma once

#include <vector>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/collision/layers/obb_tree.h"
#include "sim_node/model/point_pair.h"
#include "sim_node/collision/triangle_tree.h"

namespace tactus::sim::gaps {

// All append pairs with a gap of at most the reach, with their triangles. a: the convex body or the plane, b: the
// mesh, any polygon soup. Realtime-safe once the list has grown; for any number of threads.
void convex_mesh(const Convex& convex, const Eigen::Isometry3d& pose, const TriangleTree& mesh,
                 const Eigen::Isometry3d& mesh_pose, double reach_m, std::vector<PointPair>& out);
void plane_mesh(const Eigen::Isometry3d& plane_pose, const TriangleTree& mesh, const Eigen::Isometry3d& mesh_pose,
                double reach_m, std::vector<PointPair>& out);

// Whether no place of the mesh around `on_mesh`, which lies on it, is nearer to `from` than that share of its
// distance; both in its frame. A pair for which one is, is none of a contact: it leads from a surface to the next
// triangle of a plain that it already stands on, and would hold back whatever slides over that.
double least_around(double distance_m, double share);  // what is nearer than that, is nearer
bool nearest_around(const TriangleTree& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& on_mesh,
                    double share = 1);

// A pair that leads straight out of a triangle's face is one of something over it.
bool leads_out(const Eigen::Vector3d& face_normal, const Eigen::Vector3d& pair_normal);
// The share for a pair of which one end, or neither, is over a face: what lies over a face is a contact unless it leads
// away from what is much nearer; what lies between edges, when nothing around is nearer at all.
inline double share_of(bool over_a, bool over_b) {
  constexpr double kMuchNearer = 0.9;  // something tilted by 26 degrees, as far as a step may turn it; design
  return over_a || over_b ? kMuchNearer : 1;
}

// One side of a pair: a mesh, its pose in the world, and the triangle of the pair in its frame.
struct MeshSide {
  const TriangleTree& mesh;
  const Eigen::Isometry3d& pose;
  const Triangle& triangle;
};
// Whether a pair of triangles that are apart, world, is one of a contact.
bool is_contact(const MeshSide& a, const MeshSide& b, const PointPair& p);

Triangle moved(const Triangle& t, const Eigen::Isometry3d& pose);  // without the directions of its edges
// Gives a pair of triangles that go through each other, in the world, the shorter of the two ways out over their
// faces.
void part(const Triangle& a, const Triangle& b, PointPair& pair);

}  // namespace tactus::sim::gaps
