#include "sim_node/scene/sdf/convert.h"

#include <algorithm>
#include <unordered_set>

#include "sim_node/scene/sdf/tree.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim::sdf {
namespace {

constexpr int kGravityInWorld = 6, kRelativeTo = 7, kExpressedIn = 7, kUniqueNames = 7, kScopedNames = 8;

// More than any name has (design): bodies have the names of all models around them.
constexpr std::size_t kMaxName = 256;

void convert_pose(Element& pose) {
  if (const Attribute* frame = pose.attribute("frame")) set_attribute(pose, "relative_to", frame->value);
}

void convert_axis(Element& axis) {
  const Element* own = axis.child("use_parent_model_frame");
  const bool of_model = own ? flag(*own) : axis.source->version <= 4;
  if (own) remove(const_cast<Element&>(*own));
  Element* xyz = const_cast<Element*>(axis.child("xyz"));
  if (of_model && xyz) set_attribute(*xyz, "expressed_in", "__model__");
}

void convert_gravity(Element& world) {
  const Element* inside = child_of(world.child("physics"), "gravity");
  if (!inside || world.child("gravity")) return;
  Element& gravity = const_cast<Element&>(*inside);
  remove(gravity);
  adopt(world, gravity);
}

bool is_reserved(std::string_view name) {
  return name == "world" || (name.size() >= 4 && name.starts_with("__") && name.ends_with("__"));
}

void check_name(const Element& element) {
  const std::string_view name = element.value("name");
  if (name.empty()) reject(element, "lacks its attribute \"name\"");
  if (name.size() > kMaxName) reject(element, "has a name of more than " + std::to_string(kMaxName) + " bytes: shorten it");
  if (is_reserved(name)) reject(element, "has a reserved name: choose another than world and __NAME__");
  if (name.find("::") != std::string_view::npos && (element.source->version >= kScopedNames || element.name == "model"))
    reject(element, "has a name with \"::\", which separates names: choose another");
}

// The children of one type, whose names must differ from each other.
void check_siblings(const Element& parent, std::string_view type) {
  std::unordered_set<std::string_view> names;
  for (const Element& child : parent.children(type)) {
    check_name(child);
    if (!names.insert(child.value("name")).second)
      reject(child, "has the name of another <" + std::string(type) + "> beside it: choose another");
  }
}

std::string free_name(const std::unordered_set<std::string_view>& names, const Element& element) {
  const std::string base = std::string(element.value("name")) + "_" + std::string(element.name);
  std::string name = base;
  for (int i = 0; names.contains(name); ++i) name = base + std::to_string(i);
  return name;
}

}  // namespace

void convert(Element& element) {
  const int version = element.source->version;
  if (version == 0 || version >= kRelativeTo) return;
  if (element.name == "pose") convert_pose(element);
  if (version < kExpressedIn && (element.name == "axis" || element.name == "axis2")) convert_axis(element);
  if (version < kGravityInWorld && element.name == "world") convert_gravity(element);
}

void check_names(Element& element, std::deque<std::string>& strings, std::vector<std::string>& warnings) {
  check_name(element);
  if (element.name == "link")
    for (const char* type : {"collision", "visual", "light"}) check_siblings(element, type);
  if (element.name == "world") check_siblings(element, "light");
  if (element.name != "world" && element.name != "model") return;
  std::unordered_set<std::string_view> names;
  for (const char* type : {"model", "link", "joint", "frame"}) {
    check_siblings(element, type);
    for (Element* child = element.first; child; child = child->next) {
      if (child->name != type) continue;
      if (names.insert(child->value("name")).second) continue;
      if (child->source->version >= kUniqueNames)
        reject(*child, "has the name of another link, joint, frame or model beside it: choose another");
      strings.push_back(free_name(names, *child));
      add_warning(warnings, message(*child, "has the name of another element beside it: it is \"" + strings.back() +
                                             "\" here"));
      set_attribute(*child, "name", strings.back());
      names.insert(strings.back());
    }
  }
}

}  // namespace tactus::sim::sdf
