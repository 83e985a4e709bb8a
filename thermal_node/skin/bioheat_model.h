// Temperature of layered, perfused skin and of objects of finite thickness under it.
//
// Pennes' bioheat equation (Pennes 1948), on one axis into the depth:
//   rho c T_t = (k T_x)_x + w rho_b c_b (T_a - T)
// in epidermis, dermis, fat and muscle or bone, whose deepest end is insulated; plain conduction in the object,
// whose back loses heat to the room. Metabolic heat is omitted: it has no significant effect on a touch (Ho and
// Jones 2008). The blood of a hand at rest is cooler than the core. Its temperature T_a is the one that balances
// the loss of the untouched surface to the room, so that skin at rest stays at rest exactly. Cells grow with depth
// and end at each layer.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "thermal_node/skin/heat_columns.h"
#include "thermal_node/skin/skin.h"
#include "thermal_node/skin/tissue.h"

namespace tactus::thermal {

// Resolution. Widths in units of the square root of diffusivity, s^0.5, as in skin_model.h.
struct Mesh {
  double first_cell = 0.02;  // resolves (0.02)^2 s = 0.4 ms
  double growth = 1.12;
};

class BioheatModel final : public Skin {
 public:
  // tissue.layers: at least one, of positive thickness, conductivity and heat capacity.
  explicit BioheatModel(const Tissue& tissue, const Mesh& mesh = {});

  using Skin::step;
  void reset() override;
  // An object without conductivity or heat capacity, or with values beyond any material, takes no heat. A
  // thickness that is not positive counts as infinite.
  void set_object(const ObjectProperties& object, std::size_t index = 0) override;
  void step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) override;
  double surface_degC() const override { return columns_.surface(); }
  double heat_flux_W_m2() const override { return columns_.flux_W_m2(); }

  double blood_degC() const { return blood_degC_; }
  // For the heat balance and the profile of the skin.
  const HeatColumns& columns() const { return columns_; }

 private:
  static std::vector<HeatCell> skin_cells(const Tissue& tissue, const Mesh& mesh);

  Tissue tissue_;
  Mesh mesh_;
  std::array<ObjectProperties, kMaxObjects> objects_{};
  HeatColumns columns_;
  std::vector<double> object_width_m_;  // scratch for set_object
  std::vector<HeatCell> object_cells_;
  double blood_degC_ = 0;
};

}  // namespace tactus::thermal
