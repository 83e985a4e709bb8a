#include "thermal_node/bioheat_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "thermal_node/tridiagonal.h"

namespace tactus::thermal {
namespace {

constexpr double kMostSubsteps = 2000;
// Alexander 1977, two stages: gamma = 1 - 1/sqrt(2).
constexpr double kGamma = 0.29289321881345254;
// Heat passes this many s^0.5 in about (95/2)^2 s = 2000 s: beyond it an object is infinite.
constexpr double kFarthest = 95;
// Of the thinnest layer or object.
constexpr std::size_t kFewestCells = 4;

// Appends to `widths` cells that grow by `growth` from `first` and fill `thickness` exactly.
void fill(double thickness, double first, double growth, std::vector<double>& widths) {
  first = std::min(first, thickness / kFewestCells);
  double sum = 0;
  std::size_t count = 0;
  for (double w = first; sum < thickness * (1 - 1e-12) || count < kFewestCells; w *= growth, ++count) sum += w;
  double w = first * thickness / sum;
  for (std::size_t i = 0; i < count; ++i, w *= growth) widths.push_back(w);
}

// Wider than any material by far; beyond it the grid would lose its numbers.
bool conducts(double conductivity_W_mK, double heat_capacity_J_m3K) {
  const double diffusivity = conductivity_W_mK / heat_capacity_J_m3K;
  return diffusivity > 1e-12 && diffusivity < 1e3 && conductivity_W_mK > 1e-9 && conductivity_W_mK < 1e9;
}

double in_series(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

}  // namespace

BioheatModel::BioheatModel(const Tissue& tissue, const Mesh& mesh) : tissue_(tissue), mesh_(mesh) {
  build_skin();
  std::vector<double> far;
  fill(kFarthest, mesh.first_cell, mesh.growth, far);
  most_object_cells_ = far.size() + 1;
  const std::size_t most = skin_cells_ + most_object_cells_;
  for (Cells* cells : {&width_m_, &conductivity_, &capacity_, &blood_, &link_, &lower_, &centre_, &upper_,
                       &source_, &u_, &stage_, &matrix_lower_, &matrix_centre_, &matrix_upper_, &scratch_})
    cells->resize(most);
  link(0, skin_cells_);
  reset();
}

void BioheatModel::build_skin() {
  struct Cell {
    double width, conductivity, capacity, blood;
  };
  std::vector<Cell> cells;  // surface first
  const Layer& top = tissue_.layers.front();
  double next =
      mesh_.first_cell * std::sqrt(top.conductivity_W_mK / (top.density_kg_m3 * top.specific_heat_J_kgK));
  for (const Layer& layer : tissue_.layers) {
    std::vector<double> widths;
    fill(layer.thickness_m, next, mesh_.growth, widths);
    const double blood = layer.perfused ? tissue_.perfusion_1_s * kBloodHeatCapacity_J_m3K : 0;
    for (const double w : widths)
      cells.push_back(
          {w, layer.conductivity_W_mK, w * layer.density_kg_m3 * layer.specific_heat_J_kgK, w * blood});
    next = widths.back() * mesh_.growth;
  }
  skin_cells_ = cells.size();
  for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell) {
    width_m_.push_back(cell->width);
    conductivity_.push_back(cell->conductivity);
    capacity_.push_back(cell->capacity);
    blood_.push_back(cell->blood);
  }
}

// The profile of undisturbed skin is linear in the temperature of the blood: solved once for blood that is one
// kelvin warmer than the room. Without blood nothing balances a loss to the room, so then there is none.
void BioheatModel::rest() {
  const double perfusion =
      std::accumulate(blood_.begin(), blood_.begin() + static_cast<std::ptrdiff_t>(skin_cells_), 0.0);
  if (!(perfusion > 0)) {
    room_degC_ = blood_degC_ = tissue_.rest_degC;
    std::fill(u_.begin(), u_.end(), tissue_.rest_degC);
    return;
  }
  room_degC_ = 0;
  blood_degC_ = 1;
  object_cells_ = 0;
  const Surface s = surface(0, 0);
  join(s);
  for (std::size_t i = 0; i < skin_cells_; ++i) {
    matrix_lower_[i] = -lower_[i], matrix_centre_[i] = -centre_[i], matrix_upper_[i] = -upper_[i];
    u_[i] = source_[i];
  }
  const std::size_t n = skin_cells_;
  solve_tridiagonal({matrix_lower_.data(), n}, {matrix_centre_.data(), n}, {matrix_upper_.data(), n},
                    {u_.data(), n}, {scratch_.data(), n});
  const double warmer_K = (tissue_.rest_degC - tissue_.room_degC) / surface_of(s, u_);
  room_degC_ = tissue_.room_degC;
  blood_degC_ = room_degC_ + warmer_K;
  for (std::size_t i = 0; i < n; ++i) u_[i] = room_degC_ + warmer_K * u_[i];
}

void BioheatModel::reset() {
  rest();
  surface_degC_ = tissue_.rest_degC;
  flux_ = 0;
  flows_ = {};
  set_object(object_);
}

void BioheatModel::set_object(const ObjectProperties& object) {
  object_ = object;
  object_cells_ = 0;
  const double k = object.conductivity_W_mK, c = object.heat_capacity_J_m3K;
  if (conducts(k, c)) {
    const double root = std::sqrt(k / c), far = kFarthest * root;
    const double thickness = object.thickness_m > 0 ? std::min(object.thickness_m, far) : far;
    const double first = std::min(mesh_.first_cell * root, thickness / kFewestCells);
    double sum = 0, w = first;
    for (; object_cells_ < most_object_cells_ && (sum < thickness * (1 - 1e-12) || object_cells_ < kFewestCells);
         w *= mesh_.growth, ++object_cells_)
      sum += w;
    w = first * thickness / sum;
    for (std::size_t i = skin_cells_; i < cells(); ++i, w *= mesh_.growth) {
      width_m_[i] = w;
      conductivity_[i] = k;
      capacity_[i] = w * c;
      blood_[i] = 0;
      u_[i] = object.rest_degC;
    }
    // An object that ends loses heat at its back; one that is infinite ends nowhere.
    back_ = thickness < far ? in_series(tissue_.air_conductance_W_m2K, 2 * k / width_m_[cells() - 1]) : 0;
  }
  link(skin_cells_, cells());
}

// What conducts between neighbours, from the middle of one to that of the next.
void BioheatModel::link(std::size_t from, std::size_t to) {
  for (std::size_t i = from; i + 1 < to; ++i)
    link_[i] = in_series(2 * conductivity_[i] / width_m_[i], 2 * conductivity_[i + 1] / width_m_[i + 1]);
}

BioheatModel::Surface BioheatModel::surface(double conductance_W_m2K, double touched_share) const {
  Surface s;
  const std::size_t last = skin_cells_ - 1;
  s.skin = 2 * conductivity_[last] / width_m_[last];
  if (object_cells_ > 0)
    s.contact = in_series(conductance_W_m2K, 2 * conductivity_[last + 1] / width_m_[last + 1]);
  s.room = tissue_.air_conductance_W_m2K * (1 - touched_share);
  s.sum = s.skin + s.contact + s.room;
  return s;
}

// Sets up the equations of all cells. The surface is eliminated: what leaves the skin's first cell u through
// s.skin goes to the object's first cell v and to the room.
void BioheatModel::join(const Surface& s) {
  const std::size_t n = cells();
  for (std::size_t i = 0; i < n; ++i) {
    lower_[i] = i > 0 && i != skin_cells_ ? link_[i - 1] : 0;
    upper_[i] = i + 1 < n && i + 1 != skin_cells_ ? link_[i] : 0;
    centre_[i] = -lower_[i] - upper_[i] - blood_[i];
    source_[i] = blood_[i] * blood_degC_;
  }
  const std::size_t skin = skin_cells_ - 1, object = skin_cells_;
  centre_[skin] -= s.skin * (s.contact + s.room) / s.sum;
  source_[skin] += s.skin * s.room / s.sum * room_degC_;
  if (object_cells_ == 0) return;
  upper_[skin] = lower_[object] = s.skin * s.contact / s.sum;
  centre_[object] -= s.contact * (s.skin + s.room) / s.sum;
  source_[object] += s.contact * s.room / s.sum * room_degC_;
  centre_[n - 1] -= back_;
  source_[n - 1] += back_ * room_degC_;
}

// u becomes the solution of (capacity - weight * equations) x = capacity u + weight * source.
void BioheatModel::solve_stage(double weight_s, Cells& u) {
  const std::size_t n = cells();
  for (std::size_t i = 0; i < n; ++i) {
    matrix_lower_[i] = -weight_s * lower_[i];
    matrix_centre_[i] = capacity_[i] - weight_s * centre_[i];
    matrix_upper_[i] = -weight_s * upper_[i];
    u[i] = capacity_[i] * u[i] + weight_s * source_[i];
  }
  solve_tridiagonal({matrix_lower_.data(), n}, {matrix_centre_.data(), n}, {matrix_upper_.data(), n},
                    {u.data(), n}, {scratch_.data(), n});
}

double BioheatModel::surface_of(const Surface& s, const Cells& u) const {
  const double object = object_cells_ > 0 ? u[skin_cells_] : 0;
  return (s.skin * u[skin_cells_ - 1] + s.contact * object + s.room * room_degC_) / s.sum;
}

double BioheatModel::contact_flux(const Surface& s, const Cells& u) const {
  return object_cells_ > 0 ? s.contact * (surface_of(s, u) - u[skin_cells_]) : 0;
}

void BioheatModel::account(double weight_s, const Surface& s, const Cells& u) {
  flows_.skin_to_object += weight_s * contact_flux(s, u);
  flows_.skin_to_room += weight_s * s.room * (surface_of(s, u) - room_degC_);
  double blood = 0;
  for (std::size_t i = 0; i < skin_cells_; ++i) blood += blood_[i] * (blood_degC_ - u[i]);
  flows_.blood_to_skin += weight_s * blood;
  if (object_cells_ > 0) flows_.object_to_room += weight_s * back_ * (u[cells() - 1] - room_degC_);
}

void BioheatModel::substep(double dt_s, const Surface& s) {
  const std::size_t n = cells();
  std::copy_n(u_.begin(), n, stage_.begin());
  solve_stage(kGamma * dt_s, stage_);
  account((1 - kGamma) * dt_s, s, stage_);
  flux_ = (1 - kGamma) * contact_flux(s, stage_);
  for (std::size_t i = 0; i < n; ++i) u_[i] += (1 - kGamma) / kGamma * (stage_[i] - u_[i]);
  solve_stage(kGamma * dt_s, u_);
  account(kGamma * dt_s, s, u_);
  flux_ += kGamma * contact_flux(s, u_);
}

void BioheatModel::step(double dt_s, double conductance_W_m2K, double touched_share, double longest_substep_s) {
  const Surface s = surface(conductance_W_m2K, std::clamp(touched_share, 0.0, 1.0));
  flows_ = {};
  if (dt_s > 0) {
    join(s);
    const double count = std::clamp(std::ceil(dt_s / longest_substep_s), 1.0, kMostSubsteps);
    for (int i = 0; i < static_cast<int>(count); ++i) substep(dt_s / count, s);
  }
  surface_degC_ = surface_of(s, u_);
}

double BioheatModel::at_depth_degC(double depth_m) const {
  double above_m = 0, above_degC = surface_degC_, middle_m = 0;
  for (std::size_t i = skin_cells_; i-- > 0;) {
    const double here_m = middle_m + width_m_[i] / 2;
    if (depth_m <= here_m)
      return above_degC + (u_[i] - above_degC) * std::clamp((depth_m - above_m) / (here_m - above_m), 0.0, 1.0);
    above_m = here_m;
    above_degC = u_[i];
    middle_m += width_m_[i];
  }
  return u_[0];
}

double BioheatModel::energy(std::size_t from, std::size_t to) const {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += capacity_[i] * u_[i];
  return sum;
}

}  // namespace tactus::thermal
