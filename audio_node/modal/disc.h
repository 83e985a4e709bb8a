// Bending of a free circular plate: its radial functions, and the roots of the conditions at its edge. Pure.
#pragma once

namespace tactus::audio {

// Radial functions J_n(y) and I_n(y) of a mode with n nodal diameters, y = lambda r / R (Leissa, Vibration of Plates, NASA SP-160,
// 1969, eq. 1.18). modified: I_n.
class DiscFunctions {
 public:
  DiscFunctions(int diameters, double poissons_ratio) : n_(diameters), nu_(poissons_ratio) {}
  double value(double y, bool modified) const;
  double slope(double y, bool modified) const;
  // Bending moment and Kelvin-Kirchhoff shear force at an edge at y, each up to a factor that both functions share. Both
  // vanish at a free edge (Leissa, chapter 1).
  double moment(double y, bool modified) const;
  double shear(double y, bool modified) const;
  // Share of I_n for which an edge at y has no bending moment.
  double modified_share(double y) const { return -moment(y, false) / moment(y, true); }

 private:
  int n_;
  double nu_;
};

// lambda of a mode of a free disc with that Poisson's ratio, 0 .. 0.5. Throws std::logic_error for a mode that free_disc() does not
// list.
double free_disc_lambda(int diameters, int circles, double poissons_ratio);

}  // namespace tactus::audio
