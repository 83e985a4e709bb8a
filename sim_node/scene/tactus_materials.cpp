#include "sim_node/scene/tactus_materials.h"

#include "sim_node/scene/attributes.h"
#include "sim_node/scene/materials.h"

namespace tactus::sim {
namespace {

void read_material(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const std::string name = attributes.required_text("name");
  const auto base = attributes.text("base");
  const auto known = context.material_of.find(base.value_or(name));
  if (base && known == context.material_of.end())
    context.refuse(element, "has base=\"" + *base + "\": there is no such material before this line");
  material_def_t material{};
  if (known != context.material_of.end()) material = context.world.materials[static_cast<std::size_t>(known->second)];
  material.name = name;
  for (const MaterialFigure& figure : material_figures()) {
    const auto value = attributes.quantity(figure.attribute, figure.unit, figure.min, figure.max);
    if (value)
      material.*figure.field = *value;
    else if (known == context.material_of.end())
      context.refuse(element, std::string("is new and lacks \"") + figure.attribute + "\": give it, or a base to take it from");
  }
  attributes.done();
  const auto [at, is_new] = context.material_of.try_emplace(name, static_cast<int>(context.world.materials.size()));
  if (is_new)
    context.world.materials.push_back(material);
  else
    context.world.materials[static_cast<std::size_t>(at->second)] = material;
}

}  // namespace

void read_materials(LoadContext& context, const sdf::ElementPtr& world) {
  context.world.materials = builtin_materials();
  for (const material_def_t& material : context.world.materials)
    context.material_of[material.name] = static_cast<int>(context.material_of.size());
  for (auto element = world->GetFirstElement(); element; element = element->GetNextElement())
    if (element->GetName() == "tactus:material") read_material(context, *element);
}

int surface_material(const LoadContext& context, const sdf::ElementPtr& element, int inherited) {
  const sdf::ElementPtr surface = written(element, "tactus:surface");
  if (!surface) return inherited;
  Attributes attributes(context, *surface);
  const std::string name = attributes.required_text("material");
  attributes.done();
  const auto known = context.material_of.find(name);
  if (known == context.material_of.end()) {
    std::string names;
    for (const auto& [each, index] : context.material_of) names += (names.empty() ? "" : ", ") + each;
    context.refuse(*surface, "names material \"" + name + "\": there are " + names);
  }
  return known->second;
}

}  // namespace tactus::sim
