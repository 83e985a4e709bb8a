#include "sim_node/scene/materials/materials.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "sim_node/materials_csv.gen.h"
#include "sync/text/csv.h"
#include "sync/text/settings.h"

namespace tactus::sim {
namespace {

using M = material_def_t;

// Bounds from aerogel to diamond, with a margin; they detect wrong powers of ten and wrong units.
constexpr std::array<MaterialProperty, 11> kProperties{{
    {"youngs_modulus_Pa", "youngs_modulus", "Pa", 1e3, 2e12, &M::youngs_modulus_Pa},
    {"poissons_ratio", "poissons_ratio", "1", -0.99, 0.4999, &M::poissons_ratio},
    {"density_kg_m3", "density", "kg/m3", 1, 25'000, &M::density_kg_m3},
    {"rayleigh_alpha_1_s", "rayleigh_alpha", "1/s", 0, 1e5, &M::rayleigh_alpha_1_s},
    {"rayleigh_beta_s", "rayleigh_beta", "s", 0, 1, &M::rayleigh_beta_s},
    {"friction_static", "friction_static", "1", 0, 10, &M::friction_static},
    {"friction_dynamic", "friction_dynamic", "1", 0, 10, &M::friction_dynamic},
    {"restitution", "restitution", "1", 0, 1, &M::restitution},
    {"conductivity_W_mK", "conductivity", "W/(m K)", 1e-3, 5'000, &M::conductivity_W_mK},
    {"specific_heat_J_kgK", "specific_heat", "J/(kg K)", 10, 20'000, &M::specific_heat_J_kgK},
    {"temperature_degC", "temperature", "degC", -50, 100, &M::temperature_degC},
}};

}  // namespace

std::span<const MaterialProperty> material_properties() { return kProperties; }

std::vector<material_def_t> parse_materials(std::string_view csv) {
  std::vector<std::string> header;
  std::vector<material_def_t> materials;
  for (int row = 1; !csv.empty(); ++row) {
    const auto end = csv.find('\n');
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    const std::vector<std::string> cells = sync::csv_cells(line);
    if (sync::is_blank(cells)) continue;
    if (header.empty()) {
      header = cells;
      continue;
    }
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error("materials.csv:" + std::to_string(row) + ": " + what);
    };
    if (cells.size() != header.size()) fail("has " + std::to_string(cells.size()) + " cells, the header more or fewer");
    const auto cell = [&](const std::string& column) -> const std::string& {
      const auto at = std::find(header.begin(), header.end(), column);
      if (at == header.end()) fail("column " + column + " is missing");
      return cells[static_cast<std::size_t>(at - header.begin())];
    };
    material_def_t material{};
    material.name = cell("name");
    for (const MaterialProperty& property : material_properties()) {
      double value = 0;
      try {
        value = sync::parse_quantity(cell(property.column), property.unit);
      } catch (const std::invalid_argument& e) {
        fail(std::string(property.column) + ": " + e.what());
      }
      if (value < property.min || value > property.max) fail(std::string(property.column) + " is out of range");
      material.*property.field = value;
    }
    for (std::size_t i = 0; i < header.size(); ++i)
      if (header[i].ends_with("_source") && cells[i].empty()) fail(header[i] + " is empty: cite where the figures are from");
    materials.push_back(material);
  }
  return materials;
}

std::vector<material_def_t> builtin_materials() { return parse_materials(kMaterialsCsv); }

}  // namespace tactus::sim
