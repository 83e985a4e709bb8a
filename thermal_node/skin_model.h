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

namespace tactus::thermal {

struct SkinProperties {
  double rest_degC = 33;
  double effusivity = 1181;       // W s^0.5 m^-2 K^-1
  double perfusion_1_s = 0.0025;  // blood flow per volume of tissue; of tissue and blood rho c is nearly equal
  double air_conductance_W_m2K = 8;
};

struct ObjectProperties {
  double rest_degC = 23;
  double effusivity = 0;
};

// Realtime-safe: yes (no allocation). Not thread-safe.
class SkinModel {
 public:
  // Second-order accuracy needs substeps well below the time constant of a contact, 0.1 s and more.
  static constexpr double kLongestSubstep_s = 0.005;

  explicit SkinModel(const SkinProperties& skin) : skin_(skin) {}

  // Everything back to rest.
  void reset();
  // Puts another object, uniformly at its own temperature, under the skin.
  void set_object(const ObjectProperties& object);

  // Advances by dt seconds, during which the skin exchanges heat with the object through `conductance` (W/(m^2 K),
  // the mean over dt) and, for the share of dt and area that it does not touch, with the room. Longer substeps are
  // cheaper and less exact; they may change from step to step.
  void step(double dt_s, double conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s);

  double surface_degC() const { return skin_.rest_degC + surface_K_; }
  // Mean over the last substep, out of the skin into the object, W/m^2.
  double heat_flux_W_m2() const { return flux_; }

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
  static Cells solve(const Equations& equations, double factor, const Cells& right);
  void substep(double dt_s, const Equations& equations, const Surface& surface);

  SkinProperties skin_;
  ObjectProperties object_;
  Cells u_{};  // K above the skin at rest
  double surface_K_ = 0;
  double flux_ = 0;
};

}  // namespace tactus::thermal
