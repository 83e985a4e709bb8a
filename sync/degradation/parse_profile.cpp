// Parses the elements and rules of a profile, declared in profile.h; parse_operator.cpp parses the values of operators.
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "sync/degradation/known_modalities.h"
#include "sync/degradation/profile.h"
#include "sync/text/xml_reason.h"

namespace tactus::sync {
namespace {

using Element = tinyxml2::XMLElement;
constexpr std::size_t kMaxRules = 64;  // design: a chain that a person can still understand

struct Attribute {
  std::string name, value;
};

const OutputOperator* find(const std::vector<OutputOperator>& operators, const std::string& name) {
  const auto it = std::find_if(operators.begin(), operators.end(), [&](const OutputOperator& o) { return o.name == name; });
  return it == operators.end() ? nullptr : &*it;
}

// A rule for an unknown modality can name any output operator; the node of the modality reports the operators that it does not
// have.
void read_output(Rule& rule, const Attribute& a, const DeclaredOutput& own) {
  const OutputOperator* anywhere = find_output_operator(a.name);
  const KnownModality* known = known_modality(rule.modality);
  if (const auto* declared = rule.modality == own.modality ? find(own.operators, a.name) : nullptr) {
    parse_output(rule, *declared, a.value);
  } else if (const auto* here = known ? find(known->operators, a.name) : nullptr) {
    parse_output(rule, *here, a.value);
  } else if (known && anywhere) {
    throw std::invalid_argument(rule.modality + " has no " + a.name + ", which only " + modalities_with(a.name) + " has");
  } else if (known) {
    throw std::invalid_argument("there is no operator \"" + a.name + "\"");
  } else if (anywhere) {
    parse_output(rule, *anywhere, a.value);
  } else {
    rule.output.set(a.name, 0);
  }
}

const char* name_of(Quantity q) {
  return q == Quantity::kForce ? "force" : q == Quantity::kVelocity ? "velocity" : "position";
}

std::string milliseconds(double t_s, int digits = 3) {
  std::ostringstream text;
  text.precision(digits);
  text << t_s * 1e3 << "ms";
  return text.str();
}

// Throws when a jitter would not have its mean and its deviation.
void check_jitter(const Rule& rule) {
  if (!rule.jitter) return;
  const double needed_s = needed_delay_s(*rule.jitter), delay_s = rule.delay ? rule.delay->delay_s : 0;
  if (delay_s >= needed_s * (1 - 1e-6)) return;  // both were rounded
  const std::string needed = milliseconds(needed_s, 6);
  const DelayMoments cut = moments_cut_at_zero(*rule.jitter);
  const bool normal = rule.jitter->shape == JitterShape::kNormal;
  throw std::invalid_argument(
      "a jitter varies the delay of its own <degrade>, and nothing can be presented before it arrives: give a delay of at least " +
      needed + ", " + (normal ? "three standard deviations" : "the half width of the jitter") + ", for example delay=\"" +
      needed + " network\"; without a delay it would add " + milliseconds(cut.mean_s) +
      " on average, with a standard deviation of only " + milliseconds(cut.sd_s));
}

// Throws when an operator acts on a quantity that the modality does not receive.
void check_quantities(const Rule& rule) {
  const KnownModality* known = known_modality(rule.modality);
  if (!known) return;
  const auto check = [&](const char* name, const auto& given) {
    if (!given) return;
    for (const WithoutEffect& w : known->without_effect)
      if (w.name == name && w.quantity == given->quantity)
        throw std::invalid_argument(std::string(name) + " of " + name_of(w.quantity) + " has no effect on " + rule.modality +
                                    ": " + w.reason);
  };
  check("quantise", rule.quantise);
  check("gain", rule.gain);
  check("bias", rule.bias);
  check("lowpass", rule.lowpass);
  check("deadband", rule.deadband);
}

// Attributes of a rule at a stage of each kind, beside modality, stage, from and until.
constexpr std::array kOfMessages{"delay", "jitter", "rate", "loss", "off", "deadband"};
constexpr std::array kOfSignal{"delay", "jitter", "rate", "loss",    "off",   "freeze",
                               "conceal", "gain", "lowpass", "quantise", "deadband"};
constexpr std::array kOfDisplay{"delay",   "jitter", "rate",    "loss",     "off",      "freeze",
                                "conceal", "gain",   "lowpass", "quantise", "deadband", "passivity"};

template <std::size_t kCount>
void check_attribute(const std::array<const char*, kCount>& valid, const StageDef& stage, const std::string& name) {
  if (name == "modality" || name == "stage" || name == "from" || name == "until") return;
  if (std::find(valid.begin(), valid.end(), name) != valid.end()) return;
  std::string choices;
  for (const char* other : valid) choices += (choices.empty() ? "" : ", ") + std::string(other);
  throw std::invalid_argument("the stage " + stage.name + " has no " + name + "; choose from " + choices);
}

// A value that ends changes by as much as itself: a wider band would hold it, or the motion, for ever.
void check_band(const Rule& rule) {
  if (rule.deadband && rule.deadband->fraction >= 1 && rule.deadband->resend_s <= 0)
    throw std::invalid_argument("deadband: with 100 % or more the end of a force or a motion is never sent; give less, or resend=");
}

// A signal of a stage is a force, and its newest sample counts.
void check_signal(const Rule& rule, const StageDef& stage) {
  const auto check = [&](const char* name, const auto& given) {
    if (given && given->quantity != Quantity::kForce)
      throw std::invalid_argument(std::string(name) + ": the signal of the stage " + stage.name + " is a force; write " + name +
                                  "=\"... force\"");
  };
  check("quantise", rule.quantise);
  check("gain", rule.gain);
  check("lowpass", rule.lowpass);
  check("deadband", rule.deadband);
  if (rule.jitter && !rule.jitter->keep_order)
    throw std::invalid_argument("order=free: the newest sample of a signal counts; remove it");
}

// The receiver of messages reconstructs a motion from those that are sent.
void check_messages(const Rule& rule, const StageDef& stage) {
  if (rule.deadband && rule.deadband->quantity == Quantity::kForce)
    throw std::invalid_argument("deadband: the stage " + stage.name +
                                " transmits a motion; name velocity or position");
}

// Operators that need a stage: the input of a modality has no receiver that predicts, and displays no force.
void check_input(const Rule& rule) {
  if (rule.deadband && rule.deadband->predictor == Predictor::kLinear)
    throw std::invalid_argument("predict=linear needs a receiver that predicts; name a stage beside the input, for example stage=\"force\"");
  if (rule.passivity)
    throw std::invalid_argument("passivity controls a force that is displayed late; give stage=\"force\"");
}

// Checks stage= of a rule, and the attributes that the stage permits. The stage of the input is stored as no stage.
void check_stage(Rule& rule, const Element& e) {
  if (!e.Attribute("stage")) return;
  const KnownModality* known = known_modality(rule.modality);
  if (!known || known->stages.empty())
    throw std::invalid_argument(rule.modality + " has no stages; remove stage=, or name a modality that has them: " +
                                modalities_with_stages());
  std::string names;
  const StageDef* stage = nullptr;
  for (const StageDef& s : known->stages) {
    names += (names.empty() ? "" : ", ") + s.name;
    if (s.name == rule.stage) stage = &s;
  }
  if (!stage) throw std::invalid_argument(rule.modality + " has no stage \"" + rule.stage + "\"; choose from " + names);
  if (stage->kind == StageKind::kInput) {
    rule.stage.clear();
    return;
  }
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next())
    stage->kind == StageKind::kMessages  ? check_attribute(kOfMessages, *stage, a->Name())
    : stage->kind == StageKind::kDisplay ? check_attribute(kOfDisplay, *stage, a->Name())
                                         : check_attribute(kOfSignal, *stage, a->Name());
  stage->kind == StageKind::kMessages ? check_messages(rule, *stage) : check_signal(rule, *stage);
  check_band(rule);
  const double delay_s = (rule.delay ? rule.delay->delay_s : 0) + (rule.jitter ? needed_delay_s(*rule.jitter) : 0);
  if (stage->max_delay_s > 0 && delay_s > stage->max_delay_s)
    throw std::invalid_argument("delay and jitter of the stage " + stage->name + " add up to more than " +
                                milliseconds(stage->max_delay_s, 6) + "; make them shorter");
}

Rule parse_rule(const Element& e, const DeclaredOutput& own) {
  Rule rule;
  rule.line = e.GetLineNum();
  int operators = 0;
  std::vector<Attribute> of_output;
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name(), value = a->Value();
    if (name == "modality") {
      rule.modality = value;
    } else if (name == "stage") {
      rule.stage = value;
    } else if (name == "material") {
      rule.material = value;
      if (value.empty()) throw std::invalid_argument("material=\"\" names no material; remove it, or name one");
    } else if (name == "bodies") {
      std::istringstream two(value);
      std::string rest;
      if (!(two >> rule.body_a >> rule.body_b) || two >> rest)
        throw std::invalid_argument("bodies=\"" + value + "\": name two bodies, with a blank between them");
    } else {
      if (!parse_operator(rule, name, value)) of_output.push_back({name, value});
      operators += name != "from" && name != "until" && name != "conceal";
    }
  }
  if (rule.modality.empty())
    throw std::invalid_argument("a <degrade> needs a modality, for example modality=\"audio\"");
  if (operators == 0)
    throw std::invalid_argument("this <degrade> does nothing; give it an operator, for example delay=\"40ms\"");
  if (rule.until_s && *rule.until_s <= rule.from_s) throw std::invalid_argument("until must be after from");
  check_stage(rule, e);
  for (const Attribute& a : of_output) read_output(rule, a, own);
  check_jitter(rule);
  if (rule.stage.empty()) check_input(rule);
  if (rule.stage.empty()) check_quantities(rule);
  return rule;
}

