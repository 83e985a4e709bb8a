// How a mode moves its body: eigenfunctions in closed form, of the same solids as modal.h. Pure.
#pragma once

#include <Eigen/Geometry>
#include <functional>

namespace tactus::audio {

// How strongly a unit force at a point, m, in a direction (unit), both in the solid's own frame, drives a mode.
// The eigenfunction is normalised so that its mean square over the mass is 1, and its sign is kept: where it
// changes lies a nodal line, on which a blow leaves the mode silent. The solid's frame has its origin at the
// centre; x is along a bar, z along the axis of a cylinder or disc and through a plate. Points lie on or in the
// solid. Empty: the same wherever the force is, and whichever way it points.
using ModeShape = std::function<double(const Eigen::Vector3d& point, const Eigen::Vector3d& direction)>;

// Free-free beam function number n = 0, 1, ... of bending at x in 0 .. 1 of its length, and its slope (Fletcher
// and Rossing, The Physics of Musical Instruments, 2nd ed., section 2.9); mean square 1, 2 at x = 0.
struct BeamValue {
  double value, slope;
};
BeamValue free_beam(int n, double x);

// Sections turn with the slope (Euler-Bernoulli, Kirchhoff), so that a force along a bar or plate drives bending
// too where it is off the middle.
// Bending of a bar of that length along x, in the direction `across` (1: y, 2: z).
ModeShape bar_bending_shape(int n, double length_m, int across);
// The same of a round bar along z: in the plane of the force.
ModeShape round_bending_shape(int n, double length_m);
// Stretching along `axis` and torsion about it, n = 1, 2, ...; gyration: of the section about that axis.
ModeShape stretching_shape(int n, double length_m, int axis);
ModeShape torsion_shape(int n, double length_m, int axis, double gyration_m);

// Bending of a plate a by b (along x and y). A supported one that is only a patch of a larger plate (is_patch_x,
// is_patch_y) lies as likely under one place as under another: the root mean square then counts.
struct Patch {
  bool x = false, y = false;
};
ModeShape supported_plate_shape(int i, int k, double a_m, double b_m, const Patch& patch);
ModeShape free_plate_shape(int i, int k, double a_m, double b_m);
// Of a disc, by nodal diameters and circles; its nodal diameters lie where the force leaves them: only the
// distance from the centre counts. One of those that free_disc() lists, likewise for nu = 0.33.
ModeShape free_disc_shape(int diameters, int circles, double radius_m);

}  // namespace tactus::audio
