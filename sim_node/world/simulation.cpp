#include "sim_node/world/simulation.h"

#include <algorithm>

#include "lcmtypes/vectors.h"
#include "sim_node/dual/group_bodies.h"
#include "sim_node/model/fingerprint.h"
#include "sync/time/phases.h"

namespace tactus::sim {

namespace {

constexpr std::size_t kMaxBooks = 14;  // of a touch model; design: more than a message tells the simulation of
// A force may act so far outside the sphere around a body, m: the rounding of the wire and a step's motion.
constexpr double kBeyond_m = 0.02;

std::vector<double> reaches(const WorldDef& world, MeshTrees& trees) {
  std::vector<double> out = body_radii(world, trees);
  for (double& reach : out) reach += kBeyond_m;
  return out;
}

}  // namespace

Simulation::Simulation(const WorldDef& world, const Settings& settings)
    : settings_(settings),
      step_(sync::from_seconds(settings.step_s)),
      ids_(0, 0, settings.groups == "dual" ? 2 : 1),  // the other lane names what is computed ahead
      trees_(std::make_shared<MeshTrees>()),
      mechanics_(make_mechanics(world, settings, ids_, trees_)),
      game_(world.holes),
      fingerprint_(fingerprint(world, settings)) {
  tools_.reserve(world.tools.size());
  const std::vector<double> reach_m = reaches(world, *trees_);
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

void Simulation::start(std::int64_t incarnation) {
  ids_.restart(incarnation);
  find_tools();
  mechanics_->start(group_tools_, events_);
  detect_contacts();
  begin_ = save();
}

void Simulation::sort_news(std::span<const tool_state_t> messages) {
  for (Tool& tool : tools_) tool.news.clear();
  for (const tool_state_t& m : messages)
    if (static_cast<std::size_t>(m.tool) < tools_.size()) tools_[static_cast<std::size_t>(m.tool)].news.push_back(m);
}

void Simulation::step(std::span<const tool_state_t> messages) {
  if (held_) {
    for (Tool& tool : tools_) tool.news.clear();
    place_tools(mechanics_->motions());
    held_ = false;
  }
  sort_news(messages);
  apply_wrenches();
  for (Tool& tool : tools_)
    for (const Push& push : tool.push.step(now(), tool.news, mechanics_->motions()))
      mechanics_->add_force(push.body, push.force_N, push.point_m);
  // The events of the first instant have not been seen by anybody yet.
  if (steps_ > 0) events_.clear();
  find_tools();
  mechanics_->tick(now(), group_tools_, events_);
  ++steps_;
  for (Tool& tool : tools_) tool.push.settle(mechanics_->motions());
  detect_contacts();
}

void Simulation::find_tools() {
  group_tools_.clear();
  for (const Tool& tool : tools_)
    if (tool.touch.touches()) group_tools_.push_back(tool.touch.for_groups());
}

void Simulation::take_model(std::size_t tool) {
  tools_[tool].touch.exchange_model(models_[tool]);
  tools_[tool].push.books(models_[tool].applied, kMaxBooks);
  models_[tool].applied_count = static_cast<std::int8_t>(models_[tool].applied.size());
}

// After a step, and at the first instant.
void Simulation::detect_contacts() {
  tool_contacts_.clear();
  const std::span<BodyMotion> motions = mechanics_->motions();
  place_tools(motions);
  game_.step(now(), motions);
  const sync::ScopedPhaseTimer phase(sync::Phase::kCollision);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    ToolTouch& touch = tools_[i].touch;
    touch.look_only_at(mechanics_->near_tools());
    touch.update(now(), motions, tools_[i].news, events_);
    touch.describe(motions, tool_contacts_);
    take_model(i);
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
  sort_news(messages);
  held_ = true;
  tool_contacts_.clear();
  const std::span<const BodyMotion> now_motions = mechanics_->motions();
  shown_.assign(now_motions.begin(), now_motions.end());
  for (BodyMotion& m : shown_) m.velocity_m_s = m.spin_rad_s = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].touch.look_only_at(std::nullopt);
    tools_[i].touch.feel(now(), shown_, tools_[i].news);
    tools_[i].push.hold(now(), tools_[i].news, shown_);
    take_model(i);
  }
  place_tools(shown_);
  for (Tool& tool : tools_) tool.touch.describe(shown_, tool_contacts_);
}

void Simulation::place_tools(std::span<BodyMotion> motions) {
  for (Tool& tool : tools_) {
    if (tool.body < 0) continue;
    BodyMotion& m = motions[static_cast<std::size_t>(tool.body)];
    if (!tool.news.empty()) tool.orientation = to_eigen(tool.news.back().proxy.orientation).normalized();
    m.orientation = tool.orientation;
    m.position_m = m.centre_m = tool.touch.proxy();
    m.velocity_m_s = tool.touch.proxy_velocity();
  }
}

}  // namespace tactus::sim
