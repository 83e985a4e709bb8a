#include "sim_node/world/simulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lcmtypes/vectors.h"
#include "sim_node/dual/group_bodies.h"
#include "sim_node/model/fingerprint.h"
#include "sim_node/model/finite_motion.h"
#include "sync/time/phases.h"

namespace tactus::sim {

namespace {

constexpr std::size_t kMaxApplied = 12;  // of a touch model, two pages; design: the contacts that a tool message reports
// Margin for forces outside the bounding sphere of a body, m: rounding of the wire format and the motion of one step.
constexpr double kReachMargin_m = 0.02;

std::vector<double> force_reaches_m(const WorldDef& world, MeshTrees& trees) {
  std::vector<double> out = body_radii(world, trees);
  for (double& reach : out) reach += kReachMargin_m;
  return out;
}

}  // namespace

Simulation::Simulation(const WorldDef& world, const Settings& settings)
    : settings_(settings),
      step_(sync::from_seconds(settings.step_s)),
      ids_(0, 0, settings.groups == "dual" ? 2 : 1),  // the other half of the ids is for bodies computed ahead
      trees_(std::make_shared<MeshTrees>()),
      mechanics_(make_mechanics(world, settings, ids_, trees_)),
      game_(world.holes),
      fingerprint_(fingerprint(world, settings)) {
  for (const BodyDef& body : world.bodies) names_.push_back(body.name);
  tools_.reserve(world.tools.size());
  const std::vector<double> reach_m = force_reaches_m(world, *trees_);
  for (std::size_t i = 0; i < world.tools.size(); ++i) {
    const int body = world.tools[i].body;
    tools_.push_back({body, ToolTouch(world, static_cast<int>(i), settings, ids_, *trees_), ToolPush(settings, ids_, reach_m), {},
                      Eigen::Quaterniond(world.bodies[static_cast<std::size_t>(body)].pose.linear()).normalized()});
  }
  for (Tool& tool : tools_)
    tool.touch.set_mobility([this](int body, const Eigen::Vector3d& point, const Eigen::Vector3d& n) {
      return mechanics_->mobility(body, point, n);
    });
  for (const Tool& tool : tools_) models_.push_back(tool.touch.model());
}

void Simulation::start(std::int64_t incarnation) try {
  ids_.restart(incarnation);
  collect_group_tools();
  mechanics_->start(group_tools_, events_);
  const std::span<const BodyMotion> motions = mechanics_->motions();
  for (std::size_t i = 0; i < motions.size(); ++i) sim::require_finite(static_cast<int>(i), motions[i]);
  detect_contacts();
  begin_ = save();
} catch (const StateNotFinite& e) {
  stop_at(e.body, e.quantity);
}

// Of the present state of bodies that move, and of the state of bodies that are computed ahead. Nothing sets a fixed body after the start.
void Simulation::require_finite() {
  const std::span<const BodyMotion> motions = mechanics_->motions();
  double sum = 0;
  for (const BodyMotion& m : motions)
    if (m.inverse_mass_1_kg != 0) sum += sum_of_state(m);
  if (!std::isfinite(sum))
    for (std::size_t i = 0; i < motions.size(); ++i) sim::require_finite(static_cast<int>(i), motions[i]);
  const LookAhead* const ahead = mechanics_->look_ahead();
  if (ahead == nullptr || !ahead->fresh) return;
  for (std::size_t i = 0; i < ahead->bodies.size(); ++i) sim::require_finite(ahead->bodies[i], ahead->motions[i]);
}

void Simulation::stop_at(int body, const char* quantity) const {
  const std::string name = static_cast<std::size_t>(body) < names_.size() ? names_[static_cast<std::size_t>(body)] : std::to_string(body);
  throw std::runtime_error(std::string(quantity) + " of the body " + name + " is not finite after step " + std::to_string(steps_) + ", at " +
                           std::to_string(sync::to_seconds(now().time_since_epoch())) +
                           " s, so the world stops; correct its mass, its shapes or bodies that overlap at the start, or choose a smaller step");
}

void Simulation::sort_messages(std::span<const tool_state_t> messages) {
  for (Tool& tool : tools_) tool.new_messages.clear();
  for (const tool_state_t& m : messages)
    if (static_cast<std::size_t>(m.tool) < tools_.size()) tools_[static_cast<std::size_t>(m.tool)].new_messages.push_back(m);
}

void Simulation::step(std::span<const tool_state_t> messages) try {
  if (held_) {
    for (Tool& tool : tools_) tool.new_messages.clear();
    place_tools(mechanics_->motions());
    held_ = false;
  }
  sort_messages(messages);
  apply_wrenches();
  for (Tool& tool : tools_)
    for (const Push& push : tool.push.step(now(), tool.new_messages, mechanics_->motions()))
      mechanics_->add_force(push.body, push.force_N, push.point_m);
  // Keep the events of the first instant, which are not published yet.
  if (steps_ > 0) events_.clear();
  collect_group_tools();
  mechanics_->tick(now(), group_tools_, events_);
  ++steps_;
  require_finite();
  for (Tool& tool : tools_) tool.push.add_work(mechanics_->motions());
  detect_contacts();
} catch (const StateNotFinite& e) {
  stop_at(e.body, e.quantity);
}

void Simulation::collect_group_tools() {
  group_tools_.clear();
  for (const Tool& tool : tools_)
    if (tool.touch.touches()) group_tools_.push_back(tool.touch.group_tool());
}

void Simulation::update_model(std::size_t tool) {
  tools_[tool].touch.exchange_model(models_[tool]);
  tools_[tool].push.applied_impulses(models_[tool].applied, kMaxApplied);
  models_[tool].applied_count = static_cast<std::int8_t>(models_[tool].applied.size());
}

// Called after each step, and at the first instant.
void Simulation::detect_contacts() {
  tool_contacts_.clear();
  const std::span<BodyMotion> motions = mechanics_->motions();
  place_tools(motions);
  game_.step(now(), motions);
  const sync::ScopedPhaseTimer phase(sync::Phase::kCollision);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    ToolTouch& touch = tools_[i].touch;
    touch.restrict_to(mechanics_->near_tools());
    touch.update(now(), motions, tools_[i].new_messages, events_);
    touch.describe(motions, tool_contacts_);
    update_model(i);
  }
  std::stable_sort(events_.begin(), events_.end(),
                   [](const contact_event_t& a, const contact_event_t& b) { return a.time_ns < b.time_ns; });
}

