// Operators on the output of a modality, as its node declares them: a slow renderer, not a slow network. An operator is an
// attribute of <degrade> with a number: response="2s", dropout="20ms every=1s".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sync {

// How the values of several rules in force are combined; kNewest: the last rule of the profile.
enum class Combine : std::uint8_t { kMin, kMax, kSum, kNewest };

// A second number of an operator, written NAME=VALUE after the first.
struct OutputPair {
  std::string name, unit;
  double initial = 0, min = 0, max = 0;
  std::string too_small = "";  // the message when it is not above the first number; empty: any value in the range is valid
};

struct OutputOperator {
  std::string name, unit;  // "1": no unit
  double min = 0, max = 0;
  std::string meaning = "";
  Combine combine = Combine::kNewest;
  std::vector<OutputPair> pairs = {};
};

// Values of output operators by name; a pair has the name "OPERATOR.PAIR".
class OutputValues {
 public:
  // 0: not degraded.
  double value(std::string_view name) const;
  bool any() const { return !entries_.empty(); }
  void set(std::string_view name, double value, Combine combine = Combine::kNewest);
  // Combines with the values of another rule in force.
  void add(const OutputValues& other);
  // Names of the operators, without pairs.
  std::vector<std::string> operators() const;

 private:
  struct Entry {
    std::string name;
    double value;
    Combine combine;
  };
  std::vector<Entry> entries_;
};

}  // namespace tactus::sync
