#include "sim_node/model/fingerprint.h"

#include <tactus/material_def_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "sim_node/model/state_archive.h"
#include "sync/bus/identity.h"

namespace tactus::sim {
namespace {

// Write-only archive that accepts values instead of references.
struct Words {
  StateArchive a;
  template <class... T>
  void operator()(T... values) {
    (a(values), ...);
  }
  void pose(const Eigen::Isometry3d& p) { (*this)(Eigen::Vector3d(p.translation()), Eigen::Matrix3d(p.linear())); }
};

void add(Words& w, const BodyDef& b) {
  w(b.name, b.is_static, b.mass_kg, b.centre_of_mass_m, b.inertia_kg_m2, b.velocity_m_s, b.gravity,
    b.linear_damping_1_s, b.angular_damping_1_s, b.tool);
  w.pose(b.pose);
}

void add(Words& w, const ShapeDef& s) {
  w(s.body, static_cast<int>(s.kind), s.size_m, s.mesh, s.material, s.friction, s.restitution);
  w.pose(s.pose);
}

void add(Words& w, const JointDef& j) {
  w(j.name, static_cast<int>(j.kind), j.parent, j.child, j.anchor_m);
  for (const JointAxis& a : j.axes)
    w(a.axis, a.lower, a.upper, a.damping, a.friction, a.stiffness, a.reference, a.effort, a.motor_velocity,
      a.motor_effort);
}

void add(Words& w, const TriangleMesh& m) {
  for (const Eigen::Vector3d& v : m.vertices) w(v);
  for (const int i : m.indices) w(i);
}

}  // namespace

std::uint64_t fingerprint(const WorldDef& world, const Settings& settings) {
  Words w;
  w(world.gravity_m_s2, static_cast<int>(world.bodies.size()), static_cast<int>(world.shapes.size()));
  for (const BodyDef& b : world.bodies) add(w, b);
  for (const ShapeDef& s : world.shapes) add(w, s);
  for (const JointDef& j : world.joints) add(w, j);
  for (const TriangleMesh& m : world.meshes) add(w, m);
  for (const Heightfield& h : world.heightfields) {
    w(h.columns, h.rows, h.size_m, h.centre_m);
    for (const double height : h.heights_m) w(height);
  }
  for (const material_def_t& m : world.materials)
    w(m.name, double{m.friction_static}, double{m.friction_dynamic}, double{m.youngs_modulus_Pa},
      double{m.poissons_ratio});
  for (const material_def_t& m : world.materials)
    if (m.friction_asset != 0)
      w(m.name, std::int64_t{m.friction_asset}, double{m.friction_size_u_m}, double{m.friction_size_v_m}, double{m.friction_black},
        double{m.friction_white});
  for (const tool_def_t& t : world.tools) w(t.name, t.radius_m, t.mass_kg, int{t.material});
  for (const auto& [a, b] : world.no_collision) w(a, b);
  for (const auto& field : setting_fields())
    std::visit([&](auto member) { w(std::string(field.row.name), settings.*member); }, field.field);
  const StateArchive::Bytes& bytes = w.a.bytes();
  return sync::fnv1a_64(sync::kFnv1aBegin, bytes.data(), bytes.size());
}

}  // namespace tactus::sim
