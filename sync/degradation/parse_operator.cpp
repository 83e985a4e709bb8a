// Parses the values of the operators of <degrade> in a profile, and of <pass> in relay rules (sync/relay/rules.cpp): a value
// with its unit, then words and name=value pairs in any order. Declared in profile.h. The callers put file and line before
// each message; tests/sync/degradation/ and tests/sync/relay/rules_test.cpp check parts of the messages.
#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "sync/degradation/profile.h"
#include "sync/text/settings.h"

namespace tactus::sync {
namespace {

// A value with a dimension must state its unit, unless it is 0, so that profiles stay readable.
double quantity(std::string_view text, std::string_view unit) {
  const double x = parse_quantity(text, unit);
  double bare = 0;
  const bool has_unit =
      std::from_chars(text.data(), text.data() + text.size(), bare).ptr != text.data() + text.size();
  if (unit != "1" && !has_unit && x != 0)
    throw std::invalid_argument("\"" + std::string(text) +
                                "\" has no unit; write the unit directly after the number, as in " + std::string(text) +
                                std::string(unit));
  return x;
}

// The text of an attribute, e.g. "5% burst=3 network", split into value, words and pairs. The parser of an operator takes each
// part once; a part that remains is an error.
class Words {
 public:
  explicit Words(const std::string& text) {
    std::istringstream in(text);
    std::string word;
    while (in >> word) {
      const std::size_t equals = word.find('=');
      const std::string name = word.substr(0, equals);
      const bool duplicated = equals == std::string::npos
                             ? std::find(words_.begin(), words_.end(), word) != words_.end()
                             : !pairs_.try_emplace(name, word.substr(equals + 1)).second;
      if (duplicated)
        throw std::invalid_argument("\"" + (equals == std::string::npos ? name : name + "=") +
                                    "\" is given twice; remove one");
      if (equals == std::string::npos) words_.push_back(word);
    }
  }

  // The first word as a number in `unit`, from least to most.
  double value(std::string_view unit, double least, double most) {
    if (words_.empty()) throw std::invalid_argument("it needs a value in " + std::string(unit));
    const std::string first = words_.front();
    words_.erase(words_.begin());
    return checked(quantity(first, unit), first, unit, least, most);
  }
  double pair(const std::string& name, std::string_view unit, double otherwise, double least, double most) {
    if (!has(name)) return otherwise;
    const std::string text = pair(name, "");
    return checked(quantity(text, unit), name + "=" + text, unit, least, most);
  }
  std::string pair(const std::string& name, const std::string& otherwise) {
    const auto node = pairs_.extract(name);
    return node ? node.mapped() : otherwise;
  }
  bool has(const std::string& name) const { return pairs_.contains(name); }
  // Returns true and removes the word when it is present.
  bool word(const std::string& name) { return std::erase(words_, name) > 0; }
  // The value of the word that is present, if any.
  template <class Value>
  std::optional<Value> one_of(const std::map<std::string, Value>& choices) {
    std::optional<Value> chosen;
    std::string given_name;
    for (const auto& [name, value] : choices) {
      if (!word(name)) continue;
      if (chosen)
        throw std::invalid_argument("\"" + given_name + "\" and \"" + name +
                                    "\" contradict each other; remove one");
      chosen = value;
      given_name = name;
    }
    return chosen;
  }
  void expect_end() const {
    if (!words_.empty()) throw std::invalid_argument("\"" + words_.front() + "\" is not valid here");
    if (!pairs_.empty()) throw std::invalid_argument("\"" + pairs_.begin()->first + "=\" is not valid here");
  }

 private:
  static double checked(double x, const std::string& text, std::string_view unit, double least, double most) {
    if (x < least || x > most) {
      std::ostringstream message;
      message << text << " must be between " << least << " and " << most;
      if (unit != "1") message << " " << unit;
      throw std::invalid_argument(message.str());
    }
    return x;
  }
  std::vector<std::string> words_;
  std::map<std::string, std::string> pairs_;
};

constexpr double kLongest_s = 60;  // design: an output more than a minute late is a separate event
constexpr double kLargest = 1e9;

const std::map<std::string, Quantity> kQuantities{
    {"force", Quantity::kForce}, {"velocity", Quantity::kVelocity}, {"position", Quantity::kPosition}};
const std::map<std::string, DelayKind> kDelayKinds{{"presentation", DelayKind::kPresentation},
                                                   {"network", DelayKind::kNetwork}};
const std::map<std::string, JitterShape> kShapes{
    {"uniform", JitterShape::kUniform}, {"normal", JitterShape::kNormal}, {"pareto", JitterShape::kPareto}};
const std::map<std::string, bool> kTruths{{"true", true}, {"false", false}};
const std::map<std::string, Conceal> kConceals{{"hold", Conceal::kHold}, {"zero", Conceal::kZero}};
const std::map<std::string, Passivity> kPassivities{{"none", Passivity::kNone}, {"tdpa", Passivity::kTdpa}};
const std::map<std::string, Predictor> kPredictors{{"hold", Predictor::kHold}, {"linear", Predictor::kLinear}};

// The names, that of the value which changes nothing first.
template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& choices, Value neutral) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.insert(value == neutral ? names.begin() : names.end(), name);
  return names;
}

