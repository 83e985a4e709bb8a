#include "sim_node/scene/tactus_profile.h"

#include <stdexcept>

#include "sim_node/scene/attributes.h"
#include "sync/degradation/profile.h"
#include "sync/degradation/profile_exchange.h"

namespace tactus::sim {
namespace {

std::string escaped(const std::string& text) {
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

// The start of the tag as a profile has it.
std::string tag(const std::string& name, const sdf::Element& element) {
  std::string text = "<" + name;
  for (const auto& attribute : element.GetAttributes())
    if (const std::string key = attribute->GetKey(); !key.starts_with("xmlns"))
      text += " " + key + "=\"" + escaped(attribute->GetAsString()) + "\"";
  return text;
}

void check(const LoadContext& context, const sdf::Element& element, const std::string& xml) {
  try {
    sync::parse_profile(xml, "");
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what();  // ":1: reason"
    context.refuse(element, "does not hold: " + what.substr(what.find(": ") + 2));
  }
}

std::string from_file(LoadContext& context, const sdf::ElementPtr& element) {
  Attributes attributes(context, *element);
  const auto file = context.asset_file(attributes.required_text("file"), *element);
  attributes.done();
  if (element->GetFirstElement())
    context.refuse(*element, "names a file and holds <tactus:degrade> too: choose one");
  try {
    return sync::read_profile_file(file.string());
  } catch (const std::invalid_argument& e) {
    context.refuse(*element, std::string("does not hold: ") + e.what());
  }
}

}  // namespace

void read_profile(LoadContext& context, const sdf::ElementPtr& world) {
  const sdf::ElementPtr element = written(world, "tactus:profile");
  if (!element) return;
  for (auto other = element->GetNextElement("tactus:profile"); other;
       other = other->GetNextElement("tactus:profile"))
    context.refuse(*other, "is a second profile: a scene has one, with any number of <tactus:degrade>");
  if (element->HasAttribute("file")) {
    context.world.profile = from_file(context, element);
    return;
  }
  check(context, *element, tag("profile", *element) + "/>");
  std::string rules;
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (child->GetName() != "tactus:degrade")
      context.refuse(*child, "is not known in a profile: it holds <tactus:degrade>");
    const std::string rule = tag("degrade", *child) + "/>";
    check(context, *child, "<profile>" + rule + "</profile>");
    rules += "  " + rule + "\n";
  }
  context.world.profile = tag("profile", *element) + ">\n" + rules + "</profile>\n";
  check(context, *element, context.world.profile);
  if (context.world.profile.size() > sync::kMaxProfileBytes)
    context.refuse(*element, "is longer than 64 kB: leave out what it does not need");
}

}  // namespace tactus::sim
