// Heat in a column of skin and in several columns of other things that touch it, all on one axis into their depth:
// the equations that both models of skin solve.
//
//   capacity du/dt = what comes from the neighbours + blood (T_blood - u)
//
// Columns are cut into cells. All meet at one surface, which holds no heat itself: what comes to it through the
// first half cell of skin goes on through a conductance into each thing and to the room. In time the two-stage,
// second-order, L-stable implicit Runge-Kutta method of Alexander (1977): stable for every step, without ringing
// after a touch. Each stage is solved by eliminating every column from its far end up to the surface and going
// back down, which costs a fixed number of operations a cell. What leaves one cell enters another, so heat is
// conserved to rounding.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::thermal {

struct HeatCell {
  double capacity = 0;  // J/(m^2 K)
  double half = 0;      // W/(m^2 K) from its middle to either border
  double blood = 0;     // W/(m^2 K) between it and the blood
};

// Realtime-safe: yes, all but the constructor. Not thread-safe.
class HeatColumns {
 public:
  // skin: surface first, its deep end insulated. things: how many can touch it at once, each of at most so many
  // cells.
  HeatColumns(std::vector<HeatCell> skin, std::size_t things, std::size_t most_cells);

  // Temperatures of the surroundings. Any unit of temperature does, as long as it is the same in all.
  void set_blood(double degC) { blood_degC_ = degC; }
  void set_room(double degC) { room_degC_ = degC; }
  // All of the skin at one temperature.
  void set_skin(double degC);
  // The skin as nothing but blood and room make it, when it is untouched for ever; some cell must have blood. What
  // touched it is taken away.
  void settle_skin(double room_W_m2K);

  // Another thing, surface first, at one temperature; its back loses to the room. At most the cells of the
  // constructor, or none: it takes no heat.
  void set_thing(std::size_t thing, std::span<const HeatCell> cells, double back_W_m2K, double degC);

  // Advances by dt in at most this long substeps, the skin touching each thing through its conductance (W/(m^2 K),
  // as many as there are things, fewer: the rest are not touched) and the room through another.
  void step(double dt_s, std::span<const double> contact_W_m2K, double room_W_m2K, double longest_substep_s);

  double surface() const { return surface_; }
  // From the surface into all things, W/m^2, mean over the last substep.
  double flux_W_m2() const { return flux_; }
  std::size_t skin_cells() const { return columns_[0].cells.size(); }
  double skin(std::size_t cell) const { return columns_[0].u[cell]; }

  // Where the heat of the last step went, J/m^2, each by the same quadrature as the step itself.
  struct Flows {
    double skin_to_things = 0, blood_to_skin = 0, skin_to_room = 0, things_to_room = 0;
  };
  const Flows& flows() const { return flows_; }
  // J/m^2, of temperatures as they are counted.
  double skin_energy() const { return energy(columns_[0]); }
  double things_energy() const;

 private:
  struct Column {
    std::vector<HeatCell> cells;  // as many as are used
    std::vector<double> link;     // W/(m^2 K) from each to the next
    std::vector<double> u, stage, right;
    std::vector<double> inverse,
        share;           // of the factored equations: of the pivot; of a cell's right side for the next
    double back = 0;     // W/(m^2 K) from the last cell to the room
    double contact = 0;  // W/(m^2 K) from the first cell's middle to the surface
  };

  static void join(Column& column);
  static double energy(const Column& column);
  void factor(double capacity_share, double weight_s);
  void solve(bool from_stage);
  double surface_of(bool of_stage) const;
  void account(double weight_s, bool of_stage);
  double things_flux(bool of_stage) const;

  std::vector<Column> columns_;                                 // skin first
  double room_ = 0;                                             // W/(m^2 K)
  double capacity_share_ = 1, weight_s_ = 0, surface_out_ = 0;  // of the factored equations
  double blood_degC_ = 0, room_degC_ = 0;
  double surface_ = 0, flux_ = 0;
  Flows flows_;
};

// Widths of cells that grow by `growth` from `first` and fill `thickness` exactly: at least four, at most the
// span's. How many; 0 when they do not fit.
std::size_t growing_widths(double thickness, double first, double growth, std::span<double> widths);

}  // namespace tactus::thermal
