// Contacts of meshes with convex shapes and planes, and the test that rejects point pairs of a mesh that are no
// contacts. Pure.
#pragma once

#include <vector>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/collision/layers/obb_tree.h"
#include "sim_node/model/point_pair.h"
#include "sim_node/collision/triangle_tree.h"

namespace tactus::sim::gaps {

// All functions append pairs with a gap of at most reach_m, with their triangles. a: the convex shape or the plane,
// b: the mesh, any polygon soup. Real-time safe once the list has grown. Thread-safe.
void convex_mesh(const Convex& convex, const Eigen::Isometry3d& pose, const TriangleTree& mesh,
                 const Eigen::Isometry3d& mesh_pose, double reach_m, std::vector<PointPair>& out);
void plane_mesh(const Eigen::Isometry3d& plane_pose, const TriangleTree& mesh, const Eigen::Isometry3d& mesh_pose,
                double reach_m, std::vector<PointPair>& out);

// Returns whether no point of the mesh around `on_mesh`, which lies on the mesh, is nearer to `from` than `share` of
// the distance. Both points are in the frame of the mesh. A pair that fails is not a contact (an internal edge
// collision): it leads from a resting surface to a neighbouring triangle and would stop sliding bodies.
double nearer_limit_m(double distance_m, double share);  // upper limit of the distance of a nearer point
bool nearest_around(const TriangleTree& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& on_mesh,
                    double share = 1);

// Whether a pair leaves a triangle's face along its normal, that is, lies over the face.
bool leaves_face(const Eigen::Vector3d& face_normal, const Eigen::Vector3d& pair_normal);
// Share for nearest_around(), by whether one end of the pair lies over a face. A pair over a face is a contact unless
// a point nearby is much nearer. A pair between edges is a contact only when no point nearby is nearer.
inline double nearer_share(bool over_a, bool over_b) {
  constexpr double kMuchNearer = 0.9;  // a tilt of 26 degrees, the most that a step may rotate; design value
  return over_a || over_b ? kMuchNearer : 1;
}

// One side of a pair: a mesh, its pose in the world, and the triangle of the pair in the mesh frame.
struct MeshSide {
  const TriangleTree& mesh;
  const Eigen::Isometry3d& pose;
  const Triangle& triangle;
};
// Whether a pair of separated triangles, world frame, is a contact.
bool is_contact(const MeshSide& a, const MeshSide& b, const PointPair& p);

// Distance up to which the sides of two bodies are one plane, m.
inline constexpr double kFlush_m = 1e-6;
// Whether two triangles, each in the frame of its mesh, have the same normal.
bool are_flush(const Triangle& a, const Eigen::Isometry3d& pose_a, const Triangle& b, const Eigen::Isometry3d& pose_b);

Triangle moved(const Triangle& t, const Eigen::Isometry3d& pose);  // leaves the edge directions unchanged
// Sets normal and gap of a pair of intersecting triangles, world frame, to the shortest translation that separates them:
// along a face normal, or across two edges.
void resolve_piercing(const Triangle& a, const Triangle& b, PointPair& pair);

// Gap above which orient() changes nothing, m.
inline constexpr double kMaxOriented_m = 2e-3;
// The same where no edge passes through a face, m.
inline constexpr double kMaxOrientedUnpierced_m = 5e-5;
// Corrects a pair of two triangles, world frame, whose normals point out of their bodies. A vertex slightly behind a face
// that faces it is an overlap, whose normal points the other way (pierced: an edge of the bodies passes through a face,
// so that deeper ones are overlaps too). Where surfaces touch, returns false for a pair whose normal does not separate
// the two triangles: a corner that lies in the plane of a neighbouring face, or two edges of which only other faces meet.
bool orient(const Triangle& a, const Triangle& b, bool pierced, PointPair& pair);

}  // namespace tactus::sim::gaps
