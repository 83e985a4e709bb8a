// Triangle meshes of all kinds of shapes, in the frame of the shape.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <tactus/mesh_t.hpp>
#include <vector>

namespace tactus::visual {

// Counter-clockwise seen from outside; one unit normal per vertex.
struct Triangles {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  // Texture coordinates of each vertex, u to the right and v up, and the unit tangent along growing u with the
  // sign of the binormal (mesh_t.lcm); empty: the mesh has no texture coordinates.
  std::vector<Eigen::Vector2f> texcoords;
  std::vector<Eigen::Vector4f> tangents;
  std::vector<std::uint32_t> indices;
  bool two_sided = false;  // also visible from the back
};

// A picture covers each side of a box, a whole ball or cylinder once, and a plane once.
//
// Unit shapes, to be scaled along their axes: edges of 1, radius 1, length 1, about the origin. This scaling keeps
// normals correct without an inverse transpose: flat faces are perpendicular to an axis, and x, y of round ones
// scale equally.
Triangles unit_box();
Triangles unit_sphere(int segments);
Triangles unit_cylinder(int segments);
// Normal +z.
Triangles unit_plane();

// length_m: between the centres of the caps. True size: a capsule cannot be scaled.
Triangles capsule(double radius_m, double length_m, int segments);
Triangles from_mesh(const mesh_t& mesh);

}  // namespace tactus::visual
