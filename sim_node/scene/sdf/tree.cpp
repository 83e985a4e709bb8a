#include "sim_node/scene/sdf/tree.h"

#include <tinyxml2.h>

#include "sim_node/scene/sdf/convert.h"

namespace tactus::sim::sdf {
namespace {

std::string_view text_of(const tinyxml2::XMLElement& xml) {
  const char* text = xml.GetText();
  return text ? trimmed(text) : std::string_view();
}

bool has_name(const Element& element) {
  return element.name == "world" || element.name == "model" || element.name == "link";
}

}  // namespace

void adopt(Element& parent, Element& child) {
  child.parent = &parent;
  child.next = nullptr;
  (parent.last ? parent.last->next : parent.first) = &child;
  parent.last = &child;
}

void remove(Element& child) {
  Element& parent = *child.parent;
  Element* before = nullptr;
  for (Element* each = parent.first; each != &child; each = each->next) before = each;
  (before ? before->next : parent.first) = child.next;
  if (parent.last == &child) parent.last = before;
  child.parent = child.next = nullptr;
}

void set_attribute(Element& element, std::string_view key, std::string_view value) {
  for (Attribute& each : element.attributes)
    if (each.name == key) {
      each.value = value;
      return;
    }
  element.attributes.push_back({key, value});
}

Tree::Tree(const SdfFiles& files, std::vector<std::string>& warnings) : files_(files), warnings_(warnings) {
  root_ = &copy(*files.main().xml->RootElement(), files.main().source, nullptr);
}

Element& Tree::append(Element& parent, std::string_view name, const Source& source, int line) {
  Element& element = elements_.emplace_back();
  element.name = name, element.source = &source, element.line = line;
  adopt(parent, element);
  return element;
}

Element& Tree::copy(const tinyxml2::XMLElement& xml, const Source& source, Element* parent, bool foreign) {
  Element& element = elements_.emplace_back();
  element.name = xml.Value(), element.text = text_of(xml);
  element.source = &source, element.line = xml.GetLineNum();
  for (const auto* each = xml.FirstAttribute(); each; each = each->Next())
    element.attributes.push_back({each->Name(), trimmed(each->Value())});
  if (parent) adopt(*parent, element);
  foreign = foreign || is_foreign(element.name);
  for (const auto* child = xml.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (!foreign && std::string_view(child->Value()) == "include") include(*child, source, element);
    else copy(*child, source, &element, foreign);
  }
  if (foreign) return element;
  convert(element);
  if (has_name(element)) check_names(element, strings_, warnings_);
  return element;
}

}  // namespace tactus::sim::sdf
