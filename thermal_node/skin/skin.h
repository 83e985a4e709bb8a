// Interface of a model of touched skin: its surface temperature and its heat loss.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace tactus::thermal {

// Properties of an object under the skin. A model uses those that it distinguishes: half-spaces only the
// effusivity.
struct ObjectProperties {
  double rest_degC = 23;
  double effusivity = 0;  // W s^0.5 m^-2 K^-1: sqrt(conductivity * heat capacity)
  double conductivity_W_mK = 0;
  double heat_capacity_J_m3K = 0;  // density times specific heat
  double thickness_m = std::numeric_limits<double>::infinity();
};

// Realtime-safe: yes, except the constructors of derived classes. Not thread-safe.
class Skin {
 public:
  // Second-order accuracy needs substeps well below the time constant of a contact, 0.1 s and more.
  static constexpr double kLongestSubstep_s = 0.005;

  virtual ~Skin() = default;

  // Returns skin and objects to rest.
  virtual void reset() = 0;
  // Number of objects that can touch the skin at the same time.
  static constexpr std::size_t kMaxObjects = 4;
  // Puts another object, uniformly at its own temperature, under the skin.
  virtual void set_object(const ObjectProperties& object, std::size_t index = 0) = 0;

  // Advances by dt seconds. conductance_W_m2K: to each object, W/(m^2 K), mean over dt and pad; objects beyond its
  // end are not touched. touched_share: share of dt and area in contact; the rest exchanges heat with the room.
  // Longer substeps are cheaper and less exact; they may change from step to step.
  virtual void step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
                    double longest_substep_s = kLongestSubstep_s) = 0;
  // The same with the first object only.
  void step(double dt_s, double conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) {
    step(dt_s, std::span<const double>(&conductance_W_m2K, 1), touched_share, longest_substep_s);
  }

  virtual double surface_degC() const = 0;
  // Mean over the last substep, out of the skin into all objects, W/m^2.
  virtual double heat_flux_W_m2() const = 0;
};

}  // namespace tactus::thermal
