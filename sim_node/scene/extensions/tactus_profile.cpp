#include "sim_node/scene/extensions/tactus_profile.h"

#include <algorithm>
#include <stdexcept>

#include "sim_node/scene/sdf/attributes.h"
#include "sync/degradation/known_modalities.h"
#include "sync/degradation/profile.h"
#include "sync/degradation/profile_exchange.h"

namespace tactus::sim {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  return out;
}

// The start tag in the syntax of a profile.
std::string tag(const std::string& name, const sdf::Element& element) {
  std::string text = "<" + name;
  for (const sdf::Attribute& attribute : element.attributes)
    if (!attribute.name.starts_with("xmlns"))
      text += " " + std::string(attribute.name) + "=\"" + escaped(attribute.value) + "\"";
  return text;
}

// A hint when a model is named without its link; "": no such model.
std::string suggest_body(const WorldDef& world, const std::string& name) {
  for (const BodyDef& body : world.bodies)
    if (body.name.starts_with(name + "::")) return "; is \"" + body.name + "\" meant?";
  return "";
}

// Checks that everything a profile names is in this scene. file: file of its rules; "": in the element itself.
void check_names(const LoadContext& context, const sdf::Element& element, const sync::Profile& profile,
                 const std::string& file) {
  const WorldDef& world = context.world;
  for (const sync::Rule& rule : profile.rules) {
    const std::string at = file.empty() ? "" : file + ":" + std::to_string(rule.line) + ": ";
    if (!sync::known_modality(rule.modality))
      context.warn(element, at + "there is no modality \"" + rule.modality + "\"; another program may have it");
    if (!rule.material.empty() && !context.material_of.contains(rule.material))
      context.reject(element, "is invalid: " + at + "material=\"" + rule.material +
                                  "\": there is no such material in this scene");
    for (const std::string& name : {rule.body_a, rule.body_b})
      if (!name.empty() && std::none_of(world.bodies.begin(), world.bodies.end(),
                                        [&](const BodyDef& body) { return body.name == name; }))
        context.reject(element, "is invalid: " + at + "bodies=\"" + rule.body_a + " " + rule.body_b +
                                    "\": there is no body \"" + name + "\" in this scene" +
                                    suggest_body(world, name));
  }
}

void reject_text(const LoadContext& context, const sdf::Element& element) {
  if (!element.text.empty())
    context.reject(element, "has text in it, which has no meaning here: remove it");
}

sync::Profile parse_checked(const LoadContext& context, const sdf::Element& element, const std::string& xml) {
  try {
    return sync::parse_profile(xml, "");
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what();  // ":1: reason"
    context.reject(element, "is invalid: " + what.substr(what.find(": ") + 2));
  }
}

std::string from_file(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const auto file = context.asset_file(attributes.required_text("file"), element);
  attributes.done();
  if (element.first)
    context.reject(element, "names a file and holds <tactus:degrade> too: choose one");
  try {
    const sync::ProfileInForce profile = sync::read_profile_file(file.string());
    check_names(context, element, *profile.parsed, file.filename().string());
    return profile.text;
  } catch (const std::invalid_argument& e) {
    context.reject(element, std::string("is invalid: ") + e.what());
  }
}

}  // namespace

void read_profile(LoadContext& context, const sdf::Element& world) {
  const sdf::Element* element = world.child("tactus:profile");
  if (!element) return;
  for (const sdf::Element& other : world.children("tactus:profile"))
    if (&other != element) context.reject(other, "is a second profile: a scene has one, with any number of <tactus:degrade>");
  if (element->attribute("file")) {
    context.world.profile = from_file(context, *element);
    return;
  }
  reject_text(context, *element);
  parse_checked(context, *element, tag("profile", *element) + "/>");
  std::string rules;
  for (const sdf::Element& child : element->children()) {
    if (child.name != "tactus:degrade")
      context.reject(child, "is not known in a profile: it holds <tactus:degrade>");
    const std::string rule = tag("degrade", child) + "/>";
    reject_text(context, child);
    if (child.first)
      context.reject(*child.first, "is inside a <tactus:degrade>, which has only attributes");
    check_names(context, child, parse_checked(context, child, "<profile>" + rule + "</profile>"), "");
    rules += "  " + rule + "\n";
  }
  context.world.profile = tag("profile", *element) + ">\n" + rules + "</profile>\n";
  parse_checked(context, *element, context.world.profile);
  if (context.world.profile.size() > sync::kMaxProfileBytes)
    context.reject(*element, "is longer than 64 kB: remove parts that it does not need");
}

}  // namespace tactus::sim
