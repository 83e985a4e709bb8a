#include "sim_node/scene/inertial.h"

#include <Eigen/Eigenvalues>
#include <optional>
#include <unordered_map>
#include <tactus/material_def_t.hpp>

#include "sim_node/scene/mass.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim {
namespace {

// SDF's defaults (inertial.sdf), for a body without shapes.
constexpr double kDefaultBodyMass_kg = 1, kDefaultInertia_kg_m2 = 1;
// SDF's default of <density> (1.11, inertial.sdf): that of water.
constexpr double kDefaultDensity_kg_m3 = 1000;
constexpr double kMaxDensity_kg_m3 = 25'000;  // that of a <tactus:material>, too

Eigen::Matrix3d read_inertia(const LoadContext& context, const sdf::Element& inertia) {
  const auto entry = [&](const char* name, double missing) { return sdf::child_number(&inertia, name, missing); };
  const double xy = entry("ixy", 0), xz = entry("ixz", 0), yz = entry("iyz", 0);
  const double xx = entry("ixx", 1), yy = entry("iyy", 1), zz = entry("izz", 1);
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Eigen::Vector3d moments = matrix.selfadjointView<Eigen::Lower>().eigenvalues();  // ascending
  if (!(moments[0] > 0))
    context.reject(inertia,
                   "is not positive definite: correct it, or leave it out so that it is computed from the shapes");
  // No mass distribution has such moments; the solver can still step. Tolerance 1 %, because files have few digits.
  if (moments[2] > 1.01 * (moments[0] + moments[1]))
    context.warn(inertia, "is not physically possible: one principal moment is larger than the sum of the two others");
  return matrix;
}

std::optional<double> density_of(const LoadContext& context, const sdf::Element* owner) {
  const sdf::Element* density = sdf::child_of(owner, "density");
  if (!density) return std::nullopt;
  const double value = sdf::number(*density);
  if (!(value > 0 && value <= kMaxDensity_kg_m3))
    context.reject(*density, "= " + std::string(density->text) + " must be above 0 and at most 25000 kg/m^3");
  return value;
}

// Of bodies that are joined rigidly (parallel axes, Steiner).
MassProperties sum_of(const MassProperties& a, const MassProperties& b) {
  MassProperties sum;
  sum.mass_kg = a.mass_kg + b.mass_kg;
  if (!(sum.mass_kg > 0)) return sum;
  sum.centre_of_mass_m = (a.mass_kg * a.centre_of_mass_m + b.mass_kg * b.centre_of_mass_m) / sum.mass_kg;
  for (const MassProperties* each : {&a, &b}) {
    const Eigen::Vector3d r = each->centre_of_mass_m - sum.centre_of_mass_m;
    sum.inertia_kg_m2 +=
        each->inertia_kg_m2 + each->mass_kg * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  return sum;
}

void warn_of_meshes(const LoadContext& context, const sdf::Element& link, const std::vector<MassRemark>& remarks,
                    const std::string& used_for) {
  for (const MassRemark& r : remarks)
    context.warn(link, "has mesh \"" + r.shape + "\", which " + r.clause + " for the " + used_for +
                           "; close the mesh, or give <mass> and <inertia>");
}

// By <density>. A shape has the name of its collision.
MassProperties by_density(const LoadContext& context, const sdf::Element& link, const sdf::Element& inertial,
                          std::span<const ShapeDef> shapes) {
  const auto general = density_of(context, &inertial);
  std::unordered_map<std::string_view, double> own;
  for (const sdf::Element& collision : link.children("collision"))
    if (const auto density = density_of(context, &collision)) own[collision.value("name")] = *density;
  MassProperties sum;
  std::vector<MassRemark> remarks;
  for (const ShapeDef& shape : shapes) {
    const auto of_collision = own.find(shape.name);
    std::optional<double> density = of_collision == own.end() ? general : of_collision->second;
    if (!density && shape.material >= 0)
      density = context.world.materials[static_cast<std::size_t>(shape.material)].density_kg_m3;
    ShapeDef plain = shape;
    plain.material = -1;  // 1 kg/m^3
    bool has_density = false;
    const MassProperties one = mass_of(context.world, std::span(&plain, 1), has_density, &remarks);
    sum = sum_of(sum, scaled_to(one, one.mass_kg * density.value_or(kDefaultDensity_kg_m3)));
  }
  warn_of_meshes(context, link, remarks, "mass and the inertia");
  return sum;
}

void check_mass(const LoadContext& context, const sdf::Element& mass, double given_kg) {
  if (!(given_kg > 0 && given_kg < 1e9))
    context.reject(mass, "= " + std::string(mass.text) +
                             " must be above 0 kg: give the mass, or make the model static");
}

// <inertial auto="true">; false: the shapes have no volume.
bool read_auto(const LoadContext& context, const sdf::Element& link, const sdf::Element& inertial,
               std::span<const ShapeDef> shapes, BodyDef& body) {
  MassProperties p = by_density(context, link, inertial, shapes);
  if (!(p.mass_kg > 0)) {
    context.warn(inertial, "is automatic, but the collisions of the link have no volume: the other values are used");
    return false;
  }
  if (const sdf::Element* mass = inertial.child("mass")) {
    const double given_kg = sdf::number(*mass);
    check_mass(context, *mass, given_kg);
    p = scaled_to(p, given_kg);
  }
  for (const char* ignored : {"pose", "inertia"})
    if (const sdf::Element* given = inertial.child(ignored))
      context.warn(*given, "has no effect: <inertial> has auto=\"true\"");
  body.mass_kg = p.mass_kg, body.centre_of_mass_m = p.centre_of_mass_m, body.inertia_kg_m2 = p.inertia_kg_m2;
  return true;
}

bool is_automatic(const sdf::Element* inertial) {
  return inertial && sdf::attribute_flag(*inertial, "auto");
}

void warn_of_densities(const LoadContext& context, const sdf::Element& link, const sdf::Element* inertial) {
  const auto warn = [&](const sdf::Element* owner) {
    if (const sdf::Element* density = sdf::child_of(owner, "density"))
      context.warn(*density, "has no effect: it counts for <inertial auto=\"true\">");
  };
  warn(inertial);
  for (const sdf::Element& collision : link.children("collision")) warn(&collision);
}

}  // namespace

void read_inertial(const LoadContext& context, const sdf::Element& link, std::span<const ShapeDef> shapes,
                   BodyDef& body) {
  const sdf::Element* inertial = link.child("inertial");
  if (!is_automatic(inertial)) warn_of_densities(context, link, inertial);
  if (body.is_static) {
    body.mass_kg = 0;
    return;
  }
  if (is_automatic(inertial) && read_auto(context, link, *inertial, shapes, body)) return;
  const sdf::Element* mass = sdf::child_of(inertial, "mass");
  const sdf::Element* inertia = sdf::child_of(inertial, "inertia");
  bool has_density = false;
  std::vector<MassRemark> remarks;
  MassProperties p = mass_of(context.world, shapes, has_density, &remarks);
  // The shapes have no effect on a body whose mass, inertia and centre of mass are given.
  if (!mass || !inertia)
    warn_of_meshes(context, link, remarks, mass ? "inertia" : inertia ? "mass" : "mass and the inertia");
  const bool has_volume = p.mass_kg > 0;
  if (!has_volume) p = {kDefaultBodyMass_kg, {0, 0, 0}, kDefaultInertia_kg_m2 * Eigen::Matrix3d::Identity()};
  if (mass) {
    const double given_kg = sdf::number(*mass);
    check_mass(context, *mass, given_kg);
    p = scaled_to(p, given_kg);
  } else if (!has_density || !has_volume) {
    p = scaled_to(p, kDefaultBodyMass_kg);
  }
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  const sdf::Element* pose = sdf::child_of(inertial, "pose");
  if (pose) {
    frame = sdf::raw_pose(*pose).to_eigen();
    if (!frame.matrix().allFinite()) context.reject(*pose, "is not finite");
    p.centre_of_mass_m = frame.translation();
  }
  if (inertia) {
    if (!pose) p.centre_of_mass_m.setZero();  // as SDF defines it
    p.inertia_kg_m2 = frame.linear() * read_inertia(context, *inertia) * frame.linear().transpose();
  }
  body.mass_kg = p.mass_kg, body.centre_of_mass_m = p.centre_of_mass_m, body.inertia_kg_m2 = p.inertia_kg_m2;
}

}  // namespace tactus::sim
