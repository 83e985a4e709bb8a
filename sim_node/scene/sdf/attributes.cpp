#include "sim_node/scene/sdf/attributes.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sync/text/settings.h"

namespace tactus::sim {

std::optional<std::string> Attributes::text(const std::string& name) {
  read_names_.insert(name);
  const sdf::Attribute* attribute = element_.attribute(name);
  if (!attribute) return std::nullopt;
  return std::string(attribute->value);
}

std::string Attributes::required_text(const std::string& name) {
  const auto value = text(name);
  if (!value || value->empty()) context_.reject(element_, "lacks its attribute \"" + name + "\"");
  return *value;
}

double Attributes::number(const std::string& name, const std::string& word, const std::string& unit, double min,
                          double max) const {
  double number = 0;
  try {
    number = sync::parse_quantity(word, unit);
  } catch (const std::invalid_argument& e) {
    context_.reject(element_, "has " + name + "=\"" + word + "\": " + e.what());
  }
  if (!(number >= min && number <= max)) {
    std::ostringstream sentence;
    sentence << "has " << name << "=\"" << word << "\": it must be between " << min << " and " << max << " " << unit;
    context_.reject(element_, sentence.str());
  }
  return number;
}

std::optional<double> Attributes::quantity(const std::string& name, const std::string& unit, double min, double max) {
  const auto value = text(name);
  if (!value) return std::nullopt;
  return number(name, *value, unit, min, max);
}

double Attributes::required_quantity(const std::string& name, const std::string& unit, double min, double max) {
  const auto value = quantity(name, unit, min, max);
  if (!value) context_.reject(element_, "lacks its attribute \"" + name + "\"");
  return *value;
}

std::vector<double> Attributes::required_quantities(const std::string& name, std::size_t count, const std::string& unit,
                                                    double min, double max) {
  const std::string value = required_text(name);
  std::istringstream in(value);
  std::vector<double> found;
  for (std::string word; in >> word;) found.push_back(number(name, word, unit, min, max));
  if (found.size() != count)
    context_.reject(element_,
                    "has " + name + "=\"" + value + "\": it must be " + std::to_string(count) + " quantities");
  return found;
}

std::optional<bool> Attributes::flag(const std::string& name) {
  const auto value = text(name);
  if (!value) return std::nullopt;
  if (*value != "true" && *value != "false" && *value != "1" && *value != "0")
    context_.reject(element_, "has " + name + "=\"" + *value + "\": it must be true or false");
  return *value == "true" || *value == "1";
}

std::vector<double> Attributes::numbers(const std::string& name, std::size_t count) {
  const std::string value = text(name).value_or("");
  std::istringstream in(value);
  std::vector<double> found;
  for (std::string word; in >> word;) try {
      found.push_back(sync::parse_quantity(word, ""));
      if (std::abs(found.back()) > 1e6) throw std::invalid_argument("too far");
    } catch (const std::invalid_argument&) {
      found.clear();
      break;
    }
  if (found.size() != count)
    context_.reject(element_,
                    "has " + name + "=\"" + value + "\": it must be " + std::to_string(count) + " finite numbers");
  return found;
}

std::optional<Eigen::Vector3d> Attributes::position(const std::string& name) {
  if (!text(name)) return std::nullopt;
  return Eigen::Vector3d(numbers(name, 3).data());
}

std::optional<Eigen::Isometry3d> Attributes::pose(const std::string& name) {
  if (!text(name)) return std::nullopt;
  const std::vector<double> n = numbers(name, 6);
  return Eigen::Translation3d(n[0], n[1], n[2]) * Eigen::AngleAxisd(n[5], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(n[4], Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(n[3], Eigen::Vector3d::UnitX());
}

void Attributes::done() const {
  for (const sdf::Attribute& attribute : element_.attributes)
    if (!read_names_.contains(attribute.name) && !attribute.name.starts_with("xmlns"))
      context_.reject(element_,
                      "has no attribute \"" + std::string(attribute.name) + "\": docs/scene_format.md lists those it has");
}

}  // namespace tactus::sim
