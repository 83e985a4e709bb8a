#include "thermal_node/skin/heat_columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::thermal {
namespace {

constexpr double kMaxSubsteps = 2000;
// Alexander 1977, two stages: gamma = 1 - 1/sqrt(2).
constexpr double kGamma = 0.29289321881345254;
// Minimum number of cells of a layer or object.
constexpr std::size_t kMinCells = 4;

double in_series(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

}  // namespace

HeatColumns::HeatColumns(std::vector<HeatCell> skin, std::size_t object_count, std::size_t max_cells)
    : columns_(1 + object_count) {
  columns_[0].cells = std::move(skin);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Column& c = columns_[k];
    const std::size_t cell_count = k == 0 ? c.cells.size() : max_cells;
    c.cells.reserve(cell_count);
    for (auto* values : {&c.link, &c.u, &c.stage, &c.right, &c.inverse, &c.share}) values->resize(cell_count);
  }
  join(columns_[0]);
}

void HeatColumns::join(Column& c) {
  for (std::size_t i = 0; i + 1 < c.cells.size(); ++i) c.link[i] = in_series(c.cells[i].half, c.cells[i + 1].half);
}

void HeatColumns::set_skin(double degC) {
  std::fill(columns_[0].u.begin(), columns_[0].u.end(), degC);
  surface_ = degC;
  flux_ = 0;
  flows_ = {};
}

void HeatColumns::set_object(std::size_t index, std::span<const HeatCell> cells, double back_W_m2K, double degC) {
  Column& c = columns_[1 + index];
  c.cells.assign(cells.begin(), cells.end());
  c.back = back_W_m2K;
  join(c);
  std::fill_n(c.u.begin(), cells.size(), degC);
}

// Factors the equations of all columns, (capacity_share * capacity + weight * conduction) x = capacity_share *
// capacity * old + weight * sources, each eliminated from its far end up to the surface. They hold for all stages
// of a step.
void HeatColumns::factor(double capacity_share, double weight_s) {
  capacity_share_ = capacity_share;
  weight_s_ = weight_s;
  surface_out_ = room_;
  for (Column& c : columns_) {
    const std::size_t n = c.cells.size();
    double passed_on = 0;  // by the cell below
    for (std::size_t i = n; i-- > 0;) {
      const double above = i == 0 ? c.contact : c.link[i - 1], below = i + 1 == n ? c.back : c.link[i];
      const double pivot =
          capacity_share * c.cells[i].capacity + weight_s * (c.cells[i].blood + above + below) - passed_on;
      c.inverse[i] = 1 / pivot;
      c.share[i] = weight_s * above * c.inverse[i];
      passed_on = c.share[i] * weight_s * above;
    }
    if (n > 0) surface_out_ += c.contact * (1 - c.share[0]);
  }
}

// Solves from u into stage, or with from_stage from stage into u.
void HeatColumns::solve(bool from_stage) {
  double into = room_ * room_degC_;
  for (Column& c : columns_) {
    const std::size_t n = c.cells.size();
    const std::vector<double>& old = from_stage ? c.stage : c.u;
    double passed_on = n > 0 ? weight_s_ * c.back * room_degC_ : 0;
    for (std::size_t i = n; i-- > 0;) {
      const HeatCell& cell = c.cells[i];
      c.right[i] = capacity_share_ * cell.capacity * old[i] + weight_s_ * cell.blood * blood_degC_ + passed_on;
      passed_on = c.share[i] * c.right[i];
    }
    if (n > 0) into += c.contact * c.right[0] * c.inverse[0];
  }
  const double surface = into / surface_out_;
  for (Column& c : columns_) {
    std::vector<double>& x = from_stage ? c.u : c.stage;
    double above = surface;
    for (std::size_t i = 0; i < c.cells.size(); ++i) x[i] = above = c.right[i] * c.inverse[i] + c.share[i] * above;
  }
}

double HeatColumns::surface_of(bool of_stage) const {
  double into = room_ * room_degC_, all = room_;
  for (const Column& c : columns_) {
    if (c.cells.empty()) continue;
    into += c.contact * (of_stage ? c.stage : c.u)[0];
    all += c.contact;
  }
  return into / all;
}

