// The built-in table of physical materials, sim_node/scenes/materials.csv.
#pragma once

#include <span>
#include <string_view>
#include <tactus/material_def_t.hpp>
#include <vector>

namespace tactus::sim {

// One property of a material: its column in the table, its attribute in <tactus:material>, and its range.
struct MaterialProperty {
  const char* column;
  const char* attribute;
  const char* unit;
  double min, max;
  double material_def_t::*field;
};
std::span<const MaterialProperty> material_properties();

// Throws std::runtime_error with the row when a value is missing, not a number, out of range, or without a source.
std::vector<material_def_t> parse_materials(std::string_view csv);

// The table compiled into the program.
std::vector<material_def_t> builtin_materials();

}  // namespace tactus::sim
