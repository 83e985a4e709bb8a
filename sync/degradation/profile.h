// A degradation profile: the degradations of each modality, as data. It is read from XML; an invalid file is refused as a
// whole.
//
//   <profile name="late sound" seed="7">
//     <degrade modality="audio" delay="40ms" jitter="3ms normal" loss="5% burst=3"/>
//   </profile>
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sync/degradation/deadband.h"
#include "sync/degradation/known_modalities.h"
#include "sync/degradation/output_operator.h"
#include "sync/random/jitter.h"
#include "sync/random/loss.h"
#include "sync/time/time.h"

namespace tactus::sync {

// presentation: the output is later by the full value, under every policy. network: the input messages are later, and a
// playout delay may absorb that.
enum class DelayKind : std::uint8_t { kPresentation, kNetwork };
// Replacement of a missing update: the last one, or no contact at all.
enum class Conceal : std::uint8_t { kHold, kZero };
// Control of the energy of a delayed force: none beside that of its node, or time-domain passivity with the energy that its
// packets carry.
enum class Passivity : std::uint8_t { kNone, kTdpa };

struct DelayDef {
  double delay_s = 0;
  DelayKind kind = DelayKind::kPresentation;
};
struct RateDef {
  double rate_Hz = 0;
  double phase_s = 0;
};
struct QuantiseDef {
  Quantity quantity = Quantity::kForce;
  double step = 0;   // linear: in the unit of the quantity
  double ratio = 0;  // logarithmic: neighbouring levels differ by this factor, > 1; 0: linear
  double floor = 0;  // logarithmic: the least level above 0
};
// A change of values: gain, bias or low-pass.
struct ValueDef {
  Quantity quantity = Quantity::kForce;
  double value = 0;  // factor, offset in the unit of the quantity, or Hz
};
struct ReorderDef {
  double share = 0;  // share of all items that are held back
  double by_s = 0;
};
// One <degrade>: the operators act in the order of the members.
struct Rule {
  std::string modality;
  // Place in the loop of the modality at which the rule acts, as it declares them (known_modalities.h); empty: its input.
  std::string stage;
  int line = 0;
  // Begin and end of the rule, s of simulated time since the profile came into force.
  double from_s = 0;
  std::optional<double> until_s;
  // Filter; empty: everything. The two bodies in any order; the material of either surface.
  std::string body_a, body_b, material;

  std::optional<QuantiseDef> quantise;
  std::optional<ValueDef> gain, bias, lowpass;
  std::optional<RateDef> rate;
  std::optional<DeadbandDef> deadband;
  std::optional<LossDef> loss;
  std::optional<double> wire_loss;  // share of lost messages; repetitions and pages are drawn separately
  bool off = false;
  std::optional<DelayDef> delay;
  std::optional<JitterDef> jitter;
  std::optional<double> skew;  // the clock of the modality runs slow by this share, so its delay keeps growing
  std::optional<ReorderDef> reorder;
  std::optional<double> duplicate;  // share of items that arrive twice
  std::optional<Conceal> freeze;    // no new messages arrive
  Conceal conceal = Conceal::kHold;
  std::optional<Passivity> passivity;  // of a stage that displays a force
  OutputValues output;  // operators on the output itself: a slow renderer, not a slow network

  bool filtered() const { return !material.empty() || !body_a.empty(); }
};

struct Profile {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<Rule> rules;
};

// A modality and the output operators that its node declares.
struct DeclaredOutput {
  std::string modality;
  std::vector<OutputOperator> operators = {};
};

// Throws std::invalid_argument, "FILE:LINE: reason and remedy", when anything is wrong; then nothing is changed.
// file: the name for messages. No rules: a profile that degrades nothing. own: the modality of the calling node; its operators
// come before those of the tables. Any operator name is accepted for a modality that is in neither, with the value 0.
Profile parse_profile(const std::string& xml, const std::string& file, const DeclaredOutput& own = {});

// A profile in force, and the time since when. Its text is parsed once in a process.
struct ProfileInForce {
  std::string text;  // XML; empty: none
  std::int64_t hash = 0;
  std::int64_t generation = 0;  // larger is newer
  SimTime start{};
  std::shared_ptr<const Profile> parsed;  // null: this process needs no parsed rules
};

// Parses the text: generation 0, in force from the start. Throws as parse_profile does.
ProfileInForce read_profile(std::string xml, const std::string& file);

// Reads an attribute of <degrade> into the rule. Returns false, and changes nothing, when no operator on the stream has this
// name. Throws std::invalid_argument with one sentence.
bool parse_operator(Rule& rule, const std::string& name, const std::string& value);
// A part of a rule that takes one of several names.
struct OperatorChoice {
  std::string name;
  // The operator that it changes: as a word of it, or beside it; empty: the choice is an operator itself.
  std::string of;
  bool is_word = false;
  std::vector<std::string> values;  // the first one changes nothing
};
// All choices.
const std::vector<OperatorChoice>& operator_choices();
// Attributes that a rule may have at a stage of this kind, beside modality, stage, from and until; of the input none are listed, as it takes all
// but passivity.
std::vector<std::string> stage_attributes(StageKind kind);
// Reads an operator on the output into the rule. Throws std::invalid_argument with one sentence.
void parse_output(Rule& rule, const OutputOperator& declared, const std::string& value);

}  // namespace tactus::sync