void Simulation::apply_wrenches() {
  for (Wrench& w : wrenches_) {
    mechanics_->add_wrench(w.body, w.force_N, w.torque_N_m);
    --w.steps;
  }
  std::erase_if(wrenches_, [](const Wrench& w) { return w.steps <= 0; });
}

bool Simulation::push(const Wrench& wrench) {
  if (wrenches_.size() >= kMaxWrenches) return false;
  wrenches_.push_back(wrench);
  return true;
}

void Simulation::set_friction(int body, double friction) {
  mechanics_->apply({.kind = impulse::SceneChange::kFriction, .body = body, .values = {friction, 0, 0}});
  for (Tool& tool : tools_) tool.touch.set_friction(body, friction);
}

void Simulation::hold(std::span<const tool_state_t> messages) {
  sort_messages(messages);
  held_ = true;
  tool_contacts_.clear();
  const std::span<const BodyMotion> now_motions = mechanics_->motions();
  held_motions_.assign(now_motions.begin(), now_motions.end());
  for (BodyMotion& m : held_motions_) m.velocity_m_s = m.spin_rad_s = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].touch.restrict_to(std::nullopt);
    tools_[i].touch.update_at_rest(now(), held_motions_, tools_[i].new_messages);
    tools_[i].push.hold(now(), tools_[i].new_messages, held_motions_);
    update_model(i);
  }
  place_tools(held_motions_);
  for (Tool& tool : tools_) tool.touch.describe(held_motions_, tool_contacts_);
}

void Simulation::place_tools(std::span<BodyMotion> motions) {
  for (Tool& tool : tools_) {
    if (tool.body < 0) continue;
    BodyMotion& m = motions[static_cast<std::size_t>(tool.body)];
    if (!tool.new_messages.empty()) tool.orientation = to_eigen(tool.new_messages.back().proxy.orientation).normalized();
    m.orientation = tool.orientation;
    m.position_m = m.centre_m = tool.touch.proxy();
    m.velocity_m_s = tool.touch.proxy_velocity();
  }
}

}  // namespace tactus::sim