std::string_view unit_of(Quantity q) {
  return q == Quantity::kForce ? "N" : q == Quantity::kVelocity ? "m/s" : "m";
}

template <class Value>
Value chosen(Words& w, const std::map<std::string, Value>& choices, const char* remedy) {
  if (const auto value = w.one_of(choices)) return *value;
  throw std::invalid_argument(remedy);
}
Conceal conceal_of(Words& w) { return chosen(w, kConceals, "choose hold or zero"); }

QuantiseDef quantise(Words& w) {
  QuantiseDef d;
  d.quantity = w.one_of(kQuantities).value_or(Quantity::kForce);
  if (w.word("log")) {
    d.ratio = 1 + w.value("1", 1e-6, 1e3);
    d.floor = w.pair("floor", unit_of(d.quantity), 1e-3, 1e-12, kLargest);
  } else {
    d.step = w.value(unit_of(d.quantity), 1e-12, kLargest);
  }
  return d;
}

ValueDef changed(Words& w, std::string_view unit, double least, double most) {
  ValueDef d;
  d.quantity = w.one_of(kQuantities).value_or(Quantity::kForce);
  d.value = w.value(unit.empty() ? unit_of(d.quantity) : unit, least, most);
  return d;
}

DeadbandDef deadband(Words& w) {
  DeadbandDef d;
  d.quantity = w.one_of(kQuantities).value_or(Quantity::kVelocity);
  d.fraction = w.value("1", 0, 10);
  d.floor = w.pair("floor", unit_of(d.quantity), 0, 0, kLargest);
  d.lowpass_Hz = w.pair("lowpass", "Hz", 0, 0, 1e4);
  d.adaptive_s_m = w.pair("adaptive", "s/m", 0, 0, 1e3);
  d.resend_s = w.pair("resend", "s", 0, 0, kLongest_s);
  const std::string predict = w.pair("predict", "hold");
  if (!kPredictors.contains(predict)) throw std::invalid_argument("predict=" + predict + ": choose hold or linear");
  d.predictor = kPredictors.at(predict);
  // The receiver has the values as sent, without this filter, so its line would be another one than that of the sender.
  if (d.predictor == Predictor::kLinear && d.lowpass_Hz > 0)
    throw std::invalid_argument("predict=linear follows the values as sent; remove lowpass= here and give the "
                                "attribute lowpass of the <degrade> instead");
  return d;
}

LossDef loss(Words& w) {
  LossDef d;
  d.share = w.value("1", 0, 1);
  d.mean_burst = w.pair("burst", "1", 0, 1, 1e6);
  const Loss possible(d);  // throws
  return d;
}

DelayDef delay(Words& w) {
  DelayDef d;
  d.kind = w.one_of(kDelayKinds).value_or(DelayKind::kPresentation);
  d.delay_s = w.value("s", 0, kLongest_s);
  return d;
}

std::vector<double> delays_of_trace(const std::string& trace) {
  std::vector<double> delays_s;
  std::istringstream values(trace + ",");
  for (std::string value; std::getline(values, value, ',');) {
    delays_s.push_back(quantity(value, "s"));
    if (delays_s.back() < 0 || delays_s.back() > kLongest_s)
      throw std::invalid_argument("the delays of a trace must be between 0 and 60 s");
  }
  return delays_s;
}

