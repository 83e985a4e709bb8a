// Temperature of a patch of skin and of the objects under it during intermittent contacts: half-spaces.
//
// Heat conduction in half-spaces, each on one axis into its depth, joined at the surface by conductances that may
// change from step to step. Depth is measured in units of the square root of diffusivity (s^0.5), in which every
// material obeys u_t = u_xixi and enters only by its effusivity e (flux = e u_xi), so one grid serves skin, copper
// and foam. Temperatures are relative to the skin at rest, where the warmth of the core, of the blood and the loss
// to the room balance; by superposition the deviation obeys the same equation with a loss to the blood (Pennes
// 1948).
#pragma once

#include <array>

#include "thermal_node/skin/heat_columns.h"
#include "thermal_node/skin/skin.h"

namespace tactus::thermal {

struct SkinProperties {
  double rest_degC = 33;
  double effusivity = 1181;       // W s^0.5 m^-2 K^-1
  double perfusion_1_s = 0.0025;  // blood flow per volume of tissue; rho c of tissue and blood is nearly equal
  double air_conductance_W_m2K = 8;
};

class SkinModel final : public Skin {
 public:
  explicit SkinModel(const SkinProperties& skin);

  using Skin::step;
  void reset() override;
  void set_object(const ObjectProperties& object, std::size_t index = 0) override;
  void step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) override;
  double surface_degC() const override { return skin_.rest_degC + columns_.surface(); }
  double heat_flux_W_m2() const override { return columns_.flux_W_m2(); }

 private:
  SkinProperties skin_;
  std::array<ObjectProperties, kMaxObjects> objects_{};
  HeatColumns columns_;  // K above the skin at rest
};

}  // namespace tactus::thermal
