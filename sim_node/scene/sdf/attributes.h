// Reads the attributes of a <tactus:...> element with their units; errors name the line.
#pragma once

#include <functional>
#include <optional>
#include <set>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

class Attributes {
 public:
  Attributes(const LoadContext& context, const sdf::Element& element) : context_(context), element_(element) {}

  std::optional<std::string> text(const std::string& name);
  std::string required_text(const std::string& name);
  // In the given base unit ("m", "kg", "s", "1", ...), within the limits.
  std::optional<double> quantity(const std::string& name, const std::string& unit, double min, double max);
  double required_quantity(const std::string& name, const std::string& unit, double min, double max);
  // "0.5m 0.2m": `count` quantities in sequence.
  std::vector<double> required_quantities(const std::string& name, std::size_t count, const std::string& unit, double min,
                                          double max);
  std::optional<bool> flag(const std::string& name);
  // "x y z" in metres.
  std::optional<Eigen::Vector3d> position(const std::string& name);
  // "x y z roll pitch yaw" in metres and radians, as in SDF.
  std::optional<Eigen::Isometry3d> pose(const std::string& name);
  // Rejects attributes that were not read, so that a misspelt one is not ignored silently.
  void done() const;

 private:
  double number(const std::string& name, const std::string& word, const std::string& unit, double min, double max) const;
  std::vector<double> numbers(const std::string& name, std::size_t count);

  const LoadContext& context_;
  const sdf::Element& element_;
  std::set<std::string, std::less<>> read_names_;
};

}  // namespace tactus::sim
