#include "visual_node/scene_view/triangles.h"

#include <cmath>
#include <numbers>

namespace tactus::visual {
namespace {

using Eigen::Vector3f;

void add_quad(Triangles& t, const Vector3f& centre, const Vector3f& u, const Vector3f& v) {
  const auto base = static_cast<std::uint32_t>(t.positions.size());
  const Vector3f normal = u.cross(v).normalized();
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    t.positions.push_back(centre + static_cast<float>(a) * u + static_cast<float>(b) * v);
    t.normals.push_back(normal);
    t.texcoords.emplace_back((static_cast<float>(a) + 1) / 2, (static_cast<float>(b) + 1) / 2);
    const Vector3f along = u.normalized();
    t.tangents.emplace_back(along.x(), along.y(), along.z(), 1);
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) t.indices.push_back(base + i);
}

// A surface of revolution about z: rings from the top down, each with a height, a radius and the slope of its
// normal.
struct Ring {
  float z, radius;
  float normal_z, normal_radial;
  float v = 0;  // its v coordinate in the picture
};

void add_revolution(Triangles& t, const std::vector<Ring>& rings, int segments) {
  const auto base = static_cast<std::uint32_t>(t.positions.size());
  const auto columns = static_cast<std::uint32_t>(segments + 1);
  for (const Ring& r : rings)
    for (int s = 0; s <= segments; ++s) {
      const double angle = 2 * std::numbers::pi * (s % segments) / segments;
      const auto c = static_cast<float>(std::cos(angle)), d = static_cast<float>(std::sin(angle));
      t.positions.emplace_back(r.radius * c, r.radius * d, r.z);
      t.normals.emplace_back(r.normal_radial * c, r.normal_radial * d, r.normal_z);
      t.texcoords.emplace_back(static_cast<float>(s) / static_cast<float>(segments), r.v);
      t.tangents.emplace_back(-d, c, 0, 1);
    }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t s = 0; s + 1 < columns; ++s) {
      const std::uint32_t upper = base + r * columns + s, lower = upper + columns;
      if (rings[r].radius > 0)
        for (const std::uint32_t i : {upper, lower, upper + 1}) t.indices.push_back(i);
      if (rings[r + 1].radius > 0)
        for (const std::uint32_t i : {upper + 1, lower, lower + 1}) t.indices.push_back(i);
    }
}

// Rings of a half sphere: from the pole (first) to the equator.
void add_cap(std::vector<Ring>& rings, float radius, float centre_z, int segments, bool top) {
  const int count = segments / 4;
  for (int i = 0; i <= count; ++i) {
    const double polar = std::numbers::pi / 2 * (top ? i : count - i) / count;
    // The pole lies exactly on the axis, so that its degenerate triangles are left out.
    const float across = polar == 0 ? 0 : static_cast<float>(std::sin(polar));
    const float up = (top ? 1.0f : -1.0f) * static_cast<float>(std::cos(polar));
    rings.push_back({centre_z + radius * up, radius * across, up, across});
  }
}

}  // namespace

Triangles unit_box() {
  Triangles t;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-0.5f, 0.5f}) {
      const Vector3f u = 0.5f * Vector3f::Unit((axis + 1) % 3), v = 0.5f * Vector3f::Unit((axis + 2) % 3);
      const Vector3f centre = sign * Vector3f::Unit(axis);
      sign > 0 ? add_quad(t, centre, u, v) : add_quad(t, centre, v, u);
    }
  return t;
}

Triangles capsule(double radius_m, double length_m, int segments) {
  std::vector<Ring> rings;
  const auto radius = static_cast<float>(radius_m), half = static_cast<float>(length_m / 2);
  add_cap(rings, radius, half, segments, true);
  if (length_m == 0) rings.pop_back();  // a sphere has one equator
  add_cap(rings, radius, -half, segments, false);
  // The height of the picture follows the outline from pole to pole.
  for (std::size_t i = 1; i < rings.size(); ++i)
    rings[i].v = rings[i - 1].v + std::hypot(rings[i].z - rings[i - 1].z, rings[i].radius - rings[i - 1].radius);
  const float outline = rings.back().v;
  for (Ring& r : rings) r.v = 1 - r.v / outline;
  Triangles t;
  add_revolution(t, rings, segments);
  return t;
}

Triangles unit_sphere(int segments) { return capsule(1, 0, segments); }

Triangles unit_cylinder(int segments) {
  Triangles t;
  add_revolution(t, {{0.5f, 0, 1, 0, 1}, {0.5f, 1, 1, 0, 0}}, segments);
  add_revolution(t, {{0.5f, 1, 0, 1, 1}, {-0.5f, 1, 0, 1, 0}}, segments);
  add_revolution(t, {{-0.5f, 1, -1, 0, 1}, {-0.5f, 0, -1, 0, 0}}, segments);
  return t;
}

Triangles unit_plane() {
  Triangles t;
  add_quad(t, Vector3f::Zero(), 0.5f * Vector3f::UnitX(), 0.5f * Vector3f::UnitY());
  t.two_sided = true;
  return t;
}

Triangles from_mesh(const mesh_t& mesh) {
  Triangles t;
  t.two_sided = true;  // meshes from other programs are not always closed
  const auto at = [](const std::vector<float>& v, std::size_t i) { return Vector3f(v[i], v[i + 1], v[i + 2]); };
  for (std::size_t i = 0; i + 2 < mesh.positions_m.size(); i += 3) {
    t.positions.push_back(at(mesh.positions_m, i));
    t.normals.push_back(at(mesh.normals, i));
  }
  for (std::size_t i = 0; i + 1 < mesh.texcoords.size(); i += 2)
    t.texcoords.emplace_back(mesh.texcoords[i], mesh.texcoords[i + 1]);
  for (std::size_t i = 0; i + 3 < mesh.tangents.size(); i += 4)
    t.tangents.emplace_back(mesh.tangents[i], mesh.tangents[i + 1], mesh.tangents[i + 2], mesh.tangents[i + 3]);
  for (const std::int32_t i : mesh.indices) t.indices.push_back(static_cast<std::uint32_t>(i));
  return t;
}

}  // namespace tactus::visual
