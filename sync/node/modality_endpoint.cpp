#include "sync/node/modality_endpoint.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/decision_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>

#include "sync/degradation/known_modalities.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kMaxDecisions = 8192;
constexpr std::size_t kDecisionsPerMessage = 36;     // of 34 bytes each
constexpr Nanoseconds kDecisionPeriod{100'000'000};  // longest wait of decisions that do not fill a message
constexpr Nanoseconds kReportedWithin{100'000'000};  // for presented events, as PresentationMatcher::kReportsWithin

// Output operators of the profile that name this modality but that its node does not declare.
std::vector<std::string> undeclared_operators(const Profile& profile, const NodeDescriptor& d) {
  std::vector<std::string> missing;
  for (const Rule& rule : profile.rules) {
    if (rule.modality != d.modality) continue;
    for (const std::string& name : rule.output.operators())
      if (std::ranges::none_of(d.output_operators, [&](const OutputOperator& o) { return o.name == name; }))
        missing.push_back(name);
  }
  return missing;
}

// The parser of the process has no ranges for the operators of an unknown modality; its node parses the text with its own.
// Throws std::invalid_argument with one sentence.
std::shared_ptr<const Profile> parse_for(const ProfileInForce& profile, const NodeDescriptor& d) {
  if (known_modality(d.modality)) return profile.parsed;
  return std::make_shared<const Profile>(parse_profile(profile.text, "profile", {d.modality, d.output_operators}));
}

}  // namespace

ModalityEndpoint::ModalityEndpoint(Node& node) : ModalityEndpoint(node, node.descriptor()) { observes_ = false; }

ModalityEndpoint::ModalityEndpoint(Node& node, NodeDescriptor observed)
    : node_(node),
      descriptor_(std::move(observed)),
      observes_(true),
      degradations_(node.bus().queue<degradation_t>(channels::kDegradation, 256)),
      playouts_(node.bus().queue<playout_t>(channels::kPlayout, 64)),
      simulation_(node.bus().clocks()),
      playout_(descriptor_.modality),
      reporter_(descriptor_.modality) {
  if (node.options().profile.text.empty()) return;
  apply_profile(node.options().profile);
  receiver_.set_generation(0);
}

ModalityEndpoint::~ModalityEndpoint() { report_effect(); }

void ModalityEndpoint::set_scene(const scene_t& scene, int tool) {
  names_ = {};
  for (const body_def_t& b : scene.bodies) names_.bodies.push_back(b.name);
  for (const material_def_t& m : scene.materials) names_.materials.push_back(m.name);
  operators_.set_scene(names_);
  tool_ = tool;
  set_scene_profile(scene.profile);
}

void ModalityEndpoint::set_scene_profile(const std::string& profile) {
  // A profile from the command line, or one received since then, takes precedence.
  if (!node_.options().profile.text.empty() || receiver_.generation() > 0) return;
  // A scene without a profile removes the profile of the previous scene.
  if (profile.empty() && profile_hash_ == 0) return;
  const std::string text = profile.empty() ? "<profile/>" : profile;
  const std::int64_t hash = fnv1a_64(text.data(), text.size());
  if (hash == profile_hash_) return;
  try {
    apply_profile(read_profile(text, "profile"));
  } catch (const std::invalid_argument& e) {
    std::cerr << node_.descriptor().name << ": refused: " << e.what() << std::endl;
  }
}

void ModalityEndpoint::apply_profile(const ProfileInForce& profile) {
  const NodeDescriptor& d = descriptor_;
  std::shared_ptr<const Profile> shared;
  try {
    shared = parse_for(profile, d);
  } catch (const std::invalid_argument& e) {
    std::cerr << d.name << ": refused: " << e.what() << std::endl;
    return;
  }
  report_effect();
  effect_ = {};
  if (!observes_) node_.set_profile_effect("");
  parsed_ = shared;
  profile_start_ = profile.start;
  for (Stage& stage : stages_) stage = {stage.name, OperatorChain(*shared, d.modality, profile.start, stage.name)};
  const Profile& parsed = *shared;
  operators_ = OperatorChain(parsed, d.modality, profile.start);
  operators_.set_scene(names_);
  for (const auto& stream : streams_) stream->change_profile();
  profile_hash_ = profile.hash;
  profile_name_ = parsed.name;
  node_.set_profile(profile.hash);
  announce_pending_ = profile.generation > 0 || !parsed.rules.empty();
}

