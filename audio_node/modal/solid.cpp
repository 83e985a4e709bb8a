#include "audio_node/modal/solid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

// A ball below this share of the mass of a solid one counts as a shell.
constexpr double kHollowBelow = 0.6;  // design
// Aspect ratio: longer bodies are bars; of the others, those that are wider than thick by it are plates.
// With shear and rotary inertia bars err by up to 10 % there, plates by 20 % (modal.h).
constexpr double kSlender = 3;
// Modes that move mostly along the surface (torsion, stretching) radiate less.
constexpr double kInPlaneGain = 0.3;  // design

using ShapeOf = std::function<ModeShape(const NaturalFrequency&)>;

void append(std::vector<SolidMode>& to, const std::vector<NaturalFrequency>& modes, double gain, const ShapeOf& shape) {
  for (const NaturalFrequency& m : modes) to.push_back({m.frequency_Hz, gain, shape(m)});
}

// A bar or block: bending in both directions, stretching and torsion. Sizes in descending order.
std::vector<SolidMode> bar(const Elastic& m, double length, double width, double height, ModeRange range) {
  std::vector<SolidMode> modes;
  const auto bending = [&](double thickness, int across) {
    append(modes, thick_bar_bending(m, length, thickness / std::sqrt(12), range), 1,
           [=](const NaturalFrequency& n) { return bar_bending_shape(n.i, length, across); });
  };
  bending(width, 1);
  bending(height, 2);
  append(modes, free_bar_harmonics(bar_speed_m_s(m), length, range), kInPlaneGain,
         [=](const NaturalFrequency& n) { return stretching_shape(n.i, length, 0); });
  const double gyration = std::hypot(width, height) / std::sqrt(12);
  append(modes, free_bar_harmonics(shear_speed_m_s(m), length, range), kInPlaneGain,
         [=](const NaturalFrequency& n) { return torsion_shape(n.i, length, 0, gyration); });
  return modes;
}

}  // namespace

Solid solid_box(const Elastic& m, const Eigen::Vector3d& edges, bool fixed, const std::array<bool, 3>& patch,
                ModeRange range) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int k) { return edges[i] > edges[k]; });
  const double a = edges[order[0]], b = edges[order[1]], h = edges[order[2]];
  Solid solid;
  solid.volume_m3 = a * b * h;
  for (int i = 0; i < 3; ++i) solid.axes.col(i) = Eigen::Vector3d::Unit(order[static_cast<std::size_t>(i)]);
  solid.half_extents_m = Eigen::Vector3d(a, b, h) / 2;
  if (a >= kSlender * b || b < kSlender * h) {
    solid.modes = bar(m, a, b, h, range);
    solid.radius_m = std::cbrt(solid.volume_m3 * 3 / (4 * pi));
    return solid;
  }
  // A plate radiates from its face, not from its volume.
  solid.radius_m = std::sqrt(a * b / pi) / 2;
  const auto is_patch = [&](std::size_t i) { return patch[static_cast<std::size_t>(order[i])]; };
  const Patch part{is_patch(0), is_patch(1)};
  append(solid.modes, fixed ? supported_plate(m, a, b, h, range) : free_plate(m, a, b, h, range), 1,
         [&](const NaturalFrequency& n) {
           return fixed ? supported_plate_shape(n.i, n.k, a, b, part) : free_plate_shape(n.i, n.k, a, b);
         });
  return solid;
}

Solid solid_cylinder(const Elastic& m, double radius, double length, ModeRange range) {
  Solid solid;
  solid.volume_m3 = pi * radius * radius * length;
  solid.half_extents_m = {radius, radius, length / 2};
  if (2 * radius >= kSlender * length) {
    solid.radius_m = radius / 2;
    const std::vector<NaturalFrequency> modes = free_disc(m, radius, length, range);
    append(solid.modes, modes, 1, [&](const NaturalFrequency& n) { return free_disc_shape(n.i, n.k, radius, m.poissons_ratio); });
    return solid;
  }
  solid.radius_m = std::cbrt(solid.volume_m3 * 3 / (4 * pi));
  append(solid.modes, thick_bar_bending(m, length, radius / 2, range), 1,
         [&](const NaturalFrequency& n) { return round_bending_shape(n.i, length); });
  append(solid.modes, free_bar_harmonics(bar_speed_m_s(m), length, range), kInPlaneGain,
         [&](const NaturalFrequency& n) { return stretching_shape(n.i, length, 2); });
  append(solid.modes, free_bar_harmonics(shear_speed_m_s(m), length, range), kInPlaneGain,
         [&](const NaturalFrequency& n) { return torsion_shape(n.i, length, 2, radius / std::numbers::sqrt2); });
  return solid;
}

// The modes of a ball have their poles at the struck place.
Solid solid_sphere(const Elastic& m, double radius, double mass_kg, ModeRange range) {
  Solid solid;
  solid.volume_m3 = 4 * pi / 3 * radius * radius * radius;
  solid.radius_m = radius;
  solid.half_extents_m.setConstant(radius);
  const bool hollow = mass_kg > 0 && mass_kg < kHollowBelow * solid.volume_m3 * m.density_kg_m3;
  append(solid.modes, hollow ? spherical_shell(m, radius, range) : solid_ball(m, radius, range), 1,
         [](const NaturalFrequency&) { return ModeShape{}; });
  return solid;
}

}  // namespace tactus::audio
