#include "sim_node/scene/sdf/element.h"

#include <stdexcept>

#include "lcmtypes/utf8.h"

namespace tactus::sim::sdf {
namespace {

constexpr std::size_t kMaxMessage = 1500, kMaxWarnings = 1000;  // more than anyone reads (design)
constexpr std::size_t kMaxQuotedName = 100;

}  // namespace

const Attribute* Element::attribute(std::string_view key) const {
  for (const Attribute& each : attributes)
    if (each.name == key) return &each;
  return nullptr;
}

std::string_view Element::value(std::string_view key, std::string_view missing) const {
  const Attribute* found = attribute(key);
  return found ? found->value : missing;
}

const Element* Element::child(std::string_view child_name) const {
  for (const Element* each = first; each; each = each->next)
    if (each->name == child_name) return each;
  return nullptr;
}

Children Element::children(std::string_view child_name) const { return {first, child_name}; }

const Element* child_of(const Element* element, std::string_view child_name) {
  return element ? element->child(child_name) : nullptr;
}

std::string where(const Source& source, int line) {
  return source.shown + (line > 0 ? ":" + std::to_string(line) : "");
}

std::string where(const Element& element) { return where(*element.source, element.line); }

std::string path_of(const Element& element) {
  std::string path;
  for (const Element* each = &element; each; each = each->parent) {
    std::string step = "/" + std::string(each->name);
    if (const Attribute* name = each->attribute("name")) step += "[@name=\"" + std::string(first_bytes(name->value, kMaxQuotedName)) + "\"]";
    path.insert(0, step);
  }
  return path;
}

std::string one_line(std::string text) {
  if (text.size() > kMaxMessage) text = std::string(first_bytes(text, kMaxMessage)) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  return text;
}

std::string message(const Element& element, const std::string& sentence) {
  return one_line(where(element) + ": " + path_of(element) + " " + sentence);
}

void add_warning(std::vector<std::string>& warnings, const std::string& text) {
  if (warnings.size() > kMaxWarnings) return;
  warnings.push_back(warnings.size() < kMaxWarnings
                         ? one_line(text)
                         : "there are more than " + std::to_string(kMaxWarnings) + " warnings; the rest is left out");
}

void reject(const Element& element, const std::string& sentence) {
  throw std::runtime_error(message(element, sentence));
}

bool is_foreign(std::string_view element_name) {
  return element_name == "plugin" || element_name == "actor" || element_name == "state" ||
         element_name == "population" || element_name.find(':') != std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\r\f\v";
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace tactus::sim::sdf
