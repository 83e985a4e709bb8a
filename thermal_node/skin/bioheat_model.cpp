#include "thermal_node/skin/bioheat_model.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {

// Heat crosses this length, in s^0.5, in about (95/2)^2 s = 2000 s: a thicker object is infinite.
constexpr double kMaxDepth = 95;
// Bound for the thinnest cells that a caller may request.
constexpr std::size_t kMaxCells = 1000;

// Far wider than the range of any material; beyond it the grid would lose precision.
bool conducts(double conductivity_W_mK, double heat_capacity_J_m3K) {
  const double diffusivity = conductivity_W_mK / heat_capacity_J_m3K;
  return diffusivity > 1e-12 && diffusivity < 1e3 && conductivity_W_mK > 1e-9 && conductivity_W_mK < 1e9;
}

}  // namespace

std::vector<HeatCell> BioheatModel::skin_cells(const Tissue& tissue, const Mesh& mesh) {
  std::vector<HeatCell> cells;
  const Layer& top = tissue.layers.front();
  double next = mesh.first_cell * std::sqrt(top.conductivity_W_mK / (top.density_kg_m3 * top.specific_heat_J_kgK));
  std::vector<double> widths(kMaxCells);
  for (const Layer& layer : tissue.layers) {
    const std::size_t count = growing_widths(layer.thickness_m, next, mesh.growth, widths);
    const double blood = layer.perfused ? tissue.perfusion_1_s * kBloodHeatCapacity_J_m3K : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double w = widths[i];
      cells.push_back(
          {w * layer.density_kg_m3 * layer.specific_heat_J_kgK, 2 * layer.conductivity_W_mK / w, w * blood});
      next = w * mesh.growth;
    }
  }
  return cells;
}

BioheatModel::BioheatModel(const Tissue& tissue, const Mesh& mesh)
    : tissue_(tissue),
      mesh_(mesh),
      columns_(skin_cells(tissue, mesh), kMaxObjects, kMaxCells),
      object_width_m_(kMaxCells),
      object_cells_(kMaxCells) {
  reset();
}

// The temperature of undisturbed skin is linear in the blood temperature, so the blood temperature follows from
// the difference that one kelvin makes. Without blood flow nothing balances a loss to the room, so the room is
// then at the resting temperature.
void BioheatModel::reset() {
  const bool living = tissue_.perfusion_1_s > 0 && std::any_of(tissue_.layers.begin(), tissue_.layers.end(),
                                                               [](const Layer& layer) { return layer.perfused; });
  if (living) {
    columns_.set_room(0);
    columns_.set_blood(1);
    columns_.settle_skin(tissue_.air_conductance_W_m2K);
    blood_degC_ = tissue_.room_degC + (tissue_.rest_degC - tissue_.room_degC) / columns_.surface();
    columns_.set_room(tissue_.room_degC);
    columns_.set_blood(blood_degC_);
    columns_.settle_skin(tissue_.air_conductance_W_m2K);
  } else {
    blood_degC_ = tissue_.rest_degC;
    columns_.set_room(tissue_.rest_degC);
    columns_.set_blood(tissue_.rest_degC);
    columns_.set_skin(tissue_.rest_degC);
  }
  for (std::size_t i = 0; i < kMaxObjects; ++i) set_object(objects_[i], i);
}

void BioheatModel::set_object(const ObjectProperties& object, std::size_t index) {
  objects_[index] = object;
  const double k = object.conductivity_W_mK, c = object.heat_capacity_J_m3K;
  std::size_t count = 0;
  double back_W_m2K = 0;
  if (conducts(k, c)) {
    const double root = std::sqrt(k / c), max_depth_m = kMaxDepth * root;
    const bool ends = object.thickness_m > 0 && object.thickness_m < max_depth_m;
    count = growing_widths(ends ? object.thickness_m : max_depth_m, mesh_.first_cell * root, mesh_.growth,
                           object_width_m_);
    for (std::size_t i = 0; i < count; ++i)
      object_cells_[i] = {object_width_m_[i] * c, 2 * k / object_width_m_[i], 0};
    // A finite object loses heat at its back; an infinite one has no back.
    if (ends && count > 0 && tissue_.air_conductance_W_m2K > 0)
      back_W_m2K = 1 / (1 / tissue_.air_conductance_W_m2K + 1 / object_cells_[count - 1].half);
  }
  columns_.set_object(index, std::span<const HeatCell>(object_cells_).first(count), back_W_m2K, object.rest_degC);
}

void BioheatModel::step(double dt_s, std::span<const double> conductance_W_m2K, double touched_share,
                        double longest_substep_s) {
  const double bare = 1 - std::clamp(touched_share, 0.0, 1.0);
  columns_.step(dt_s, conductance_W_m2K, tissue_.air_conductance_W_m2K * bare, longest_substep_s);
}

}  // namespace tactus::thermal
