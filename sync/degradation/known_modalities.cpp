#include "sync/degradation/known_modalities.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "sync/modalities.gen.h"
#include "sync/text/csv.h"

namespace tactus::sync {
namespace {

// Columns of a modality.csv.
enum Column : std::size_t { kWhat, kName, kKind, kUnit, kMin, kMax, kDefault, kMeaning, kColumns };
using Cells = std::vector<std::string>;

double number(const Cells& row, Column column) {
  if (const auto x = csv_number(row[column])) return *x;
  throw std::invalid_argument("modality.csv: " + row[kName] + ": \"" + row[column] + "\" is not a number");
}

template <class Value>
Value word(const Cells& row, const std::map<std::string, Value>& words) {
  if (const auto it = words.find(row[kKind]); it != words.end()) return it->second;
  throw std::invalid_argument("modality.csv: " + row[kName] + ": there is no kind \"" + row[kKind] + "\"");
}

PlayoutKind playout_kind(const Cells& row) {
  return word<PlayoutKind>(
      row, {{"aligned", PlayoutKind::kAligned}, {"local", PlayoutKind::kLocal}, {"slow", PlayoutKind::kSlow}});
}

Combine combine(const Cells& row) {
  return word<Combine>(row, {{"min", Combine::kMin},
                             {"max", Combine::kMax},
                             {"sum", Combine::kSum},
                             {"newest", Combine::kNewest}});
}

OutputPair pair_of(const Cells& row) {
  const bool above = word<bool>(row, {{"above", true}, {"any", false}});
  return {row[kName],        row[kUnit], number(row, kDefault), number(row, kMin), number(row, kMax),
          above ? row[kMeaning] : ""};
}

WithoutEffect without_effect(const Cells& row) {
  const auto quantity = word<Quantity>(
      row, {{"force", Quantity::kForce}, {"velocity", Quantity::kVelocity}, {"position", Quantity::kPosition}});
  return {row[kName], quantity, row[kMeaning]};
}

StageDef stage_of(const Cells& row) {
  return {row[kName],
          word<StageKind>(row, {{"input", StageKind::kInput},
                                {"messages", StageKind::kMessages},
                                {"signal", StageKind::kSignal},
                                {"display", StageKind::kDisplay}}),
          number(row, kMax), row[kMeaning]};
}

using Ranked = std::pair<double, KnownModality>;

void add(std::vector<Ranked>& found, const Cells& row) {
  if (row[kWhat] == "modality") {
    found.push_back({number(row, kMin), {row[kName], playout_kind(row)}});
  } else if (row[kWhat] == "operator" && !found.empty()) {
    found.back().second.operators.push_back(
        {row[kName], row[kUnit], number(row, kMin), number(row, kMax), row[kMeaning], combine(row)});
  } else if (row[kWhat] == "without" && !found.empty()) {
    found.back().second.without_effect.push_back(without_effect(row));
  } else if (row[kWhat] == "stage" && !found.empty()) {
    found.back().second.stages.push_back(stage_of(row));
  } else if (row[kWhat] == "pair" && !found.empty() && !found.back().second.operators.empty()) {
    found.back().second.operators.back().pairs.push_back(pair_of(row));
  } else {
    throw std::invalid_argument("modality.csv: a row \"" + row[kWhat] + "\" is not valid here");
  }
}

}  // namespace

std::vector<KnownModality> parse_modalities(const std::string& csv) {
  std::vector<Ranked> found;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    const Cells row = csv_cells(line);
    if (is_blank(row) || row[0] == "what") continue;
    if (row.size() != kColumns) throw std::invalid_argument("modality.csv: this row does not have 8 cells: " + line);
    add(found, row);
  }
  std::stable_sort(found.begin(), found.end(), [](const Ranked& a, const Ranked& b) { return a.first < b.first; });
  std::vector<KnownModality> modalities;
  for (Ranked& m : found) modalities.push_back(std::move(m.second));
  return modalities;
}

const std::vector<KnownModality>& known_modalities() {
  static const std::vector<KnownModality> table = parse_modalities(kModalitiesCsv);
  return table;
}

std::size_t modality_index(const std::string& name) {
  const auto& all = known_modalities();
  return static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const KnownModality& m) { return m.name == name; }) - all.begin());
}

const KnownModality* known_modality(const std::string& name) {
  const std::size_t place = modality_index(name);
  return place < known_modalities().size() ? &known_modalities()[place] : nullptr;
}

std::vector<OutputOperator> output_operators_of(const std::string& modality) {
  const KnownModality* known = known_modality(modality);
  return known ? known->operators : std::vector<OutputOperator>{};
}

std::string modalities_with(const std::string& output_operator) {
  std::string names;
  for (const KnownModality& m : known_modalities())
    for (const OutputOperator& o : m.operators)
      if (o.name == output_operator) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

const KnownModality* modality_with_stage(const std::string& stage) {
  for (const KnownModality& m : known_modalities())
    for (const StageDef& s : m.stages)
      if (s.name == stage) return &m;
  return nullptr;
}

std::string modalities_with_stages() {
  std::string names;
  for (const KnownModality& m : known_modalities())
    if (!m.stages.empty()) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

const OutputOperator* find_output_operator(const std::string& name) {
  for (const KnownModality& m : known_modalities())
    for (const OutputOperator& o : m.operators)
      if (o.name == name) return &o;
  return nullptr;
}

}  // namespace tactus::sync
