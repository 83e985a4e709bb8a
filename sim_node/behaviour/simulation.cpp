#include "sim_node/behaviour/simulation.h"

#include <algorithm>

#include "lcmtypes/vectors.h"
#include "sim_node/collision/closest_surface.h"
#include "sim_node/state/fingerprint.h"

namespace tactus::sim {

namespace {

constexpr std::size_t kMostBooks = 8;  // of a touch_model_t
// A force may act so far outside the sphere around a body, m: the rounding of the wire and a step's motion.
constexpr double kBeyond_m = 0.02;

// Radius about its centre of mass of the sphere that holds each body.
std::vector<double> reaches(const WorldDef& world, MeshTrees& trees) {
  std::vector<double> out(world.bodies.size(), kBeyond_m);
  for (const ShapeDef& s : world.shapes) {
    const auto body = static_cast<std::size_t>(s.body);
    if (world.bodies[body].is_static) continue;
    const ClosestSurface surface(s, s.kind == ShapeKind::kMesh ? trees.triangles(s, world) : nullptr);
    const double from_centre = (s.pose * surface.centre() - world.bodies[body].centre_of_mass_m).norm();
    // A plane that moves is a plate of its size.
    const double bound = s.kind == ShapeKind::kPlane ? 0.5 * s.size_m.norm() : surface.bound_m();
    out[body] = std::max(out[body], from_centre + bound + kBeyond_m);
  }
  return out;
}

}  // namespace

Simulation::Simulation(const WorldDef& world, const Settings& settings)
    : settings_(settings),
      step_(sync::from_seconds(settings.step_s)),
      ids_(0),
      solver_(world, settings),
      tracker_(surface_traits(world, settings), settings, ids_),
      game_(world.holes),
      fingerprint_(fingerprint(world, settings)) {
  tools_.reserve(world.tools.size());
  MeshTrees trees;
  const std::vector<double> reach_m = reaches(world, trees);
  for (std::size_t i = 0; i < world.tools.size(); ++i) {
    const int body = world.tools[i].body;
    tools_.push_back({body, ToolTouch(world, static_cast<int>(i), settings, ids_, trees), ToolPush(settings, ids_, reach_m), {},
                      Eigen::Quaterniond(world.bodies[static_cast<std::size_t>(body)].pose.linear()).normalized()});
  }
  for (Tool& tool : tools_)
    tool.touch.set_mobility([this](int body, const Eigen::Vector3d& point, const Eigen::Vector3d& n) {
      return solver_.mobility(body, point, n);
    });
  models_.resize(tools_.size());
}

void Simulation::start(std::int64_t incarnation) {
  ids_.restart(incarnation);
  look();
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
    motions_.assign(solver_.bodies().begin(), solver_.bodies().end());
    place_tools();
    held_ = false;
  }
  sort_news(messages);
  apply_wrenches();
  for (Tool& tool : tools_)
    for (const Push& push : tool.push.step(now(), tool.news, motions_))
      solver_.add_force(push.body, push.force_N, push.point_m);
  solver_.step();
  // The events of the first instant have not been seen by anybody yet.
  if (steps_++ > 0) events_.clear();
  for (Tool& tool : tools_) tool.push.settle(solver_.bodies());
  look();
}

void Simulation::look() {
  tool_contacts_.clear();
  motions_.assign(solver_.bodies().begin(), solver_.bodies().end());
  place_tools();
  game_.step(now(), motions_);
  tracker_.update(now(), step_, motions_, solver_.contacts(), solver_.solved(), events_);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    ToolTouch& touch = tools_[i].touch;
    touch.update(now(), motions_, tools_[i].news, events_);
    touch.describe(motions_, tool_contacts_);
    models_[i] = touch.model();
    tools_[i].push.books(models_[i].applied, kMostBooks);
    models_[i].applied_count = static_cast<std::int8_t>(models_[i].applied.size());
  }
  std::stable_sort(events_.begin(), events_.end(),
                   [](const contact_event_t& a, const contact_event_t& b) { return a.time_ns < b.time_ns; });
}

void Simulation::apply_wrenches() {
  for (Wrench& w : wrenches_) {
    solver_.add_force(w.body, w.force_N, solver_.bodies()[static_cast<std::size_t>(w.body)].centre_m);
    solver_.add_torque(w.body, w.torque_N_m);
    --w.steps;
  }
  std::erase_if(wrenches_, [](const Wrench& w) { return w.steps <= 0; });
}

bool Simulation::push(const Wrench& wrench) {
  if (wrenches_.size() >= kMostWrenches) return false;
  wrenches_.push_back(wrench);
  return true;
}

void Simulation::set_friction(int body, double friction) {
  solver_.set_friction(body, friction);
  for (Tool& tool : tools_) tool.touch.set_friction(body, friction);
}

void Simulation::hold(std::span<const tool_state_t> messages) {
  sort_news(messages);
  held_ = true;
  tool_contacts_.clear();
  motions_.assign(solver_.bodies().begin(), solver_.bodies().end());
  for (BodyMotion& m : motions_) m.velocity_m_s = m.spin_rad_s = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].touch.feel(now(), motions_, tools_[i].news);
    tools_[i].push.hold(now(), tools_[i].news, motions_);
    models_[i] = tools_[i].touch.model();
    tools_[i].push.books(models_[i].applied, kMostBooks);
    models_[i].applied_count = static_cast<std::int8_t>(models_[i].applied.size());
  }
  place_tools();
  for (Tool& tool : tools_) tool.touch.describe(motions_, tool_contacts_);
}

void Simulation::place_tools() {
  for (Tool& tool : tools_) {
    if (tool.body < 0) continue;
    BodyMotion& m = motions_[static_cast<std::size_t>(tool.body)];
    if (!tool.news.empty()) tool.orientation = to_eigen(tool.news.back().proxy.orientation).normalized();
    m.orientation = tool.orientation;
    m.position_m = m.centre_m = tool.touch.proxy();
    m.velocity_m_s = tool.touch.proxy_velocity();
  }
}

void Simulation::body_contacts(std::vector<contact_t>& out) const {
  out.clear();
  for (const LiveContact& c : tracker_.live()) tracker_.describe(c, motions_, out.emplace_back());
}

}  // namespace tactus::sim
