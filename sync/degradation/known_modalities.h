// The modalities of the node folders, read from the modality.csv of each folder at build time. Other modalities can join a
// cluster; for them only the name from the bus is available.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sync/degradation/deadband.h"
#include "sync/degradation/output_operator.h"

namespace tactus::sync {

// How a modality takes part in the playout.
enum class PlayoutKind : std::uint8_t {
  kAligned,  // presents with the others
  kLocal,    // presents without playout delay under local_haptic_first
  kSlow      // presents with the others, but they do not wait for it
};

// An operator on a quantity that the modality does not receive, so that it would have no effect.
struct WithoutEffect {
  std::string name;  // quantise, gain, bias, lowpass or deadband
  Quantity quantity = Quantity::kForce;
  std::string reason;  // a clause: "touch receives surfaces and no forces; use force_step"
};

// The object of the operators of a stage.
enum class StageKind : std::uint8_t {
  kInput,     // the streams from the bus, the stage of a rule that names none
  kMessages,  // whole messages of this modality, whose values stay
  kSignal,    // a signal, sample by sample
  kDisplay    // a signal, sample by sample, that acts on the user
};

// A place in the loop of a modality at which a rule of a profile may act.
struct StageDef {
  std::string name;
  StageKind kind = StageKind::kInput;
  double max_delay_s = 0;  // largest delay of a rule; 0: as of any stream
  std::string meaning;
};

struct KnownModality {
  std::string name;
  PlayoutKind kind = PlayoutKind::kAligned;
  std::vector<OutputOperator> operators = {};
  std::vector<WithoutEffect> without_effect = {};
  std::vector<StageDef> stages = {};  // empty: rules act on the input only
};

// Sorted by the "min" cell of their rows, which is their place in the serial order.
const std::vector<KnownModality>& known_modalities();
// Returns null when no table contains the modality.
const KnownModality* known_modality(const std::string& name);
// Index in known_modalities(); its size for an unknown modality.
std::size_t modality_index(const std::string& name);

// Output operators of a known modality; empty for an unknown one.
std::vector<OutputOperator> output_operators_of(const std::string& modality);
// Names of the known modalities that have this output operator, separated by ", "; empty: none.
std::string modalities_with(const std::string& output_operator);
// First output operator of this name in the tables; null: none.
const OutputOperator* find_output_operator(const std::string& name);

// First modality that declares a stage of this name; null: none.
const KnownModality* modality_with_stage(const std::string& stage);
// Names of the modalities that declare stages, separated by ", "; empty: none.
std::string modalities_with_stages();

// Parses concatenated modality.csv tables. Throws std::invalid_argument with one sentence.
std::vector<KnownModality> parse_modalities(const std::string& csv);

}  // namespace tactus::sync
