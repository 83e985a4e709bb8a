#include "audio_node/modal/body_sound.h"

#include <algorithm>
#include <numbers>
#include <tactus/material_def_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/vec3_t.hpp>

#include "audio_node/modal/solid.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Size of a body of unknown size.
constexpr double kUnknownSize_m = 0.05;  // design

Solid solid_of(const body_def_t& body, const shape_def_t* shape, const Elastic& m,
               const std::optional<Extent>& mesh, const Settings& s, ModeRange range) {
  const bool fixed = body.is_static != 0;
  const auto side = [&](double x) { return std::max(1e-3, fixed ? std::min(x, s.static_patch_m) : x); };
  const auto clipped_box = [&](double x, double y, double z) {
    Eigen::Vector3d edges{side(x), side(y), side(z)};
    Eigen::Index thinnest = 0;
    const double thickness = edges.minCoeff(&thinnest);
    if (fixed) edges[thinnest] = std::min(thickness, s.static_thickness_m);
    const auto part = [&](double whole) { return fixed && whole > s.static_patch_m; };
    return solid_box(m, edges, fixed, {part(x), part(y), part(z)}, range);
  };
  if (!shape) return solid_sphere(m, kUnknownSize_m, body.mass_kg, range);
  const vec3_t& size = shape->size_m;
  switch (shape->kind) {
    case shape_def_t::BOX: return clipped_box(size.x, size.y, size.z);
    case shape_def_t::SPHERE: return solid_sphere(m, std::max(1e-3, size.x), body.mass_kg, range);
    case shape_def_t::CYLINDER: return solid_cylinder(m, side(size.x), side(size.z), range);
    case shape_def_t::CAPSULE: return solid_cylinder(m, side(size.x), side(size.z + 4 / 3. * size.x), range);
    case shape_def_t::PLANE:
      return solid_box(m, {s.static_patch_m, s.static_patch_m, s.static_thickness_m}, true, {true, true, false},
                       range);
    default: break;
  }
  if (mesh) return clipped_box(mesh->x_m, mesh->y_m, mesh->z_m);
  return solid_sphere(m, kUnknownSize_m, body.mass_kg, range);
}

}  // namespace

Elastic elastic(const material_def_t& m) {
  Elastic e{m.youngs_modulus_Pa,  m.poissons_ratio,  m.density_kg_m3,
            m.rayleigh_alpha_1_s, m.rayleigh_beta_s, m.restitution};
  // Values that a scene omits are 0 in the message: the body is then wood.
  const Elastic wood;
  if (!(e.youngs_modulus_Pa > 0)) e.youngs_modulus_Pa = wood.youngs_modulus_Pa;
  if (!(e.density_kg_m3 > 0)) e.density_kg_m3 = wood.density_kg_m3;
  e.poissons_ratio = std::clamp(e.poissons_ratio, 0.0, 0.499);
  return e;
}

BodySound body_sound(const body_def_t& body, const shape_def_t* shape, const Elastic& material,
                     const std::optional<Extent>& mesh, const Settings& settings) {
  // More modes than are kept, since those below the lowest frequency are removed.
  const ModeRange range{settings.highest_frequency_Hz, 2 * settings.max_modes};
  const Solid solid = solid_of(body, shape, material, mesh, settings, range);
  BodySound sound;
  sound.material = material;
  sound.moves = body.is_static == 0;
  sound.mass_kg =
      sound.moves && body.mass_kg > 0 ? body.mass_kg : std::max(1e-6, solid.volume_m3 * material.density_kg_m3);
  sound.radius_m = solid.radius_m;
  const Eigen::Isometry3d shape_to_body = shape ? to_eigen(shape->pose) : Eigen::Isometry3d::Identity();
  sound.solid_to_body =
      shape_to_body * Eigen::Translation3d(shape && mesh ? mesh->centre_m : Eigen::Vector3d::Zero());
  sound.solid_to_body.linear() *= solid.axes;
  sound.half_extents_m = solid.half_extents_m;
  for (const SolidMode& m : solid.modes)
    if (m.frequency_Hz >= settings.lowest_frequency_Hz)
      sound.modes.push_back(
          {m.frequency_Hz, std::max(kMinDamping_1_s, damping_1_s(material, m.frequency_Hz)), m.gain, m.shape});
  // An overdamped mode does not sound.
  std::erase_if(sound.modes, [](const Mode& m) { return m.damping_1_s >= 2 * pi * m.frequency_Hz; });
  std::stable_sort(sound.modes.begin(), sound.modes.end(),
                   [](const Mode& a, const Mode& b) { return a.frequency_Hz < b.frequency_Hz; });
  if (sound.modes.size() > static_cast<std::size_t>(settings.max_modes))
    sound.modes.resize(static_cast<std::size_t>(settings.max_modes));
  return sound;
}

double gain_at(const BodySound& sound, const Mode& mode, const BodyPlace& place) {
  if (!mode.shape) return mode.gain;
  const Eigen::Vector3d point = sound.solid_to_body.inverse() * place.point_m;
  return mode.gain * mode.shape(point.cwiseMax(-sound.half_extents_m).cwiseMin(sound.half_extents_m),
                                sound.solid_to_body.linear().transpose() * place.direction);
}

}  // namespace tactus::audio
