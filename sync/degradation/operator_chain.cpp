#include "sync/degradation/operator_chain.h"

#include <algorithm>
#include <cmath>

#include "sync/random/keyed_random.h"
#include "sync/degradation/quantise.h"
#include "sync/bus/identity.h"

namespace tactus::sync {
namespace {

// The decision about an item that a random number is drawn for.
enum Draw : std::uint64_t { kLossDraw = 1, kJitterDraw, kReorderDraw, kDuplicateDraw, kWireDraw };

constexpr std::size_t kRememberedValues = 4096;
constexpr std::size_t kMaxStreams = 256;  // more channels, groups and tools than a modality reads
// A larger fall of simulated time means that the world restarted, as in sync/clocks/sim_clock_tracker.h.
constexpr Nanoseconds kMaxStepBack{1'000'000'000};

double slot_s(const RateDef& rate, std::int64_t slot) {
  return static_cast<double>(slot) / rate.rate_Hz + rate.phase_s;
}

// The newest slot that has begun at t_s.
std::int64_t slot_at(const RateDef& rate, double t_s) {
  return static_cast<std::int64_t>(std::floor((t_s - rate.phase_s) * rate.rate_Hz));
}

// A uniform or normal jitter varies a delay by no more than this delay, so that its mean stays 0.
Jitter jitter_of(const Rule& rule) {
  return rule.delay ? Jitter(*rule.jitter, from_seconds(rule.delay->delay_s)) : Jitter(*rule.jitter);
}

}  // namespace

OperatorChain::OperatorChain(const Profile& profile, const std::string& modality, SimTime start, const std::string& stage)
    : start_(start) {
  for (std::size_t i = 0; i < profile.rules.size(); ++i) {
    const Rule& rule = profile.rules[i];
    if (rule.modality != modality || rule.stage != stage) continue;
    // Two modalities, or two rules of one, draw different numbers for the same event.
    Active a{rule, mixed(mixed(profile.seed, fnv1a_32(modality)), i), {}, {}};
    changes_values_ |= rule.quantise || rule.gain || rule.bias || rule.lowpass;
    compares_ |= rule.deadband.has_value();
    rules_.push_back(std::move(a));
  }
}

// Time since the profile came into force, or since a later restart of the world.
double OperatorChain::elapsed_s(SimTime t) const { return to_seconds(start_ - t > kMaxStepBack ? t - SimTime{} : t - start_); }

bool OperatorChain::active_at(const Rule& rule, SimTime t) const {
  const double s = elapsed_s(t);
  return s >= rule.from_s && (!rule.until_s || s < *rule.until_s);
}

OperatorChain::Chain& OperatorChain::chain_of(Active& a, const StreamItem& item) {
  if (a.chains.size() > kMaxStreams) a.chains.clear();
  const auto [it, is_new] = a.chains.try_emplace(item.is_event ? 0 : item.stream);
  Chain& chain = it->second;
  if (is_new || chain.incarnation != item.incarnation || chain.newest - item.time > kMaxStepBack) {
    chain = {};
    chain.incarnation = item.incarnation;
    chain.newest = SimTime::min();
    if (a.rule.loss) chain.loss.emplace(*a.rule.loss);
    if (a.rule.jitter) chain.jitter.emplace(jitter_of(a.rule));
    if (a.rule.deadband) chain.deadband.emplace(*a.rule.deadband);
  }
  chain.newest_before = chain.newest;
  chain.newest = std::max(chain.newest, item.time);
  return chain;
}

bool OperatorChain::applies_to(const Rule& rule, std::int32_t material_a, std::int32_t material_b, std::int32_t body_a,
                     std::int32_t body_b) const {
  const auto named = [](const std::vector<std::string>& names, std::int32_t i, const std::string& name) {
    return i >= 0 && i < static_cast<std::int32_t>(names.size()) && names[static_cast<std::size_t>(i)] == name;
  };
  if (!rule.material.empty() && !named(names_.materials, material_a, rule.material) &&
      !named(names_.materials, material_b, rule.material))
    return false;
  if (rule.body_a.empty()) return true;
  const auto& bodies = names_.bodies;
  return (named(bodies, body_a, rule.body_a) && named(bodies, body_b, rule.body_b)) ||
         (named(bodies, body_a, rule.body_b) && named(bodies, body_b, rule.body_a));
}

// Keeps one snapshot in each slot of simulated time. A tool moves on while the world stands still or is set back: its
// snapshots are then paced by their time of publication.
bool OperatorChain::thinned(const RateDef& rate, Chain& chain, const StreamItem& item) const {
  const std::int64_t slot = slot_at(rate, elapsed_s(item.time));
  const std::int64_t publish_slot = slot_at(rate, static_cast<double>(item.publish_ns) * 1e-9);
  const bool stands = item.time <= chain.newest_before;
  if (slot <= chain.newest_slot && !(stands && publish_slot > chain.newest_publish_slot)) return true;
  chain.newest_slot = std::max(slot, chain.newest_slot);
  chain.newest_publish_slot = publish_slot;
  return false;
}

// Rate, deadband, loss, off, freeze: the operators that drop items. An event that a rate delays is not dropped.
bool OperatorChain::drops(Active& a, Chain& chain, const StreamItem& item, Decision& decision) {
  const Rule& rule = a.rule;
  const auto drop = [&](DropReason why, Conceal conceal) {
    decision.why = why;
    decision.conceal = conceal;
    return true;
  };
  if (rule.off) return drop(DropReason::kOff, Conceal::kZero);
  if (rule.freeze) return drop(DropReason::kFreeze, *rule.freeze);
  if (rule.rate && !item.is_event && thinned(*rule.rate, chain, item)) return drop(DropReason::kRate, Conceal::kHold);
  const bool compared = rule.deadband && (item.has_forces || rule.deadband->quantity != Quantity::kForce);
  if (compared && !item.is_event) {
    decision.begins_prediction = !chain.deadband->has_sent();
    if (!chain.deadband->send(std::max(item.time, item.paced), item.signals, item.speed_m_s)) return drop(DropReason::kDeadband, Conceal::kHold);
  }
  if (chain.loss && chain.loss->lose(uniform(mixed(a.seed, kLossDraw), item.key)))
    return drop(DropReason::kLoss, rule.conceal);
  return false;
}

void OperatorChain::delay_item(Active& a, Chain& chain, const StreamItem& item, Decision& decision) {
  const Rule& rule = a.rule;
  Nanoseconds wait{0};
  if (rule.rate && item.is_event) {
    // The next instant at which the rate releases messages.
    const double t = elapsed_s(item.time);
    const auto slot = static_cast<std::int64_t>(std::ceil((t - rule.rate->phase_s) * rule.rate->rate_Hz));
    wait += std::max(Nanoseconds(0), from_seconds(slot_s(*rule.rate, slot) - t));
  }
  const bool presentation = rule.delay && rule.delay->kind == DelayKind::kPresentation;
  const Nanoseconds delay = rule.delay ? from_seconds(rule.delay->delay_s) : Nanoseconds(0);
  if (!presentation)
    wait += delay;
  else if (rule.filtered() && item.is_event)
    decision.shift += delay;
  if (chain.jitter) {
    // A presentation delay would absorb the jitter of messages, so its jitter shifts the presentation itself.
    (presentation ? decision.shift : wait) += chain.jitter->next(uniform(mixed(a.seed, kJitterDraw), item.key));
    if (presentation) decision.jittered_delay += delay;
    decision.in_order |= chain.jitter->keeps_order();
  }
  decision.release += std::max(Nanoseconds(0), wait);
  if (rule.reorder && uniform(mixed(a.seed, kReorderDraw), item.key) < rule.reorder->share) {
    decision.release += from_seconds(rule.reorder->by_s);
    decision.reordered = true;
  }
  if (rule.duplicate && uniform(mixed(a.seed, kDuplicateDraw), item.key) < *rule.duplicate) decision.duplicated = true;
}

Decision OperatorChain::decide(const StreamItem& item) { return decide(item, nullptr); }

Decision OperatorChain::decide(const StreamItem& item, ForceSample& sample) { return decide(item, &sample); }

Decision OperatorChain::decide(StreamItem item, ForceSample* sample) {
  Decision decision;
  decision.release = item.arrival;
  decision.paced = item.paced;
  Signal force;
  if (sample) item.signals = {&force, 1};
  for (Active& a : rules_) {
    // A snapshot covers many bodies and contacts, so a filtered rule applies only to its values.
    if (!active_at(a.rule, item.time) || (a.rule.filtered() && !item.is_event)) continue;
    if (item.is_event && !applies_to(a.rule, item.material_a, item.material_b, item.body_a, item.body_b)) continue;
    if (sample) {
      degrade(a, *sample, item.time);
      force.value = sample->force_N;
    }
    Chain& chain = chain_of(a, item);
    decision.evaluated = true;
    if (drops(a, chain, item, decision)) return decision;
    delay_item(a, chain, item, decision);
  }
  return decision;
}

bool OperatorChain::lost_on_wire(std::uint64_t message, SimTime now) {
  bool applies = false, lost = false;
  for (const Active& a : rules_) {
    if (!a.rule.wire_loss || !active_at(a.rule, now)) continue;
    applies = true;
    lost |= uniform(mixed(a.seed, kWireDraw), message) < *a.rule.wire_loss;
  }
  wire_messages_ += applies;
  wire_lost_ += lost;
  return lost;
}

Nanoseconds OperatorChain::presentation_delay(SimTime now) const {
  Nanoseconds sum{0};
  for (const Active& a : rules_) {
    if (!active_at(a.rule, now) || a.rule.filtered()) continue;
    if (a.rule.delay && a.rule.delay->kind == DelayKind::kPresentation) sum += from_seconds(a.rule.delay->delay_s);
    if (a.rule.skew) sum += from_seconds(*a.rule.skew * (elapsed_s(now) - a.rule.from_s));
  }
  return sum;
}

OutputValues OperatorChain::output(SimTime now) const {
  OutputValues sum;
  for (const Active& a : rules_)
    if (active_at(a.rule, now)) sum.add(a.rule.output);
  return sum;
}

Nanoseconds OperatorChain::constant_delay(SimTime now) const {
  Nanoseconds sum{0};
  for (const Active& a : rules_)
    if (a.rule.delay && active_at(a.rule, now) && !a.rule.filtered()) sum += from_seconds(a.rule.delay->delay_s);
  return sum;
}

Nanoseconds OperatorChain::usual_delay(SimTime now) const {
  Nanoseconds sum = constant_delay(now);
  for (const Active& a : rules_) {
    if (!active_at(a.rule, now) || a.rule.filtered()) continue;
    if (a.rule.jitter) sum += from_seconds(std::max(needed_delay_s(*a.rule.jitter), a.rule.jitter->scale_s));
    if (a.rule.rate) sum += from_seconds(1 / a.rule.rate->rate_Hz);
  }
  return sum;
}

const DeadbandDef* OperatorChain::deadband(SimTime now) const {
  const DeadbandDef* last = nullptr;
  for (const Active& a : rules_)
    if (a.rule.deadband && active_at(a.rule, now) && !a.rule.filtered()) last = &*a.rule.deadband;
  return last;
}

Passivity OperatorChain::passivity(SimTime now) const {
  Passivity last = Passivity::kNone;
  for (const Active& a : rules_)
    if (active_at(a.rule, now)) last = a.rule.passivity.value_or(last);
  return last;
}

bool OperatorChain::cuts_off(SimTime now) const {
  return std::any_of(rules_.begin(), rules_.end(),
                     [&](const Active& a) { return (a.rule.off || a.rule.freeze) && active_at(a.rule, now); });
}

double OperatorChain::filtered(Active& a, std::int64_t id, int component, double value, double cutoff_Hz, SimTime now) {
  if (a.lowpass.size() > kRememberedValues) a.lowpass.clear();
  const auto [it, is_new] = a.lowpass.try_emplace({id, component}, Filtered{value, now});
  if (it->second.time - now > kMaxStepBack) it->second = {value, now};
  if (!is_new && now > it->second.time) {
    it->second.value = lowpassed(it->second.value, value, cutoff_Hz, to_seconds(now - it->second.time));
    it->second.time = now;
  }
  return it->second.value;
}

void OperatorChain::degrade(Active& a, ForceSample& sample, SimTime t) {
  const Rule& r = a.rule;
  if (const double size = sample.force_N.norm(); r.quantise && size > 0) {
    const double factor = quantised(*r.quantise, size) / size;
    sample.force_N *= factor;
    sample.transient_N *= factor;
  }
  if (r.gain)
    for (Eigen::Vector3d* part : {&sample.force_N, &sample.torque_N_m, &sample.transient_N}) *part *= r.gain->value;
  if (!r.lowpass) return;
  int component = 0;
  for (Eigen::Vector3d* part : {&sample.force_N, &sample.torque_N_m, &sample.transient_N})
    for (double& x : *part) x = filtered(a, 0, component++, x, r.lowpass->value, t);
}

void OperatorChain::degrade_force(ForceSample& sample, SimTime t) {
  for (Active& a : rules_)
    if (active_at(a.rule, t)) degrade(a, sample, t);
}

double OperatorChain::degraded_value(Quantity quantity, std::int64_t id, int component, double value, SimTime t,
                      std::int32_t material_a, std::int32_t material_b, std::int32_t body_a, std::int32_t body_b,
                      SimTime paced) {
  const SimTime now = std::max(t, paced);
  for (Active& a : rules_) {
    const Rule& r = a.rule;
    if (!active_at(r, t) || (r.filtered() && !applies_to(r, material_a, material_b, body_a, body_b))) continue;
    if (r.quantise && r.quantise->quantity == quantity) value = quantised(*r.quantise, value);
    const bool scales_force = r.gain && r.gain->quantity == Quantity::kForce;
    if (r.gain && (r.gain->quantity == quantity || (scales_force && quantity == Quantity::kStiffness))) value *= r.gain->value;
    if (r.bias && r.bias->quantity == quantity) value += r.bias->value;
    if (r.lowpass && r.lowpass->quantity == quantity) value = filtered(a, id, component, value, r.lowpass->value, now);
  }
  return value;
}

}  // namespace tactus::sync
