// What a model of touched skin answers, whichever it is: the temperature of its surface and the heat that it
// loses.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace tactus::thermal {

// What lies under the skin. A model takes from it what it can tell apart: half-spaces only the effusivity.
struct ObjectProperties {
  double rest_degC = 23;
  double effusivity = 0;  // W s^0.5 m^-2 K^-1: sqrt(conductivity * heat capacity)
  double conductivity_W_mK = 0;
  double heat_capacity_J_m3K = 0;  // density times specific heat
  double thickness_m = std::numeric_limits<double>::infinity();
};

// Realtime-safe: yes, all but the constructors of what derives from it. Not thread-safe.
class Skin {
 public:
  // Second-order accuracy needs substeps well below the time constant of a contact, 0.1 s and more.
  static constexpr double kLongestSubstep_s = 0.005;

  virtual ~Skin() = default;

  // Everything back to rest.
  virtual void reset() = 0;
  // So many things can touch the skin at once.
  static constexpr std::size_t kThings = 4;
  // Puts another object, uniformly at its own temperature, under the skin.
  virtual void set_object(const ObjectProperties& object, std::size_t thing = 0) = 0;

  // Advances by dt seconds, during which the skin exchanges heat with each thing through a conductance (W/(m^2 K),
  // mean over dt and pad; those beyond the end are not touched) and, for the share of dt and area that it touches
  // none, with the room. Longer substeps are cheaper and less exact; they may change from step to step.
  virtual void step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
                    double longest_substep_s = kLongestSubstep_s) = 0;
  // With the first of them alone.
  void step(double dt_s, double conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) {
    step(dt_s, std::span<const double>(&conductance_W_m2K, 1), touched_share, longest_substep_s);
  }

  virtual double surface_degC() const = 0;
  // Mean over the last substep, out of the skin into all that touches it, W/m^2.
  virtual double heat_flux_W_m2() const = 0;
};

}  // namespace tactus::thermal