void ModalityEndpoint::announce_profile() const {
  std::string stages;
  for (const Stage& stage : stages_)
    if (!stage.operators.empty()) stages += (stages.empty() ? "the stage " : ", ") + stage.name;
  const std::string begin = descriptor_.name + ": profile \"" + profile_name_ + "\"";
  if (observes_ && !stages_.empty()) {
    if (!stages.empty()) std::cerr << begin << ", degrades " << stages << std::endl;
    return;
  }
  const std::string effect = !operators_.empty() ? "degrades this sense" + (stages.empty() ? "" : " and " + stages)
                             : stages.empty()    ? "nothing"
                                                 : "degrades " + stages;
  std::cerr << begin << ", " << effect << std::endl;
  if (observes_) return;
  for (const std::string& name : undeclared_operators(*parsed_, descriptor_))
    std::cerr << begin << ": this sense has no " << name << "; it is left out" << std::endl;
}

void ModalityEndpoint::read_control_messages(HostTime now) {
  const auto same_run = [&](const header_t& h) { return h.run_id == node_.options().run_id; };
  while (const auto m = degradations_.pop())
    if (same_run(m->message.header))
      // A profile with the same text can be received again; its times then count from the new moment.
      if (const auto whole = receiver_.push(m->message)) apply_profile(*whole);
  if (const std::string refusal = receiver_.take_refusal(); !refusal.empty())
    std::cerr << node_.descriptor().name << ": refused: " << refusal << std::endl;
  while (const auto m = playouts_.pop())
    if (same_run(m->message.header)) playout_.push(m->message, std::min(m->arrival, now));
}

void ModalityEndpoint::step(HostTime now) {
  read_control_messages(now);
  if (std::exchange(announce_pending_, false)) announce_profile();
  const auto map = simulation_.map(now);
  const SimTime sim_now = map ? map->to_sim(now) : SimTime{};
  sim_now_ = sim_now;
  const Nanoseconds delay_before = std::exchange(profile_delay_, operators_.presentation_delay(sim_now));
  if (profile_delay_ > delay_before) log_in_flight_delays(now, sim_now);
  output_ = operators_.output(sim_now);
  lockstep_ = map && playout_.lockstep_Hz() > 0 ? std::optional(Lockstep{*map, playout_.lockstep_Hz()}) : std::nullopt;
  serial_delay_ = playout_.step(now) + profile_delay_;
  delay_ = lockstep_ ? now - lockstep_->begin_of_iteration(now - serial_delay_) : serial_delay_;
  const HostTime state_time = lockstep_ ? lockstep_->begin_of_iteration(now) : now;
  for (const auto& stream : streams_) stream->step(*this, now, state_time);
}

ModalityEndpoint::Stage& ModalityEndpoint::stage(const std::string& name) {
  for (Stage& known : stages_)
    if (known.name == name) return known;
  Stage& stage = stages_.emplace_back(Stage{name});
  if (parsed_) stage.operators = OperatorChain(*parsed_, descriptor_.modality, profile_start_, name);
  return stage;
}

ModalityEndpoint::Events& ModalityEndpoint::events(std::size_t capacity) {
  if (events_) return *events_;
  auto slot = std::make_unique<EventSlot>(
      Events(node_.bus().queue<contact_events_t>(channels::kContactEvents, capacity), node_.bus().clocks()));
  events_ = &slot->events;
  streams_.push_back(std::move(slot));
  return *events_;
}

void ModalityEndpoint::EventSlot::step(ModalityEndpoint& endpoint, HostTime now, HostTime) {
  HostTime received = now;  // if reading takes long, this tick also accepts the messages that arrive in the meantime
  while (const auto m = events.received_.pop()) {
    received = std::max(received, m->arrival);
    if (!endpoint.follow(m->message.header, m->message.clock, m->arrival)) continue;
    events.newest_ = std::max(events.newest_, m->arrival);
    events.inbox_.push(m->message, m->arrival, endpoint.operators_, &endpoint.decisions_);
  }
  endpoint.report_dropped(events.inbox_.take_dropped());
  events.inbox_.release(received);
}

void ModalityEndpoint::log_in_flight_delays(HostTime now, SimTime sim_now) {
  const HostTime since = now - serial_delay_ - output_latency_ - kReportedWithin;
  if (!events_) return;
  events_->inbox_.each_newest_first([&](std::int64_t id, HostTime arrival) {
    if (arrival < since) return false;
    DecisionRecord d;
    d.key = static_cast<std::uint64_t>(id);
    d.is_event = true;
    d.time = sim_now - (now - arrival);
    d.decision.release = d.arrival = arrival;
    decisions_.push_back(d);
    return true;
  });
}

HostTime ModalityEndpoint::presentation_of(HostTime happened) const {
  return lockstep_ ? happened + delay_ : playout_.presentation_of(happened, profile_delay_);
}

