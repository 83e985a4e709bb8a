// Mode shapes: eigenfunctions in closed form, of the solids of modal.h. Pure.
#pragma once

#include <Eigen/Geometry>
#include <functional>

namespace tactus::audio {

// Gain of a mode for a unit force at a point, m, in a direction (unit), both in the frame of the solid. The mean
// square of the eigenfunction over the mass is 1, and its sign is kept: where it changes lies a nodal line, on
// which a blow does not excite the mode. The frame has its origin at the centre; x is along a bar, z along the
// axis of a cylinder or disc and through a plate. Points lie on or in the solid. Empty: the gain does not depend
// on point and direction.
using ModeShape = std::function<double(const Eigen::Vector3d& point, const Eigen::Vector3d& direction)>;

// Free-free beam function number n = 0, 1, ... of bending at x in 0 .. 1 of its length, and its slope (Fletcher
// and Rossing, The Physics of Musical Instruments, 2nd ed., section 2.9); mean square 1, 2 at x = 0.
struct BeamValue {
  double value, slope;
};
BeamValue free_beam(int n, double x);

// Bending of a bar of that length along x, in the direction `across` (1: y, 2: z). Sections rotate with the slope
// (Euler-Bernoulli, Kirchhoff), so an off-centre force along a bar or plate excites bending too.
ModeShape bar_bending_shape(int n, double length_m, int across);
// The same for a round bar along z: in the plane of the force.
ModeShape round_bending_shape(int n, double length_m);
// Stretching along `axis` and torsion about it, n = 1, 2, ...; gyration: of the section about that axis.
ModeShape stretching_shape(int n, double length_m, int axis);
ModeShape torsion_shape(int n, double length_m, int axis, double gyration_m);

// Bending of a plate a by b (along x and y). patch: directions in which a supported plate is only a patch of a
// larger one. All places are then equally likely, and the rms value applies.
struct Patch {
  bool x = false, y = false;
};
ModeShape supported_plate_shape(int i, int k, double a_m, double b_m, const Patch& patch);
ModeShape free_plate_shape(int i, int k, double a_m, double b_m);
// Mode of a thin disc, by nodal diameters and circles, of those that free_disc() lists. The force determines the
// orientation of its nodal diameters, so only the distance from the centre matters.
ModeShape free_disc_shape(int diameters, int circles, double radius_m, double poissons_ratio);

}  // namespace tactus::audio
