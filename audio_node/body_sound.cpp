#include "audio_node/body_sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Slower decay than any metal object: keeps a material without damping from ringing for ever.
constexpr double kLeastDamping_1_s = 0.5;  // T60 = 13.8 s, design
// A ball lighter than so much of a solid one is taken for a shell.
constexpr double kHollowBelow = 0.6;  // design
// Bodies at least so many times longer than wide are bars; of the others those so many times wider than thick,
// plates.
constexpr double kSlender = 3;  // thin-bar and thin-plate theory err by 10 % there (Graff 1975, section 3.4)
// A body whose size nobody knows.
constexpr double kUnknownSize_m = 0.05;  // design
// Mean square of an eigenfunction that is normalised to the mass is 1; modes of bodies that are moved mostly along
// the surface (torsion, stretching) move the air less.
constexpr double kInPlaneGain = 0.3;  // design

struct Modes {
  std::vector<double> bending, in_plane;
};

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// A bar or block: bending in both directions, stretching and torsion. Sizes descend.
Modes bar(const Elastic& m, double length, double width, double height, Range range) {
  Modes modes;
  append(modes.bending, thick_bar_bending(m, length, width / std::sqrt(12), range));
  append(modes.bending, thick_bar_bending(m, length, height / std::sqrt(12), range));
  append(modes.in_plane, free_bar_harmonics(bar_speed_m_s(m), length, range));
  append(modes.in_plane, free_bar_harmonics(shear_speed_m_s(m), length, range));
  return modes;
}

struct Solid {
  Modes modes;
  double volume_m3;
  double radius_m;
};

Solid box(const Elastic& m, std::array<double, 3> size, bool fixed, Range range) {
  std::sort(size.rbegin(), size.rend());
  const auto [a, b, h] = size;
  const Solid solid{{}, a * b * h, std::cbrt(a * b * h * 3 / (4 * pi))};
  if (a >= kSlender * b || b < kSlender * h) return {bar(m, a, b, h, range), solid.volume_m3, solid.radius_m};
  // A plate radiates from its face, not from its volume.
  return {{fixed ? supported_plate(m, a, b, h, range) : free_plate(m, a, b, h, range), {}},
          solid.volume_m3,
          std::sqrt(a * b / pi) / 2};
}

Solid cylinder(const Elastic& m, double radius, double length, Range range) {
  const double volume = pi * radius * radius * length;
  if (2 * radius >= kSlender * length) return {{free_disc(m, radius, length, range), {}}, volume, radius / 2};
  Modes modes;
  modes.bending = thick_bar_bending(m, length, radius / 2, range);
  modes.in_plane = free_bar_harmonics(bar_speed_m_s(m), length, range);
  append(modes.in_plane, free_bar_harmonics(shear_speed_m_s(m), length, range));
  return {modes, volume, std::cbrt(volume * 3 / (4 * pi))};
}

Solid ball(const Elastic& m, double radius, double mass_kg, Range range) {
  const double volume = 4 * pi / 3 * radius * radius * radius;
  const bool hollow = mass_kg > 0 && mass_kg < kHollowBelow * volume * m.density_kg_m3;
  return {{hollow ? spherical_shell(m, radius, range) : solid_ball(m, radius, range), {}}, volume, radius};
}

Solid solid_of(const body_def_t& body, const shape_def_t* shape, const Elastic& m,
               const std::optional<Extent>& mesh, const Settings& s, Range range) {
  const bool fixed = body.is_static != 0;
  const auto side = [&](double x) { return std::max(1e-3, fixed ? std::min(x, s.static_patch_m) : x); };
  const auto clipped_box = [&](double x, double y, double z) {
    std::array<double, 3> size{side(x), side(y), side(z)};
    if (fixed)
      *std::min_element(size.begin(), size.end()) =
          std::min(*std::min_element(size.begin(), size.end()), s.static_thickness_m);
    return box(m, size, fixed, range);
  };
  if (!shape) return ball(m, kUnknownSize_m, body.mass_kg, range);
  const vec3_t& size = shape->size_m;
  switch (shape->kind) {
    case shape_def_t::BOX: return clipped_box(size.x, size.y, size.z);
    case shape_def_t::SPHERE: return ball(m, std::max(1e-3, size.x), body.mass_kg, range);
    case shape_def_t::CYLINDER: return cylinder(m, side(size.x), side(size.z), range);
    case shape_def_t::CAPSULE: return cylinder(m, side(size.x), side(size.z + 4 / 3. * size.x), range);
    case shape_def_t::PLANE:
      return box(m, {s.static_patch_m, s.static_patch_m, s.static_thickness_m}, true, range);
    default: break;
  }
  if (mesh) return clipped_box(mesh->x_m, mesh->y_m, mesh->z_m);
  return ball(m, kUnknownSize_m, body.mass_kg, range);
}

}  // namespace

Elastic elastic(const material_def_t& m) {
  Elastic e{m.youngs_modulus_Pa,  m.poissons_ratio,  m.density_kg_m3,
            m.rayleigh_alpha_1_s, m.rayleigh_beta_s, m.restitution};
  // What a scene leaves out is 0 on the wire: wood then.
  const Elastic wood;
  if (!(e.youngs_modulus_Pa > 0)) e.youngs_modulus_Pa = wood.youngs_modulus_Pa;
  if (!(e.density_kg_m3 > 0)) e.density_kg_m3 = wood.density_kg_m3;
  e.poissons_ratio = std::clamp(e.poissons_ratio, 0.0, 0.499);
  return e;
}

BodySound body_sound(const body_def_t& body, const shape_def_t* shape, const Elastic& material,
                     const std::optional<Extent>& mesh, const Settings& settings) {
  // More than are kept, since those below the lowest frequency are left out.
  const Range range{settings.highest_frequency_Hz, 2 * settings.max_modes};
  const Solid solid = solid_of(body, shape, material, mesh, settings, range);
  BodySound sound;
  sound.material = material;
  sound.moves = body.is_static == 0;
  sound.mass_kg =
      sound.moves && body.mass_kg > 0 ? body.mass_kg : std::max(1e-6, solid.volume_m3 * material.density_kg_m3);
  sound.radius_m = solid.radius_m;
  const auto add = [&](const std::vector<double>& frequencies, double gain) {
    for (const double f : frequencies)
      if (f >= settings.lowest_frequency_Hz)
        sound.modes.push_back({f, std::max(kLeastDamping_1_s, damping_1_s(material, f)), gain});
  };
  add(solid.modes.bending, 1);
  add(solid.modes.in_plane, kInPlaneGain);
  // An overdamped mode does not sound.
  std::erase_if(sound.modes, [](const Mode& m) { return m.damping_1_s >= 2 * pi * m.frequency_Hz; });
  std::sort(sound.modes.begin(), sound.modes.end(),
            [](const Mode& a, const Mode& b) { return a.frequency_Hz < b.frequency_Hz; });
  if (sound.modes.size() > static_cast<std::size_t>(settings.max_modes))
    sound.modes.resize(static_cast<std::size_t>(settings.max_modes));
  return sound;
}

}  // namespace tactus::audio