HostTime ModalityEndpoint::schedule(std::int64_t event_id, HostTime happened) const {
  if (lockstep_) return lockstep_->next_iteration(happened) + serial_delay_;
  if (!playout_.as_soon_as_possible()) return happened + serial_delay_;
  const auto arrived = arrival_of(event_id);
  // `happened` contains the shift of the profile; the event is not ready earlier for that.
  const Nanoseconds shift = events_ ? events_->inbox_.shift_of(event_id) : Nanoseconds(0);
  const HostTime ready = arrived ? *arrived + output_latency_ : happened - shift;
  return std::max(happened - shift, ready) + shift + profile_delay_;
}

HostTime ModalityEndpoint::newest_arrival() const {
  HostTime newest{};
  for (const auto& stream : streams_) newest = std::max(newest, stream->newest_arrival());
  return newest;
}

std::optional<HostTime> ModalityEndpoint::arrival_of(std::int64_t event_id) const {
  return events_ ? events_->inbox_.arrival_of(event_id) : std::nullopt;
}

bool ModalityEndpoint::expects(const contact_event_t& e) const {
  const int expected = descriptor_.expected_events;
  if ((expected & node_health_t::EXPECTS_OWN_TOOL_ONLY) && (tool_ < 0 || e.tool != tool_)) return false;
  return (e.kind == contact_event_t::BEGIN && (expected & node_health_t::EXPECTS_BEGIN)) ||
         (e.kind == contact_event_t::HIT && (expected & node_health_t::EXPECTS_HIT));
}

void ModalityEndpoint::report_dropped(const std::vector<contact_event_t>& dropped) {
  for (const contact_event_t& e : dropped) {
    if (!expects(e)) continue;
    presentation_t r{};
    r.event_id = e.event_id;
    r.part = presentation_t::WHOLE;
    r.scheduled_ns = r.presented_ns = -1;
    r.outcome = presentation_t::DROPPED_BY_PROFILE;
    report(r);
  }
}

void ModalityEndpoint::report(const presentation_t& report) {
  presentation_t r = report;
  const auto arrived = arrival_of(r.event_id);
  r.ready_ns = arrived ? to_ns(*arrived + output_latency_) : -1;
  reporter_.report(r);
  if (report_listener_) report_listener_(r);
}

void ModalityEndpoint::publish(HostTime now) {
  if (observes_)
    decisions_.clear();
  else
    reporter_.publish(node_.bus(), now);
  const bool full = decisions_.size() >= kDecisionsPerMessage ||
                    std::ranges::any_of(stages_, [](const Stage& s) { return s.decisions.size() >= kDecisionsPerMessage; });
  if (!full && now < next_decisions_) return;
  next_decisions_ = now + kDecisionPeriod;
  for (Stage& stage : stages_)
    publish_decisions(descriptor_.modality + ":" + stage.name, stage.decisions, stage.effect, Nanoseconds(0));
  if (observes_) return;
  publish_decisions(descriptor_.modality, decisions_, effect_, profile_delay_);
  effect_.set_wire(operators_.wire_messages(), operators_.wire_lost());
  node_.set_profile_effect(effect_.text());
}

void ModalityEndpoint::publish_decisions(const std::string& name, Decisions& decisions, MeasuredEffect& effect, Nanoseconds delay) {
  if (decisions.size() > kMaxDecisions) decisions.erase(decisions.begin(), decisions.end() - kMaxDecisions);
  degraded_t m{};
  m.header.sim_time_ns = -1;
  m.modality = name;
  m.profile = profile_hash_;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const DecisionRecord& d = decisions[i];
    effect.add(d, delay);
    decision_t out{};
    out.key = static_cast<std::int64_t>(d.key);
    out.is_event = d.is_event ? 1 : 0;
    out.time_ns = to_ns(d.time);
    out.drop_reason = static_cast<std::int8_t>(d.decision.why);
    const Nanoseconds held = d.decision.release - d.arrival + d.decision.shift + delay;
    out.held_ns = d.decision.dropped() ? 0 : std::max<std::int64_t>(0, held.count());
    out.twice = d.decision.duplicated ? 1 : 0;
    m.decisions.push_back(out);
    if (m.decisions.size() < kDecisionsPerMessage && i + 1 < decisions.size()) continue;
    m.count = static_cast<std::int32_t>(m.decisions.size());
    node_.bus().publish(channels::kDegraded, m);
    m.decisions.clear();
  }
  decisions.clear();
}

void ModalityEndpoint::report_effect() {
  const auto print = [&](const std::string& text, const std::string& stage) {
    if (!text.empty())
      std::cerr << descriptor_.name << ": measured effect of the profile \"" << profile_name_ << "\"" << stage << ": " << text << std::endl;
  };
  if (!observes_) print(effect_.text(), "");
  for (const Stage& stage : stages_) print(stage.effect.text(), " at the stage " + stage.name);
}

}  // namespace tactus::sync