std::uint64_t seed_of(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument("seed=\"" + text + "\" is not a whole number from 0 to 18446744073709551615");
  return seed;
}

// A profile is always read as UTF-8, so another declared encoding is refused.
bool says_another_encoding(std::string declaration) {
  std::transform(declaration.begin(), declaration.end(), declaration.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return declaration.find("encoding") != std::string::npos && declaration.find("utf-8") == std::string::npos &&
         declaration.find("us-ascii") == std::string::npos;
}

// An element may contain only elements and comments.
void refuse_other_than_elements(const tinyxml2::XMLNode& within, const std::string& message, int& line) {
  for (const tinyxml2::XMLNode* n = within.FirstChild(); n; n = n->NextSibling()) {
    if (n->ToElement() || n->ToComment()) continue;
    line = n->GetLineNum();
    throw std::invalid_argument(message);
  }
}

// A file may contain only its declaration, comments and one root.
void refuse_more_than_root(const tinyxml2::XMLDocument& document, const tinyxml2::XMLElement* root, int& line) {
  for (const tinyxml2::XMLNode* n = document.FirstChild(); n; n = n->NextSibling()) {
    line = n->GetLineNum();
    if (n->ToDeclaration() && says_another_encoding(n->Value()))
      throw std::invalid_argument("a profile must be UTF-8; save it as UTF-8 and remove its encoding declaration");
    if (n == root || n->ToComment() || n->ToDeclaration()) continue;
    throw std::invalid_argument(n->ToElement()
                                    ? "a file holds one <profile> and nothing after it; put all <degrade> into it"
                                    : "only <profile> is valid here; remove this element");
  }
}

[[noreturn]] void refuse(const std::string& file, int line, const std::string& reason) {
  throw std::invalid_argument(file + ":" + std::to_string(line) + ": " + reason);
}

}  // namespace

