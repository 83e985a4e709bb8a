// Replaces an <include> by the model, light or actor of the file that it names.
#include <tinyxml2.h>

#include <charconv>

#include "sim_node/scene/sdf/convert.h"
#include "sim_node/scene/sdf/frames.h"
#include "sim_node/scene/sdf/tree.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim::sdf {
namespace {

bool merge_of(const tinyxml2::XMLElement& xml, const std::string& here) {
  const char* const given = xml.Attribute("merge");
  const auto merged = given ? parse_flag(trimmed(given)) : false;
  if (!merged) throw std::runtime_error(here + ": <include> has merge=\"" + given + "\": it must be true or false");
  return *merged;
}

// The first <model>, else <light>, else <actor>; nullptr: none.
const tinyxml2::XMLElement* content_of(const tinyxml2::XMLElement& root) {
  for (const char* type : {"model", "light", "actor"})
    if (const auto* found = root.FirstChildElement(type)) return found;
  return nullptr;
}

// The first link of the model or of its first nested model that has one, as the model names it; empty: none.
std::string first_link(const Element& model) {
  if (const Element* link = model.child("link")) return std::string(link->value("name"));
  for (const Element& nested : model.children("model"))
    if (const std::string inside = first_link(nested); !inside.empty())
      return std::string(nested.value("name")) + "::" + inside;
  return {};
}

void replace_model_frame(Element* element, const char* key, std::string_view frame, bool if_empty) {
  if (!element) return;
  const std::string_view value = element->value(key);
  if (value == "__model__" || (if_empty && value.empty())) set_attribute(*element, key, frame);
}

// In full precision, as quat_xyzw.
std::string text_of(const Pose& pose) {
  std::string text;
  const Rotation& q = pose.rotation;
  for (const double value : {pose.position_m.x(), pose.position_m.y(), pose.position_m.z(), q.x, q.y, q.z, q.w}) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    text.append(buffer, end).append(" ");
  }
  return text;
}

Element* child_to_change(Element& element, std::string_view name) { return const_cast<Element*>(element.child(name)); }

}  // namespace

void Tree::include(const tinyxml2::XMLElement& xml, const Source& source, Element& parent) {
  const SdfFiles::Document* document = files_.included_by(xml);
  if (!document) return;  // skipped with a warning, or inside an element of another program
  const std::string here = where(source, xml.GetLineNum());
  const tinyxml2::XMLElement& root = *document->xml->RootElement();
  const bool merged = merge_of(xml, here);
  if (const auto* world = root.FirstChildElement("world"); world && merged && parent.name == "world")
    return merge_world(*world, document->source, parent);
  const tinyxml2::XMLElement* content = content_of(root);
  // An included file may itself only include a model.
  if (!content) content = root.FirstChildElement("include");
  if (!content)
    throw std::runtime_error(here + ": includes \"" + document->source.shown + "\", which has no <model> and no <light>");
  if (const auto* other = content->NextSiblingElement(content->Value()))
    add_warning(warnings_, where(document->source, other->GetLineNum()) + ": <" + content->Value() +
                        "> is not the first one of an included file and has no effect");
  const std::string_view type = content->Value();
  Element holder;  // takes the place of the parent until the overrides are in force
  holder.name = parent.name, holder.source = &source, holder.parent = parent.parent;
  if (const Attribute* name = parent.attribute("name")) holder.attributes.push_back(*name);
  if (type == "include") include(*content, document->source, holder);
  else copy(*content, document->source, &holder);
  Element* element = holder.first;
  if (!element) return;
  remove(*element);
  element->parent = &parent;
  if (element->name == "model") override_model(xml, source, *element);
  else if (const auto* name = xml.FirstChildElement("name"); name && name->GetText())
    set_attribute(*element, "name", trimmed(name->GetText()));
  element->parent = nullptr;
  if (!merged) return adopt(parent, *element);
  if (element->name != "model") throw std::runtime_error(here + ": <include> has merge, but the file has no <model>");
  merge(*element, parent);
}

