// The temperature of a patch of skin and of the object under it, while contacts come and go.
//
// Heat conduction in two half-spaces, each on one axis into its depth, joined at the surface by a conductance that
// may change from step to step. Depth is measured in units of the square root of diffusivity (s^0.5), in which
// every material obeys u_t = u_xixi and enters only by its effusivity e (flux = e u_xi), so one grid serves skin,
// copper and foam. Skin temperatures are relative to the skin at rest, where the warmth of the core, of the blood
// and the loss to the room balance; by superposition the deviation obeys the same equation with a loss to the
// blood (Pennes 1948).
//
// Finite volumes on a grid that grows with depth; in time the two-stage, second-order, L-stable implicit
// Runge-Kutta method of Alexander (1977): stable for every step and conductance, and without ringing after a
// touch.
#pragma once

#include <array>
#include <cstddef>

#include "thermal_node/skin.h"

namespace tactus::thermal {

struct SkinProperties {
  double rest_degC = 33;
  double effusivity = 1181;       // W s^0.5 m^-2 K^-1
  double perfusion_1_s = 0.0025;  // blood flow per volume of tissue; of tissue and blood rho c is nearly equal
  double air_conductance_W_m2K = 8;
};

// Realtime-safe: yes (no allocation). Not thread-safe.
class SkinModel final : public Skin {
 public:
  explicit SkinModel(const SkinProperties& skin) : skin_(skin) {}

  void reset() override;
  void set_object(const ObjectProperties& object) override;
  void step(double dt_s, double conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) override;
  double surface_degC() const override { return skin_.rest_degC + surface_K_; }
  double heat_flux_W_m2() const override { return flux_; }

 private:
  // Cells: kSide of skin, deepest first, then kSide of object, surface first.
  static constexpr std::size_t kSide = 56;
  static constexpr std::size_t kCells = 2 * kSide;
  using Cells = std::array<double, kCells>;
  // du/dt of a cell = lower * the one before + centre * itself + upper * the one after.
  struct Equations {
    Cells lower{}, centre{}, upper{};
  };
  // What flows through the surface, in terms of the two cells beside it.
  struct Surface {
    double to_object, to_room, from_object;  // W/(m^2 K): see surface()
    double weight_skin, weight_object;       // surface temperature = their weighted sum
  };

  Surface surface(double conductance_W_m2K, double touched_share) const;
  Equations equations(const Surface& s) const;
  // Solves (1 - factor * equations) x = right.
  static Cells solve(const Equations& equations, double factor, Cells right);
  void substep(double dt_s, const Equations& equations, const Surface& surface);

  SkinProperties skin_;
  ObjectProperties object_;
  Cells u_{};  // K above the skin at rest
  double surface_K_ = 0;
  double flux_ = 0;
};

}  // namespace tactus::thermal
