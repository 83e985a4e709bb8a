// Heat conduction in a column of skin and in several columns of objects that touch it, each on one axis into its
// depth: the equations of both skin models.
//
//   capacity du/dt = flow from the neighbours + blood (T_blood - u)
//
// Columns are divided into cells. All columns meet at one surface without heat capacity: the flow through the
// first half cell of skin continues through a conductance into each object and into the room. Time integration:
// the two-stage, second-order, L-stable implicit Runge-Kutta method of Alexander (1977), stable for every step
// size, without ringing after a touch. Each stage eliminates every column from its far end up to the surface and
// substitutes back, at a fixed number of operations per cell. The outflow of one cell is the inflow of another, so
// heat is conserved to rounding.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::thermal {

struct HeatCell {
  double capacity = 0;  // J/(m^2 K)
  double half = 0;      // W/(m^2 K) from its centre to either border
  double blood = 0;     // W/(m^2 K) between it and the blood
};

// Realtime-safe: yes, except the constructor. Not thread-safe.
class HeatColumns {
 public:
  // skin: surface first, insulated at the deep end. object_count: number of objects that can touch it at the same
  // time, each of at most max_cells cells.
  HeatColumns(std::vector<HeatCell> skin, std::size_t object_count, std::size_t max_cells);

  // Temperatures of the surroundings. Any temperature scale is valid if it is the same everywhere.
  void set_blood(double degC) { blood_degC_ = degC; }
  void set_room(double degC) { room_degC_ = degC; }
  // Sets the whole skin to one temperature.
  void set_skin(double degC);
  // Sets the skin to its untouched steady state between blood and room; at least one cell must have blood. Removes
  // all objects.
  void settle_skin(double room_W_m2K);

  // Sets an object, surface first, at one temperature; its back loses heat to the room. At most max_cells cells;
  // none: it takes no heat.
  void set_object(std::size_t index, std::span<const HeatCell> cells, double back_W_m2K, double degC);

  // Advances by dt in substeps of at most longest_substep_s. contact_W_m2K: conductance to each object, W/(m^2 K);
  // objects beyond its end are not touched. room_W_m2K: conductance to the room.
  void step(double dt_s, std::span<const double> contact_W_m2K, double room_W_m2K, double longest_substep_s);

  double surface() const { return surface_; }
  // From the surface into all objects, W/m^2, mean over the last substep.
  double flux_W_m2() const { return flux_; }
  std::size_t skin_cells() const { return columns_[0].cells.size(); }
  double skin(std::size_t cell) const { return columns_[0].u[cell]; }

  // Heat flows of the last step, J/m^2, each by the quadrature of the step itself.
  struct Flows {
    double skin_to_objects = 0, blood_to_skin = 0, skin_to_room = 0, objects_to_room = 0;
  };
  const Flows& flows() const { return flows_; }
  // J/m^2, relative to the zero of the temperature scale.
  double skin_energy() const { return energy(columns_[0]); }
  double objects_energy() const;

 private:
  struct Column {
    std::vector<HeatCell> cells;  // the cells in use
    std::vector<double> link;     // W/(m^2 K) from each to the next
    std::vector<double> u, stage, right;
    // The factored equations: inverse pivot; share of a right side that passes to the next cell.
    std::vector<double> inverse, share;
    double back = 0;     // W/(m^2 K) from the last cell to the room
    double contact = 0;  // W/(m^2 K) from the centre of the first cell to the surface
  };

  static void join(Column& column);
  static double energy(const Column& column);
  void factor(double capacity_share, double weight_s);
  void solve(bool from_stage);
  double surface_of(bool of_stage) const;
  void add_flows(double weight_s, bool of_stage);
  double objects_flux(bool of_stage) const;

  std::vector<Column> columns_;                                 // skin first
  double room_ = 0;                                             // W/(m^2 K)
  double capacity_share_ = 1, weight_s_ = 0, surface_out_ = 0;  // of the factored equations
  double blood_degC_ = 0, room_degC_ = 0;
  double surface_ = 0, flux_ = 0;
  Flows flows_;
};

// Widths of cells that grow by `growth` from `first` and fill `thickness` exactly: at least four, at most
// widths.size(). Returns their number; 0 when they do not fit.
std::size_t growing_widths(double thickness, double first, double growth, std::span<double> widths);

}  // namespace tactus::thermal