JitterDef jitter(Words& w) {
  JitterDef d;
  const auto shape = w.one_of(kShapes);
  d.shape = shape.value_or(JitterShape::kUniform);
  d.correlation = w.pair("correlation", "1", 0, 0, 0.999999);
  const std::string order = w.pair("order", "keep");
  if (order != "keep" && order != "free") throw std::invalid_argument("order=" + order + ": choose keep or free");
  d.keep_order = order == "keep";
  if (!w.has("trace")) {
    d.scale_s = w.value("s", 0, kLongest_s);
    return d;
  }
  if (shape || d.correlation != 0)
    throw std::invalid_argument("a trace already defines shape and correlation; remove them");
  d.shape = JitterShape::kTrace;
  d.trace_s = delays_of_trace(w.pair("trace", ""));
  return d;
}

using Fill = std::function<void(Rule&, Words&)>;
const std::map<std::string, Fill>& operators() {
  static const std::map<std::string, Fill> table{
      {"quantise", [](Rule& r, Words& w) { r.quantise = quantise(w); }},
      {"gain", [](Rule& r, Words& w) { r.gain = changed(w, "1", -1e3, 1e3); }},
      {"bias", [](Rule& r, Words& w) { r.bias = changed(w, "", -kLargest, kLargest); }},
      {"lowpass", [](Rule& r, Words& w) { r.lowpass = changed(w, "Hz", 1e-3, 1e4); }},
      {"rate",
       [](Rule& r, Words& w) {
         r.rate = {w.value("Hz", 0.01, 1e4), w.pair("phase", "s", 0, 0, kLongest_s)};
       }},
      {"deadband", [](Rule& r, Words& w) { r.deadband = deadband(w); }},
      {"loss", [](Rule& r, Words& w) { r.loss = loss(w); }},
      {"wire_loss", [](Rule& r, Words& w) { r.wire_loss = w.value("1", 0, 1); }},
      {"off", [](Rule& r, Words& w) { r.off = chosen(w, kTruths, "choose true or false"); }},
      {"delay", [](Rule& r, Words& w) { r.delay = delay(w); }},
      {"jitter", [](Rule& r, Words& w) { r.jitter = jitter(w); }},
      {"skew", [](Rule& r, Words& w) { r.skew = w.value("1", 0, 0.01); }},
      {"reorder", [](Rule& r, Words& w) { r.reorder = {w.value("1", 0, 1), w.pair("by", "s", 0.01, 0, kLongest_s)}; }},
      {"duplicate", [](Rule& r, Words& w) { r.duplicate = w.value("1", 0, 1); }},
      {"freeze", [](Rule& r, Words& w) { r.freeze = conceal_of(w); }},
      {"conceal", [](Rule& r, Words& w) { r.conceal = conceal_of(w); }},
      {"passivity", [](Rule& r, Words& w) { r.passivity = chosen(w, kPassivities, "choose none or tdpa"); }},
      {"from", [](Rule& r, Words& w) { r.from_s = w.value("s", 0, 1e6); }},
      {"until", [](Rule& r, Words& w) { r.until_s = w.value("s", 0, 1e6); }},
  };
  return table;
}

template <class Parse>
void parse_words(const std::string& name, const std::string& value, Parse parse) {
  try {
    Words words(value);
    parse(words);
    words.expect_end();
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(name + "=\"" + value + "\": " + e.what());
  }
}

}  // namespace

bool parse_operator(Rule& rule, const std::string& name, const std::string& value) {
  const auto it = operators().find(name);
  if (it == operators().end()) return false;
  parse_words(name, value, [&](Words& words) { it->second(rule, words); });
  return true;
}

const std::vector<OperatorChoice>& operator_choices() {
  static const std::vector<OperatorChoice> all{{"predict", "deadband", true, names_of(kPredictors, Predictor::kHold)},
                                               {"passivity", "", false, names_of(kPassivities, Passivity::kNone)},
                                               {"conceal", "loss", false, names_of(kConceals, Conceal::kHold)}};
  return all;
}

void parse_output(Rule& rule, const OutputOperator& declared, const std::string& value) {
  parse_words(declared.name, value, [&](Words& words) {
    rule.output.set(declared.name, words.value(declared.unit, declared.min, declared.max), declared.combine);
    for (const OutputPair& pair : declared.pairs)
      rule.output.set(declared.name + "." + pair.name,
                      words.pair(pair.name, pair.unit, pair.initial, pair.min, pair.max), declared.combine);
  });
  for (const OutputPair& pair : declared.pairs)
    if (!pair.too_small.empty() && rule.output.value(declared.name) >= rule.output.value(declared.name + "." + pair.name))
      throw std::invalid_argument(pair.too_small);
}

}  // namespace tactus::sync
