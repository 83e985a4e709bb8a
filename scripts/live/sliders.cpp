#include "scripts/live/sliders.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "sync/degradation/known_modalities.h"
#include "sync/degradation/profile.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/text/printable.h"

namespace tactus::live {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kEmptyProfile = "<profile name=\"live page\"/>";
constexpr const char* kChangedSuffix = ", changed in the live page";
// Ranges of moved sliders.
constexpr double kMaxDelay_ms = 2000, kMinRate_Hz = 0.1, kMaxRate_Hz = 1000, kMaxDeadband = 1;

void require_in_range(const char* name, bool in_range) {
  if (!in_range) throw std::invalid_argument(std::string("\"") + name + "\" is out of range; reload the page");
}

const std::string& or_empty(const std::string& profile) {
  static const std::string empty = kEmptyProfile;
  return profile.empty() ? empty : profile;
}

bool has_value(const XMLElement& e, const char* name) { return e.Attribute(name) != nullptr; }

// The key of the sliders of a rule: its modality, and its stage after a colon; the stage of the input has no name.
std::string key_of(const XMLElement& e) {
  const char* const stage = e.Attribute("stage");
  if (stage == nullptr || std::string(stage).empty()) return e.Attribute("modality");
  const sync::KnownModality* known = sync::known_modality(e.Attribute("modality"));
  const bool is_input = known && std::any_of(known->stages.begin(), known->stages.end(), [&](const sync::StageDef& s) {
                          return s.name == stage && s.kind == sync::StageKind::kInput;
                        });
  return e.Attribute("modality") + (is_input ? std::string() : ":" + std::string(stage));
}

// True for a rule that applies at all times and to all contacts.
bool is_unconditional(const XMLElement& e) {
  return !has_value(e, "from") && !has_value(e, "until") && !has_value(e, "bodies") && !has_value(e, "material");
}

XMLElement* first_element(XMLElement& root, const std::string& sense, const char* attribute) {
  for (XMLElement* e = root.FirstChildElement("degrade"); e; e = e->NextSiblingElement("degrade"))
    if (key_of(*e) == sense && is_unconditional(*e) && (attribute == nullptr || has_value(*e, attribute)))
      return e;
  return nullptr;
}

sync::Rule operator_of(const char* name, const XMLElement* e) {
  sync::Rule rule;
  if (e != nullptr) sync::parse_operator(rule, name, e->Attribute(name));
  return rule;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

bool nearly_equal(double a, double b) { return std::abs(a - b) <= 1e-9 + 1e-6 * std::abs(a); }

// False for an element without any operator left, which is not a valid rule.
bool has_operator(const XMLElement& e) {
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next())
    if (const std::string name = a->Name(); name != "modality" && name != "stage" && name != "conceal") return true;
  return false;
}

void set(XMLElement& root, const std::string& sense, const char* attribute, const std::string& value) {
  XMLElement* e = first_element(root, sense, attribute);
  if (value.empty()) {
    if (e == nullptr) return;
    e->DeleteAttribute(attribute);
    if (!has_operator(*e)) root.DeleteChild(e);
    return;
  }
  if (e == nullptr) e = first_element(root, sense, nullptr);
  if (e == nullptr) {
    e = root.InsertNewChildElement("degrade");
    const std::size_t colon = sense.find(':');
    e->SetAttribute("modality", sense.substr(0, colon).c_str());
    if (colon != sense.npos) e->SetAttribute("stage", sense.substr(colon + 1).c_str());
  }
  e->SetAttribute(attribute, value.c_str());
}

void apply_delay(XMLElement& root, const std::string& sense, double delay_ms) {
  XMLElement* const e = first_element(root, sense, "delay");
  const auto old = operator_of("delay", e).delay.value_or(sync::DelayDef{});
  if (nearly_equal(old.delay_s * 1e3, delay_ms)) return;
  require_in_range("delay_ms", delay_ms <= kMaxDelay_ms);
  const char* kind = old.kind == sync::DelayKind::kNetwork ? " network" : "";
  // A jitter that the shorter delay cannot carry ends (sync/random/jitter.h).
  if (e != nullptr && has_value(*e, "jitter") &&
      sync::needed_delay_s(operator_of("jitter", e).jitter.value_or(sync::JitterDef{})) * 1e3 > delay_ms)
    e->DeleteAttribute("jitter");
  set(root, sense, "delay", delay_ms > 0 ? number(delay_ms) + "ms" + kind : "");
}

void apply_rate(XMLElement& root, const std::string& sense, double rate_Hz) {
  const auto old = operator_of("rate", first_element(root, sense, "rate")).rate.value_or(sync::RateDef{});
  if (nearly_equal(old.rate_Hz, rate_Hz)) return;
  require_in_range("rate_Hz", rate_Hz == 0 || (rate_Hz >= kMinRate_Hz && rate_Hz <= kMaxRate_Hz));
  const bool fits = old.phase_s > 0 && old.phase_s * rate_Hz < 1;
  set(root, sense, "rate",
      rate_Hz > 0 ? number(rate_Hz) + "Hz" + (fits ? " phase=" + number(old.phase_s * 1e3) + "ms" : "") : "");
}

void apply_loss(XMLElement& root, const std::string& sense, double loss) {
  const auto old = operator_of("loss", first_element(root, sense, "loss")).loss.value_or(sync::LossDef{});
  if (nearly_equal(old.share, loss)) return;
  // A share that bursts of that length cannot reach becomes independent losses (sync/random/loss.h).
  const bool fits = old.mean_burst >= 1 && old.mean_burst * (1 - loss) > loss;
  set(root, sense, "loss",
      loss > 0 ? number(loss * 100) + "%" + (fits ? " burst=" + number(old.mean_burst) : "") : "");
}

const sync::StageDef* stage_of(const std::string& sense) {
  const std::size_t colon = sense.find(':');
  const sync::KnownModality* known = sync::known_modality(sense.substr(0, colon));
  if (!known || colon == sense.npos) return nullptr;
  const auto it = std::find_if(known->stages.begin(), known->stages.end(), [&](const sync::StageDef& s) { return s.name == sense.substr(colon + 1); });
  return it == known->stages.end() ? nullptr : &*it;
}

bool has_attribute(const sync::StageDef& stage, const std::string& name) {
  const auto attributes = sync::stage_attributes(stage.kind);
  return std::find(attributes.begin(), attributes.end(), name) != attributes.end();
}

// The choices of a stage; the input has none.
std::vector<sync::OperatorChoice> choices_of(const std::string& sense) {
  std::vector<sync::OperatorChoice> mine;
  if (const sync::StageDef* stage = stage_of(sense))
    for (const sync::OperatorChoice& c : sync::operator_choices())
      if (has_attribute(*stage, c.is_word ? c.of : c.name)) mine.push_back(c);
  return mine;
}
bool has_deadband(const std::string& sense) {
  const sync::StageDef* stage = stage_of(sense);
  return stage && has_attribute(*stage, "deadband");
}

std::string written(const sync::DeadbandDef& d) {
  const char* const unit = d.quantity == sync::Quantity::kForce ? "N" : d.quantity == sync::Quantity::kVelocity ? "m/s" : "m";
  std::string text = number(100 * d.fraction) + "% " +
                     (d.quantity == sync::Quantity::kForce ? "force" : d.quantity == sync::Quantity::kVelocity ? "velocity" : "position");
  if (d.floor > 0) text += " floor=" + number(d.floor) + unit;
  if (d.adaptive_s_m > 0) text += " adaptive=" + number(d.adaptive_s_m) + "s/m";
  if (d.predictor == sync::Predictor::kLinear) text += " predict=linear";
  // A line follows the values as sent (sync/degradation/parse_operator.cpp).
  else if (d.lowpass_Hz > 0) text += " lowpass=" + number(d.lowpass_Hz) + "Hz";
  if (d.resend_s > 0) text += " resend=" + number(1e3 * d.resend_s) + "ms";
  return text;
}

// The deadband and the words of it that are choices.
void apply_deadband(XMLElement& root, const std::string& sense, const Sliders& s) {
  if (!has_deadband(sense)) return;
  const auto old = operator_of("deadband", first_element(root, sense, "deadband")).deadband;
  const auto predict = s.choices.find("predict");
  sync::DeadbandDef d = old.value_or(sync::DeadbandDef{});
  if (!old) d.quantity = stage_of(sense)->kind == sync::StageKind::kMessages ? sync::Quantity::kVelocity : sync::Quantity::kForce;
  const sync::Predictor predictor = predict == s.choices.end() ? d.predictor : predict->second == "linear" ? sync::Predictor::kLinear : sync::Predictor::kHold;
  const double fraction = s.deadband.value_or(d.fraction);
  if (nearly_equal(d.fraction, fraction) && (d.predictor == predictor || !old)) return;
  require_in_range("deadband", nearly_equal(d.fraction, fraction) || fraction <= kMaxDeadband);
  const bool ends = s.deadband && fraction == 0 && d.fraction > 0;
  d.fraction = fraction;
  d.predictor = predictor;
  set(root, sense, "deadband", ends ? "" : written(d));
}

// The choices that are attributes of their own.
void apply_choices(XMLElement& root, const std::string& sense, const Sliders& s) {
  for (const sync::OperatorChoice& c : choices_of(sense)) {
    const auto value = s.choices.find(c.name);
    if (c.is_word || value == s.choices.end()) continue;
    const XMLElement* const e = first_element(root, sense, c.name.c_str());
    if (value->second == (e ? e->Attribute(c.name.c_str()) : c.values.front())) continue;
    // Beside an operator that is absent, it would have no effect.
    if (!c.of.empty() && first_element(root, sense, c.of.c_str()) == nullptr) continue;
    set(root, sense, c.name.c_str(), value->second == c.values.front() ? "" : value->second);
  }
}

// Parses the document and returns the name of the profile.
std::string parse(tinyxml2::XMLDocument& document, const std::string& profile) {
  const std::string& text = or_empty(profile);
  const std::string name = sync::parse_profile(text, "the profile in force").name;
  document.Parse(text.data(), text.size());
  return name;
}

// True for an attribute that a control beside delay, rate and loss shows.
bool is_shown(const std::string& sense, const std::string& attribute) {
  const auto choices = choices_of(sense);
  return (attribute == "deadband" && has_deadband(sense)) ||
         std::any_of(choices.begin(), choices.end(), [&](const sync::OperatorChoice& c) { return !c.is_word && c.name == attribute; });
}

// The choices of a sense in a profile.
std::map<std::string, std::string> chosen_in(XMLElement& root, const std::string& sense) {
  std::map<std::string, std::string> chosen;
  for (const sync::OperatorChoice& c : choices_of(sense)) {
    chosen[c.name] = c.values.front();
    const XMLElement* const e = first_element(root, sense, (c.is_word ? c.of : c.name).c_str());
    if (e == nullptr) continue;
    if (!c.is_word)
      chosen[c.name] = e->Attribute(c.name.c_str());
    else if (operator_of("deadband", e).deadband->predictor == sync::Predictor::kLinear)
      chosen[c.name] = "linear";
  }
  return chosen;
}

struct SliderState {
  Sliders sliders;
  bool more = false;  // as in degradation_json
};

std::map<std::string, SliderState> slider_states(XMLElement& root) {
  std::map<std::string, int> elements;
  std::map<std::string, SliderState> out;
  for (XMLElement* e = root.FirstChildElement("degrade"); e; e = e->NextSiblingElement("degrade")) {
    const std::string sense = key_of(*e);
    SliderState& s = out[sense];
    s.more = s.more || ++elements[sense] > 1 || !is_unconditional(*e);
    for (const tinyxml2::XMLAttribute* a = e->FirstAttribute(); a; a = a->Next())
      if (const std::string name = a->Name();
          name != "modality" && name != "stage" && name != "delay" && name != "rate" && name != "loss" && !is_shown(sense, name))
        s.more = true;
  }
  for (auto& [sense, s] : out) {
    const auto delay = operator_of("delay", first_element(root, sense, "delay")).delay;
    const auto rate = operator_of("rate", first_element(root, sense, "rate")).rate;
    const auto loss = operator_of("loss", first_element(root, sense, "loss")).loss;
    s.sliders = {delay ? delay->delay_s * 1e3 : 0, rate ? rate->rate_Hz : 0, loss ? loss->share : 0};
    const auto deadband = has_deadband(sense) ? operator_of("deadband", first_element(root, sense, "deadband")).deadband : std::nullopt;
    s.sliders.deadband = deadband ? deadband->fraction : 0;
    s.sliders.choices = chosen_in(root, sense);
  }
  return out;
}

}  // namespace

