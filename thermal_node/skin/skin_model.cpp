#include "thermal_node/skin/skin_model.h"

#include <algorithm>

namespace tactus::thermal {
namespace {

// Grid in s^0.5: the surface cell resolves changes of (0.02)^2 s = 0.4 ms; 56 cells that grow by 12 % reach 95
// s^0.5, which heat crosses in about (95/2)^2 s = 2000 s, so the far end has no effect.
constexpr std::size_t kCells = 56;
constexpr double kFirstCell = 0.02;
constexpr double kGrowth = 1.12;

std::array<HeatCell, kCells> half_space(double effusivity, double perfusion_1_s) {
  std::array<HeatCell, kCells> cells;
  double w = kFirstCell;
  for (HeatCell& cell : cells) {
    cell = {effusivity * w, 2 * effusivity / w, perfusion_1_s * effusivity * w};
    w *= kGrowth;
  }
  return cells;
}

std::vector<HeatCell> as_vector(const std::array<HeatCell, kCells>& cells) { return {cells.begin(), cells.end()}; }

}  // namespace

SkinModel::SkinModel(const SkinProperties& skin)
    : skin_(skin), columns_(as_vector(half_space(skin.effusivity, skin.perfusion_1_s)), kMaxObjects, kCells) {
  reset();
}

void SkinModel::reset() {
  columns_.set_skin(0);
  for (std::size_t i = 0; i < kMaxObjects; ++i) set_object(objects_[i], i);
}

void SkinModel::set_object(const ObjectProperties& object, std::size_t index) {
  objects_[index] = object;
  const auto cells = half_space(object.effusivity, 0);
  const bool conducts = object.effusivity > 0;
  columns_.set_object(index, std::span(cells).first(conducts ? kCells : 0), 0, object.rest_degC - skin_.rest_degC);
}

void SkinModel::step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
                     double longest_substep_s) {
  const double bare = 1 - std::clamp(touched_share, 0.0, 1.0);
  columns_.step(dt_s, conductance_W_m2K, skin_.air_conductance_W_m2K * bare, longest_substep_s);
}

}  // namespace tactus::thermal