double HeatColumns::objects_flux(bool of_stage) const {
  const double surface = surface_of(of_stage);
  double flux = 0;
  for (std::size_t k = 1; k < columns_.size(); ++k) {
    const Column& c = columns_[k];
    if (!c.cells.empty()) flux += c.contact * (surface - (of_stage ? c.stage : c.u)[0]);
  }
  return flux;
}

void HeatColumns::add_flows(double weight_s, bool of_stage) {
  flows_.skin_to_objects += weight_s * objects_flux(of_stage);
  flows_.skin_to_room += weight_s * room_ * (surface_of(of_stage) - room_degC_);
  const Column& skin = columns_[0];
  const std::vector<double>& u = of_stage ? skin.stage : skin.u;
  for (std::size_t i = 0; i < skin.cells.size(); ++i)
    flows_.blood_to_skin += weight_s * skin.cells[i].blood * (blood_degC_ - u[i]);
  for (std::size_t k = 1; k < columns_.size(); ++k) {
    const Column& c = columns_[k];
    if (!c.cells.empty())
      flows_.objects_to_room += weight_s * c.back * ((of_stage ? c.stage : c.u)[c.cells.size() - 1] - room_degC_);
  }
}

void HeatColumns::step(double dt_s, std::span<const double> contact_W_m2K, double room_W_m2K,
                       double longest_substep_s) {
  room_ = room_W_m2K;
  columns_[0].contact = columns_[0].cells[0].half;
  for (std::size_t k = 1; k < columns_.size(); ++k) {
    Column& c = columns_[k];
    const double h = k - 1 < contact_W_m2K.size() ? contact_W_m2K[k - 1] : 0;
    c.contact = c.cells.empty() ? 0 : in_series(h, c.cells[0].half);
  }
  flows_ = {};
  if (dt_s > 0) {
    const double count = std::clamp(std::ceil(dt_s / longest_substep_s), 1.0, kMaxSubsteps), h_s = dt_s / count;
    factor(1, kGamma * h_s);
    for (int i = 0; i < static_cast<int>(count); ++i) {
      solve(false);
      add_flows((1 - kGamma) * h_s, true);
      flux_ = (1 - kGamma) * objects_flux(true);
      for (Column& c : columns_)
        for (std::size_t j = 0; j < c.cells.size(); ++j)
          c.stage[j] = c.u[j] + (1 - kGamma) / kGamma * (c.stage[j] - c.u[j]);
      solve(true);
      add_flows(kGamma * h_s, false);
      flux_ += kGamma * objects_flux(false);
    }
  }
  surface_ = surface_of(false);
}

void HeatColumns::settle_skin(double room_W_m2K) {
  room_ = room_W_m2K;
  columns_[0].contact = columns_[0].cells[0].half;
  for (std::size_t k = 1; k < columns_.size(); ++k) {
    columns_[k].cells.clear();
    columns_[k].contact = 0;
  }
  // Steady state: the inflow of each cell equals its outflow.
  factor(0, 1);
  solve(false);
  columns_[0].u = columns_[0].stage;
  surface_ = surface_of(false);
  flux_ = 0;
  flows_ = {};
}

double HeatColumns::energy(const Column& c) {
  double sum = 0;
  for (std::size_t i = 0; i < c.cells.size(); ++i) sum += c.cells[i].capacity * c.u[i];
  return sum;
}

double HeatColumns::objects_energy() const {
  double sum = 0;
  for (std::size_t k = 1; k < columns_.size(); ++k) sum += energy(columns_[k]);
  return sum;
}

std::size_t growing_widths(double thickness, double first, double growth, std::span<double> widths) {
  first = std::min(first, thickness / kMinCells);
  if (!(first > 0) || !(thickness > 0)) return 0;
  double sum = 0;
  std::size_t count = 0;
  for (double w = first; sum < thickness * (1 - 1e-12) || count < kMinCells; w *= growth) {
    if (count == widths.size()) return 0;
    widths[count++] = w;
    sum += w;
  }
  for (std::size_t i = 0; i < count; ++i) widths[i] *= thickness / sum;
  return count;
}

}  // namespace tactus::thermal