std::vector<std::string> stage_attributes(StageKind kind) {
  switch (kind) {
    case StageKind::kMessages: return {kOfMessages.begin(), kOfMessages.end()};
    case StageKind::kSignal: return {kOfSignal.begin(), kOfSignal.end()};
    case StageKind::kDisplay: return {kOfDisplay.begin(), kOfDisplay.end()};
    case StageKind::kInput: break;
  }
  return {};
}

Profile parse_profile(const std::string& xml, const std::string& file, const DeclaredOutput& own) {
  // XML has none; the text after it would be ignored.
  if (const std::size_t nul = xml.find('\0'); nul != std::string::npos)
    refuse(file,
           1 + static_cast<int>(std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(nul), '\n')),
           "there is a NUL byte here, so this is not text in UTF-8");
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
    refuse(file, document.ErrorLineNum(), "this is not XML: " + xml_reason(document));
  const Element* root = document.RootElement();
  if (!root || std::string(root->Name()) != "profile")
    refuse(file, root ? root->GetLineNum() : 1, "a profile begins with <profile>");
  Profile profile;
  int line = root->GetLineNum();
  try {
    refuse_more_than_root(document, root, line);
    line = root->GetLineNum();
    for (const tinyxml2::XMLAttribute* a = root->FirstAttribute(); a; a = a->Next()) {
      const std::string name = a->Name();
      if (name == "name")
        profile.name = a->Value();
      else if (name != "seed")
        throw std::invalid_argument("<profile> has a name and a seed, no \"" + name + "\"");
      else
        profile.seed = seed_of(a->Value());
    }
    refuse_other_than_elements(*root, "a <profile> holds <degrade .../>, no text; is a \"<\" missing?", line);
    for (const Element* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
      line = e->GetLineNum();
      if (std::string(e->Name()) != "degrade")
        throw std::invalid_argument(std::string("<") + e->Name() +
                                    "> is not known in a profile; it holds <degrade>");
      if (e->FirstChildElement())
        throw std::invalid_argument("a <degrade> has only attributes; remove the elements inside it");
      refuse_other_than_elements(*e, "a <degrade> has only attributes; remove the text inside it", line);
      if (profile.rules.size() == kMaxRules) throw std::invalid_argument("a profile has at most 64 <degrade>");
      profile.rules.push_back(parse_rule(*e, own));
    }
  } catch (const std::invalid_argument& e) {
    refuse(file, line, e.what());
  }
  return profile;
}

}  // namespace tactus::sync
