#include "sim_node/scene/extensions/tactus_materials.h"

#include <algorithm>
#include <tactus/asset_ref_t.hpp>
#include <tactus/material_def_t.hpp>

#include "lcmtypes/bump.h"
#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/meshes/file_properties.h"
#include "sim_node/scene/materials/height_image.h"
#include "sim_node/scene/materials/materials.h"
#include "sim_node/model/measured_modes.h"
#include "sim_node/scene/materials/pictures.h"

namespace tactus::sim {
namespace {

// Adds the height map in a file to the images of the world unless it is among them; returns its hash.
std::int64_t image_hash(LoadContext& context, const sdf::Element& element, const std::string& what, const std::string& uri) {
  const std::filesystem::path file = context.asset_file(uri, element);
  try {
    sync::Asset image{asset_ref_t::IMAGE, file.filename().string(), read_image_file(file)};
    context.pictures.height_map(image.bytes);
    return add_image(context.world, std::move(image));
  } catch (const std::exception& e) {
    context.reject(element, "names " + what + " \"" + uri + "\", which cannot be read: " + e.what());
  }
}

// Height map: picture, size of one repetition, and height; all three or none.
void read_bump(LoadContext& context, const sdf::Element& element, Attributes& attributes, material_def_t& material) {
  if (!attributes.text("bump")) {
    for (const char* key : {"bump_size", "bump_height"})
      if (attributes.text(key))
        context.reject(element, std::string("has ") + key + " without bump: name the picture too");
    return;
  }
  const std::string uri = attributes.required_text("bump");
  const std::vector<double> size_m = attributes.required_quantities("bump_size", 2, "m", kMinBumpSize_m, kMaxBumpSize_m);
  material.bump_size_u_m = size_m[0], material.bump_size_v_m = size_m[1];
  material.bump_height_m = attributes.required_quantity("bump_height", "m", kMinBumpHeight_m, kMaxBumpHeight_m);
  material.bump_asset = image_hash(context, element, "bump", uri);
}

// Friction map: picture, size of one repetition, and the factors of black and white; all three or none.
void read_friction_map(LoadContext& context, const sdf::Element& element, Attributes& attributes, material_def_t& material) {
  if (!attributes.text("friction_map")) {
    for (const char* key : {"friction_size", "friction_factors"})
      if (attributes.text(key))
        context.reject(element, std::string("has ") + key + " without friction_map: name the picture too");
    return;
  }
  const std::string uri = attributes.required_text("friction_map");
  const std::vector<double> size_m = attributes.required_quantities("friction_size", 2, "m", kMinBumpSize_m, kMaxBumpSize_m);
  const std::vector<double> factors = attributes.required_quantities("friction_factors", 2, "1", 0, kMaxFrictionFactor);
  material.friction_size_u_m = size_m[0], material.friction_size_v_m = size_m[1];
  material.friction_black = factors[0], material.friction_white = factors[1];
  material.friction_asset = image_hash(context, element, "friction_map", uri);
}

// Table of the measured modes of an object of this material.
void read_modes(LoadContext& context, const sdf::Element& element, Attributes& attributes, material_def_t& material) {
  if (!attributes.text("modes")) return;
  const std::string uri = attributes.required_text("modes");
  const std::filesystem::path file = context.asset_file(uri, element);
  try {
    const sync::Bytes bytes = read_image_file(file);
    material.modes = parse_measured_modes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    material.mode_count = static_cast<int>(material.modes.size());
  } catch (const std::exception& e) {
    context.reject(element, "names modes \"" + uri + "\", which cannot be read: " + e.what());
  }
}

void read_material(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const std::string name = attributes.required_text("name");
  const auto base = attributes.text("base");
  const auto known = context.material_of.find(base.value_or(name));
  if (base && known == context.material_of.end())
    context.reject(element, "has base=\"" + *base + "\": there is no such material before this line");
  material_def_t material{};
  if (known != context.material_of.end()) material = context.world.materials[static_cast<std::size_t>(known->second)];
  material.name = name;
  for (const MaterialProperty& property : material_properties()) {
    const auto value = attributes.quantity(property.attribute, property.unit, property.min, property.max);
    if (value)
      material.*property.field = *value;
    else if (known == context.material_of.end())
      context.reject(element, std::string("is new and lacks \"") + property.attribute +
                                  "\": give it, or a base to take it from");
  }
  read_bump(context, element, attributes, material);
  read_friction_map(context, element, attributes, material);
  read_modes(context, element, attributes, material);
  attributes.done();
  const auto [at, is_new] = context.material_of.try_emplace(name, static_cast<int>(context.world.materials.size()));
  if (is_new)
    context.world.materials.push_back(material);
  else
    context.world.materials[static_cast<std::size_t>(at->second)] = material;
}

int find_material(const LoadContext& context, const sdf::Element& element, const std::string& name) {
  const auto known = context.material_of.find(name);
  if (known != context.material_of.end()) return known->second;
  std::string names;
  for (const auto& [each, index] : context.material_of) names += (names.empty() ? "" : ", ") + each;
  context.reject(element, "names material \"" + name + "\": there are " + names);
}

}  // namespace

int define_material(LoadContext& context, const Properties& properties, const std::filesystem::path& file) {
  const auto base = properties.find("base");
  if (base != properties.end() && properties.size() == 1)
    return find_material(context, element_of("tactus:material", properties, file)->element, base->second);
  Properties named = properties;
  named["name"] = file.filename().string();
  if (context.material_of.contains(named["name"])) named["name"] = file.string();
  read_material(context, element_of("tactus:material", named, file)->element);
  return context.material_of.at(named["name"]);
}

void read_materials(LoadContext& context, const sdf::Element& world) {
  context.world.materials = builtin_materials();
  for (const material_def_t& material : context.world.materials)
    context.material_of[material.name] = static_cast<int>(context.material_of.size());
  for (const sdf::Element& element : world.children("tactus:material")) read_material(context, element);
}

int surface_material(const LoadContext& context, const sdf::Element* element, int inherited) {
  const sdf::Element* surface = sdf::child_of(element, "tactus:surface");
  if (!surface) return inherited;
  Attributes attributes(context, *surface);
  const std::string name = attributes.required_text("material");
  attributes.done();
  return find_material(context, *surface, name);
}

}  // namespace tactus::sim
