// The attributes of <degrade>: a value with its unit, then words and name=value pairs in any order.
#include <algorithm>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>

#include "sync/degradation/profile.h"
#include "sync/settings.h"

namespace tactus::sync {
namespace {

// "5% burst=3 network" cut into its value, its words and its pairs; each may be taken once and none may be left.
class Words {
 public:
  explicit Words(const std::string& text) {
    std::istringstream in(text);
    std::string word;
    while (in >> word) {
      const std::size_t equals = word.find('=');
      if (equals != std::string::npos)
        pairs_[word.substr(0, equals)] = word.substr(equals + 1);
      else
        words_.push_back(word);
    }
  }

  // The first word as a number in `unit`, least .. most.
  double value(std::string_view unit, double least, double most) {
    if (words_.empty()) throw std::invalid_argument("it needs a value in " + std::string(unit));
    const std::string first = words_.front();
    words_.erase(words_.begin());
    return checked(parse_quantity(first, unit), first, unit, least, most);
  }
  double pair(const std::string& name, std::string_view unit, double otherwise, double least, double most) {
    const auto it = pairs_.find(name);
    if (it == pairs_.end()) return otherwise;
    const std::string text = it->second;
    pairs_.erase(it);
    return checked(parse_quantity(text, unit), name + "=" + text, unit, least, most);
  }
  std::string pair(const std::string& name, const std::string& otherwise) {
    const auto it = pairs_.find(name);
    if (it == pairs_.end()) return otherwise;
    const std::string text = it->second;
    pairs_.erase(it);
    return text;
  }
  // True when the word is there.
  bool word(const std::string& name) { return std::erase(words_, name) > 0; }
  // Which of the words is there; `otherwise` when none is.
  template <class Value>
  Value one_of(const std::map<std::string, Value>& choices, Value otherwise) {
    for (const auto& [name, value] : choices)
      if (word(name)) return value;
    return otherwise;
  }
  void expect_end() const {
    if (!words_.empty()) throw std::invalid_argument("\"" + words_.front() + "\" means nothing here");
    if (!pairs_.empty()) throw std::invalid_argument("\"" + pairs_.begin()->first + "=\" means nothing here");
  }