nlohmann::json degradation_json(const std::string& profile) {
  tinyxml2::XMLDocument document;
  const std::string name = parse(document, profile);
  nlohmann::json senses = nlohmann::json::object();
  for (const auto& [sense, s] : slider_states(*document.RootElement()))
    senses[sync::printable(sense)] = {{"delay_ms", s.sliders.delay_ms},
                                      {"rate_Hz", s.sliders.rate_Hz},
                                      {"loss", s.sliders.loss},
                                      {"deadband", *s.sliders.deadband},
                                      {"choices", s.sliders.choices},
                                      {"more", s.more}};
  nlohmann::json stages = nlohmann::json::array(), controls = nlohmann::json::object();
  for (const sync::KnownModality& m : sync::known_modalities())
    for (const sync::StageDef& s : m.stages) {
      if (s.kind == sync::StageKind::kInput) continue;
      const std::string sense = m.name + ":" + s.name;
      stages.push_back(sense);
      nlohmann::json choices = nlohmann::json::array();
      for (const sync::OperatorChoice& c : choices_of(sense)) choices.push_back({{"name", c.name}, {"of", c.of}, {"values", c.values}});
      controls[sense] = {{"deadband", has_deadband(sense)}, {"choices", choices}};
    }
  return {{"name", sync::printable(profile.empty() ? "" : name)}, {"senses", senses}, {"stages", stages}, {"controls", controls}};
}

std::string with_sliders(const std::string& profile, const std::map<std::string, Sliders>& senses) {
  tinyxml2::XMLDocument document;
  parse(document, profile);
  XMLElement& root = *document.RootElement();
  for (const auto& [sense, s] : senses) {
    apply_delay(root, sense, s.delay_ms);
    apply_rate(root, sense, s.rate_Hz);
    apply_loss(root, sense, s.loss);
    apply_deadband(root, sense, s);
    apply_choices(root, sense, s);
  }
  const std::string name = root.Attribute("name") ? root.Attribute("name") : "";
  if (!name.ends_with("live page")) root.SetAttribute("name", (name + kChangedSuffix).c_str());
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  std::string text = printer.CStr();
  if (text.size() > sync::kMaxProfileBytes)
    throw std::invalid_argument(
        "the profile in force is too long to be changed by sliders; choose \"all well\", or give a shorter one");
  sync::parse_profile(text, "the page's sliders");
  return text;
}

}  // namespace tactus::live