// A <pose>, <static> or <plugin> of the include replaces that of the model, with everything that it has.
void Tree::override_model(const tinyxml2::XMLElement& include, const Source& source, Element& model) {
  const std::string here = where(source, include.GetLineNum());
  if (const Element* pose = model.child("pose"); pose && !pose->value("relative_to").empty())
    reject(*pose, "has relative_to, but the model is the outermost one of its file: remove it");
  const auto* name = include.FirstChildElement("name");
  if (name && name->GetText()) set_attribute(model, "name", trimmed(name->GetText()));
  for (const char* type : {"pose", "static"}) {
    const auto* from = include.FirstChildElement(type);
    if (!from) continue;
    if (Element* before = child_to_change(model, type)) remove(*before);
    copy(*from, source, &model);
  }
  if (const auto* frame = include.FirstChildElement("placement_frame"); frame && frame->GetText()) {
    if (!include.FirstChildElement("pose"))
      throw std::runtime_error(here + ": <include> has a <placement_frame> without <pose>: give the pose of that frame");
    set_attribute(model, "placement_frame", trimmed(frame->GetText()));
  }
  for (const auto* child = include.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view type = child->Value();
    if (is_foreign(type)) copy(*child, source, &model);
    else if (type != "uri" && type != "name" && type != "pose" && type != "static" && type != "placement_frame")
      add_warning(warnings_, where(source, child->GetLineNum()) + ": <" + child->Value() + "> inside <include> has no effect");
  }
  check_names(model, strings_, warnings_);
}

void Tree::merge_world(const tinyxml2::XMLElement& world, const Source& source, Element& parent) {
  for (const auto* child = world.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view type = child->Value();
    if (type == "include") include(*child, source, parent);
    else if (type == "model" || type == "light" || type == "frame" || type == "joint") copy(*child, source, &parent);
  }
}

// Stands for the frame of the merged model. A pose that is that of a placement frame is resolved.
Element& Tree::frame_of_merged(Element& model, Element& parent) {
  Element* pose = child_to_change(model, "pose");
  std::string_view relative_to = pose ? pose->value("relative_to") : std::string_view();
  if (relative_to.empty()) relative_to = parent.name == "world" ? "world" : "__model__";
  Pose resolved = pose ? raw_pose(*pose) : Pose{};
  if (!model.value("placement_frame").empty()) {
    if (pose) set_attribute(*pose, "relative_to", "");
    Element holder;
    holder.name = "sdf", holder.source = model.source, holder.first = holder.last = &model;
    resolved = Frames(holder).pose(model);
  }
  Element& frame = append(parent, "frame", *model.source, model.line);
  set_attribute(frame, "name", strings_.emplace_back("_merged__" + std::string(model.value("name")) + "__model__"));
  const std::string_view canonical = model.value("canonical_link");
  const std::string_view link = strings_.emplace_back(canonical.empty() ? first_link(model) : std::string(canonical));
  if (!link.empty()) set_attribute(frame, "attached_to", link);
  Element& placed = append(frame, "pose", *model.source, pose ? pose->line : model.line);
  if (pose) placed.source = pose->source;
  placed.text = strings_.emplace_back(text_of(resolved));
  set_attribute(placed, "rotation_format", "quat_xyzw");
  set_attribute(placed, "relative_to", relative_to);
  return frame;
}

// The links, joints, frames and models of the included model become those of the parent. Their poses are relative to a
// frame that stands for that of the model. The same as libsdformat 12 (parser.cc, insertIncludedElement).
void Tree::merge(Element& model, Element& parent) {
  if (parent.name != "model" && parent.name != "world")
    reject(model, "is merged into <" + std::string(parent.name) + ">: merge it into a <model> or <world>");
  const std::string_view frame = frame_of_merged(model, parent).value("name");
  Element* next = nullptr;
  for (Element* child = model.first; child; child = next) {
    next = child->next;
    const std::string_view type = child->name;
    const bool placed = type == "link" || type == "model";
    if (placed && !child->child("pose")) append(*child, "pose", *child->source, child->line);
    replace_model_frame(child_to_change(*child, "pose"), "relative_to", frame, placed);
    if (type == "frame") replace_model_frame(child, "attached_to", frame, true);
    for (const char* axis : {"axis", "axis2"})
      if (Element* of_joint = child_to_change(*child, axis); of_joint && type == "joint")
        replace_model_frame(child_to_change(*of_joint, "xyz"), "expressed_in", frame, false);
    if (placed || type == "joint" || type == "frame" || type == "plugin" || type.find(':') != std::string_view::npos)
      adopt(parent, *child);
  }
}

}  // namespace tactus::sim::sdf