 private:
  static double checked(double x, const std::string& text, std::string_view unit, double least, double most) {
    if (x < least || x > most) {
      std::ostringstream why;
      why << text << " must lie between " << least << " and " << most;
      if (unit != "1") why << " " << unit;
      throw std::invalid_argument(why.str());
    }
    return x;
  }
  std::vector<std::string> words_;
  std::map<std::string, std::string> pairs_;
};

constexpr double kLongest_s = 60;  // design: what is later than a minute is another event
constexpr double kLargest = 1e9;

const std::map<std::string, Quantity> kQuantities{
    {"force", Quantity::kForce}, {"velocity", Quantity::kVelocity}, {"position", Quantity::kPosition}};
const std::map<std::string, DelayKind> kDelayKinds{{"presentation", DelayKind::kPresentation},
                                                   {"network", DelayKind::kNetwork}};
const std::map<std::string, JitterShape> kShapes{
    {"uniform", JitterShape::kUniform}, {"normal", JitterShape::kNormal}, {"pareto", JitterShape::kPareto}};
const std::map<std::string, Conceal> kConceals{{"hold", Conceal::kHold}, {"zero", Conceal::kZero}};

std::string_view unit_of(Quantity q) {
  return q == Quantity::kForce ? "N" : q == Quantity::kVelocity ? "m/s" : "m";
}

Conceal conceal_of(Words& w) {
  for (const auto& [name, value] : kConceals)
    if (w.word(name)) return value;
  throw std::invalid_argument("choose hold or zero");
}

QuantiseDef quantise(Words& w) {
  QuantiseDef d;
  d.quantity = w.one_of(kQuantities, Quantity::kForce);
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
  d.quantity = w.one_of(kQuantities, Quantity::kForce);
  d.value = w.value(unit.empty() ? unit_of(d.quantity) : unit, least, most);
  return d;
}

DeadbandDef deadband(Words& w) {
  DeadbandDef d;
  d.quantity = w.one_of(kQuantities, Quantity::kVelocity);
  d.fraction = w.value("1", 0, 10);
  d.floor = w.pair("floor", unit_of(d.quantity), 0, 0, kLargest);
  d.lowpass_Hz = w.pair("lowpass", "Hz", 0, 0, 1e4);
  d.adaptive_s_m = w.pair("adaptive", "s/m", 0, 0, 1e3);
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
  d.kind = w.one_of(kDelayKinds, DelayKind::kPresentation);
  d.delay_s = w.value("s", 0, kLongest_s);
  return d;
}

JitterDef jitter(Words& w) {
  JitterDef d;
  d.shape = w.one_of(kShapes, JitterShape::kUniform);
  d.correlation = w.pair("correlation", "1", 0, 0, 0.999999);
  const std::string order = w.pair("order", "keep");
  if (order != "keep" && order != "free") throw std::invalid_argument("order=" + order + ": choose keep or free");
  d.keep_order = order == "keep";
  const std::string trace = w.pair("trace", "");
  if (trace.empty()) {
    d.scale_s = w.value("s", 0, kLongest_s);
    return d;
  }
  d.shape = JitterShape::kTrace;
  std::istringstream values(trace);
  for (std::string value; std::getline(values, value, ',');) {
    d.trace_s.push_back(parse_quantity(value, "s"));
    if (d.trace_s.back() < 0 || d.trace_s.back() > kLongest_s)
      throw std::invalid_argument("the delays of a trace lie between 0 and 60 s");
  }
  return d;
}

ReorderDef reorder(Words& w) {
  ReorderDef d;
  d.share = w.value("1", 0, 1);
  d.by_s = w.pair("by", "s", 0.01, 0, kLongest_s);
  return d;
}

bool truth(Words& w) {
  if (w.word("true")) return true;
  if (w.word("false")) return false;
  throw std::invalid_argument("choose true or false");
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
      {"off", [](Rule& r, Words& w) { r.off = truth(w); }},
      {"delay", [](Rule& r, Words& w) { r.delay = delay(w); }},
      {"jitter", [](Rule& r, Words& w) { r.jitter = jitter(w); }},
      {"skew", [](Rule& r, Words& w) { r.skew = w.value("1", 0, 0.01); }},
      {"reorder", [](Rule& r, Words& w) { r.reorder = reorder(w); }},
      {"duplicate", [](Rule& r, Words& w) { r.duplicate = w.value("1", 0, 1); }},
      {"freeze", [](Rule& r, Words& w) { r.freeze = conceal_of(w); }},
      {"conceal", [](Rule& r, Words& w) { r.conceal = conceal_of(w); }},
      {"frame_rate", [](Rule& r, Words& w) { r.output.frame_rate_Hz = w.value("Hz", 0.1, 240); }},
      {"resolution", [](Rule& r, Words& w) { r.output.resolution = w.value("1", 0.01, 1); }},
      {"dropout",
       [](Rule& r, Words& w) {
         r.output.dropout_s = w.value("s", 1e-3, 10);
         r.output.dropout_every_s = w.pair("every", "s", 1, 2e-3, kLongest_s);
       }},
      {"force_step", [](Rule& r, Words& w) { r.output.force_step_N = w.value("N", 1e-6, 100); }},
      {"response", [](Rule& r, Words& w) { r.output.response_s = w.value("s", 1e-3, kLongest_s); }},
      {"from", [](Rule& r, Words& w) { r.from_s = w.value("s", 0, 1e6); }},
      {"until", [](Rule& r, Words& w) { r.until_s = w.value("s", 0, 1e6); }},
  };
  return table;
}

}  // namespace

std::vector<std::string> output_operators(const OutputDef& o) {
  std::vector<std::string> names;
  if (o.frame_rate_Hz > 0) names.emplace_back("frame_rate");
  if (o.resolution > 0) names.emplace_back("resolution");
  if (o.dropout_s > 0) names.emplace_back("dropout");
  if (o.force_step_N > 0) names.emplace_back("force_step");
  if (o.response_s > 0) names.emplace_back("response");
  return names;
}

void parse_operator(Rule& rule, const std::string& name, const std::string& value) {
  const auto it = operators().find(name);
  if (it == operators().end()) throw std::invalid_argument("there is no operator \"" + name + "\"");
  Words words(value);
  try {
    it->second(rule, words);
    words.expect_end();
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(name + "=\"" + value + "\": " + e.what());
  }
}

}  // namespace tactus::sync
