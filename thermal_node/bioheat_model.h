// The temperature of layered, living skin and of the object of finite thickness under it.
//
// Pennes' bioheat equation (Pennes 1948), on one axis into the depth:
//   rho c T_t = (k T_x)_x + w rho_b c_b (T_a - T)
// in epidermis, dermis, fat and muscle or bone, whose deepest end is insulated; plain conduction in the object,
// whose back loses heat to the room. Heat of metabolism is left out: it has no significant effect on a touch (Ho
// and Jones 2008). The blood of a hand at rest is cooler than the core; its temperature T_a is the one that keeps
// the untouched surface at rest against the loss to the room, so that skin at rest stays at rest exactly.
//
// Finite volumes, whose widths grow with depth and end at each layer; in time the two-stage, second-order,
// L-stable implicit Runge-Kutta method of Alexander (1977): stable for every step. What leaves one cell enters
// another, so heat is conserved to rounding.
#pragma once

#include <cstddef>
#include <vector>

#include "thermal_node/skin.h"
#include "thermal_node/tissue.h"

namespace tactus::thermal {

// How fine. Widths in units of the square root of diffusivity, s^0.5, as in skin_model.h.
struct Mesh {
  double first_cell = 0.02;  // resolves (0.02)^2 s = 0.4 ms
  double growth = 1.12;
};

class BioheatModel final : public Skin {
 public:
  // tissue.layers: at least one, of positive thickness, conductivity and heat capacity.
  explicit BioheatModel(const Tissue& tissue, const Mesh& mesh = {});

  void reset() override;
  // An object without conductivity or heat capacity, or of more than any material has, takes no heat. A thickness that is not positive counts as
  // infinite.
  void set_object(const ObjectProperties& object) override;
  void step(double dt_s, double conductance_W_m2K, double touched_share,
            double longest_substep_s = kLongestSubstep_s) override;
  double surface_degC() const override { return surface_degC_; }
  double heat_flux_W_m2() const override { return flux_; }

  double blood_degC() const { return blood_degC_; }
  // Of the tissue, linear between the middles of cells.
  double at_depth_degC(double depth_m) const;

  // Where the heat of the last step went, J/m^2, each by the same quadrature as the step itself.
  struct Flows {
    double skin_to_object = 0, blood_to_skin = 0, skin_to_room = 0, object_to_room = 0;
  };
  const Flows& flows() const { return flows_; }
  // Relative to 0 degC, J/m^2.
  double skin_energy_J_m2() const { return energy(0, skin_cells_); }
  double object_energy_J_m2() const { return energy(skin_cells_, cells()); }

 private:
  using Cells = std::vector<double>;
  // What flows at the surface, which holds no heat itself: see surface().
  struct Surface {
    double skin = 0, contact = 0, room = 0, sum = 1;  // W/(m^2 K) from the surface to each, and all together
  };

  std::size_t cells() const { return skin_cells_ + object_cells_; }
  void build_skin();
  void link(std::size_t from, std::size_t to);
  void rest();
  Surface surface(double conductance_W_m2K, double touched_share) const;
  void join(const Surface& s);
  void solve_stage(double weight_s, Cells& u);
  void substep(double dt_s, const Surface& s);
  void account(double weight_s, const Surface& s, const Cells& u);
  double surface_of(const Surface& s, const Cells& u) const;
  double contact_flux(const Surface& s, const Cells& u) const;
  double energy(std::size_t from, std::size_t to) const;

  Tissue tissue_;
  Mesh mesh_;
  ObjectProperties object_;
  double room_degC_;
  double blood_degC_ = 0;

  // Cells: of skin, deepest first, then of the object, surface first. Sized for the most that an object can need.
  std::size_t skin_cells_ = 0, object_cells_ = 0, most_object_cells_ = 0;
  Cells width_m_, conductivity_, capacity_;  // m, W/(m K), J/(m^2 K)
  Cells blood_;                              // W/(m^2 K) between a cell and the blood
  Cells link_;                               // W/(m^2 K) between cell i and i + 1 of the same side
  Cells lower_, centre_, upper_, source_;    // capacity du/dt = lower u[i-1] + centre u[i] + upper u[i+1] + source
  double back_ = 0;                          // W/(m^2 K) between the last cell and the room
  Cells u_, stage_, matrix_lower_, matrix_centre_, matrix_upper_, scratch_;

  double surface_degC_ = 0;
  double flux_ = 0;
  Flows flows_;
};

}  // namespace tactus::thermal
