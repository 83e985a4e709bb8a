#include "sim_node/behaviour/articulated/articulated_system.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim::articulated {
namespace {

// A spring or damper is stiff when its rate times the step exceeds this. An explicit step of Dormand and Prince is
// stable up to 3.3 (Hairer and Wanner 1996, figure IV.2.1). The margin covers poses with less inertia.
constexpr double kStiff = 0.3;
// Limits of the growth of sub-steps (Hairer, Norsett and Wanner 1993, equation II.4.13, with its constants).
constexpr double kSafety = 0.9, kMinFactor = 0.2, kMaxFactor = 5;

void quaternion_rate(const double* q, const Eigen::Vector3d& spin, bool in_body, double* out) {
  const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]), rate(0, spin.x(), spin.y(), spin.z());
  const Eigen::Quaterniond d = in_body ? turn * rate : rate * turn;
  out[0] = d.w() / 2, out[1] = d.x() / 2, out[2] = d.y() / 2, out[3] = d.z() / 2;
}

// The derivative of the coordinates.
void coordinate_rates(const Tree& tree, const double* q, const double* v, double* out) {
  for (const Link& l : tree.links) {
    const double* dq = v + l.first_dof;
    double* to = out + l.first_coordinate;
    const double* from = q + l.first_coordinate;
    if (l.def.is_free) {
      for (int k = 0; k < 3; ++k) to[k] = dq[3 + k];
      quaternion_rate(from + 3, {dq[0], dq[1], dq[2]}, false, to + 3);
    } else if (l.dofs == 3) {
      quaternion_rate(from, {dq[0], dq[1], dq[2]}, true, to);
    } else {
      for (int k = 0; k < l.dofs; ++k) to[k] = dq[k];
    }
  }
}

Eigen::Quaterniond turn_by(const double* rotation_vector) {
  const Eigen::Vector3d v(rotation_vector[0], rotation_vector[1], rotation_vector[2]);
  const double angle = v.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle)) : Eigen::Quaterniond::Identity();
}

void store(const Eigen::Quaterniond& turn, double* q) {
  const Eigen::Quaterniond unit = turn.normalized();
  q[0] = unit.w(), q[1] = unit.x(), q[2] = unit.y(), q[3] = unit.z();
}

Eigen::Quaterniond load(const double* q) { return {q[0], q[1], q[2], q[3]}; }

}  // namespace

ArticulatedSystem::ArticulatedSystem(const std::vector<LinkDef>& links, double step_s, Accuracy accuracy)
    : tree_(std::make_unique<Tree>(links)),
      accuracy_(accuracy),
      dynamics_(*tree_),
      loads_(*tree_),
      passive_(tree_->dofs.size(), 1),
      pair_(static_cast<std::size_t>(tree_->coordinates) + tree_->dofs.size()) {
  state_.positions.assign(static_cast<std::size_t>(tree_->coordinates), 0.0);
  state_.rates.assign(tree_->dofs.size(), 0.0);
  state_.reach_s = step_s;
  y_.resize(state_.positions.size() + state_.rates.size());
  for (const Link& l : tree_->links) {
    double* q = state_.positions.data() + l.first_coordinate;
    if (l.def.is_free) {
      for (int k = 0; k < 3; ++k) q[k] = l.def.centre_m[k];
      q[3] = 1;
    } else if (l.dofs == 3) {
      q[0] = 1;
    }
  }
  accelerations();
  std::vector<double> response(tree_->dofs.size());
  for (std::size_t j = 0; j < passive_.size(); ++j) {
    const Dof& dof = tree_->dofs[j];
    dynamics_.dof_impulse_to_rates(static_cast<int>(j), response);
    const double mobility = response[j];
    passive_[j] =
        step_s * std::sqrt(dof.stiffness * mobility) <= kStiff && step_s * dof.damping * mobility <= kStiff;
  }
  slope_known_ = false;
}

void ArticulatedSystem::set_state(const State& state) {
  state_ = state;
  slope_known_ = placed_ = false;
}

void ArticulatedSystem::set_loads(const SavedLoads& saved_loads) {
  loads_ = saved_loads.loads;
  loaded_ = saved_loads.loaded;
  slope_known_ = false;
}

void ArticulatedSystem::add_force(int link, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) {
  loads_.force_N[static_cast<std::size_t>(link)] += force_N;
  add_moment(link, (point_m - dynamics().centre_m(link)).cross(force_N));
}

void ArticulatedSystem::add_moment(int link, const Eigen::Vector3d& moment_N_m) {
  loads_.moment_N_m[static_cast<std::size_t>(link)] += moment_N_m;
  loaded_ = true;
  slope_known_ = false;
}

void ArticulatedSystem::set_gravity(int link, const Eigen::Vector3d& gravity_m_s2) {
  tree_->links[static_cast<std::size_t>(link)].def.gravity_m_s2 = gravity_m_s2;
  slope_known_ = false;
}

void ArticulatedSystem::set_motor(int dof, double effort, double rate) {
  tree_->dofs[static_cast<std::size_t>(dof)].motor_effort = effort;
  tree_->dofs[static_cast<std::size_t>(dof)].motor_velocity = rate;
}

void ArticulatedSystem::set_friction(int dof, double friction) {
  tree_->dofs[static_cast<std::size_t>(dof)].friction = friction;
}

void ArticulatedSystem::slope_of(const std::vector<double>& y, std::vector<double>& slope) {
  const std::size_t n = state_.positions.size();
  coordinate_rates(*tree_, y.data(), y.data() + n, slope.data());
  dynamics_.evaluate(y.data(), y.data() + n, loads_, passive_, slope.data() + n);
}

void ArticulatedSystem::refresh() {
  if (slope_known_) return;
  std::copy(state_.positions.begin(), state_.positions.end(), y_.begin());
  std::copy(state_.rates.begin(), state_.rates.end(),
            y_.begin() + static_cast<std::ptrdiff_t>(state_.positions.size()));
  slope_of(y_, pair_.slope());
  slope_known_ = placed_ = true;
}

std::span<const double> ArticulatedSystem::accelerations() {
  refresh();
  return std::span<const double>(pair_.slope()).subspan(state_.positions.size());
}

Dynamics& ArticulatedSystem::dynamics() {
  if (!placed_) refresh();
  return dynamics_;
}

double ArticulatedSystem::relative_error() const {
  const std::vector<double>& error = pair_.error();
  const std::size_t n = state_.positions.size();
  double position = 0, rate = 0, fastest = 0;
  for (std::size_t i = 0; i < n; ++i) position = std::max(position, std::abs(error[i]));
  for (std::size_t i = n; i < error.size(); ++i) {
    rate = std::max(rate, std::abs(error[i]));
    fastest = std::max(fastest, std::abs(pair_.result()[i]));
  }
  const double worst = std::max(position / accuracy_.position, rate / (accuracy_.rate * (1 + fastest)));
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::max();
}

void ArticulatedSystem::step(double h_s) {
  if (tree_->dofs.empty()) return;
  refresh();
  const double finest = h_s / accuracy_.max_substeps;
  const auto slope = [this](const std::vector<double>& y, std::vector<double>& out) { slope_of(y, out); };
  double left = h_s;
  substeps_ = 0;
  while (left > finest * 1e-6) {
    // Divides the rest into equal pieces, so that no very short one remains.
    const double pieces = std::ceil(left / std::max(state_.reach_s, finest) * (1 - 1e-12));
    const double h = left / std::max(1.0, pieces);
    pair_.attempt(slope, y_, h);
    ++substeps_;
    const double error = relative_error();
    state_.reach_s = h * std::clamp(kSafety * std::pow(error, -0.2), kMinFactor, kMaxFactor);
    if (error > 1 && h > finest * 1.01) continue;
    y_ = pair_.result();
    pair_.accept();
    left -= h;
  }
  const auto rates = y_.begin() + static_cast<std::ptrdiff_t>(state_.positions.size());
  std::copy(y_.begin(), rates, state_.positions.begin());
  std::copy(rates, y_.end(), state_.rates.begin());
  bool turned = false;
  for (const Link& l : tree_->links) {
    if (!l.def.is_free && l.dofs != 3) continue;
    double* q = state_.positions.data() + l.first_coordinate + (l.def.is_free ? 3 : 0);
    store(load(q), q);
    turned = true;
  }
  if (turned) std::copy(state_.positions.begin(), state_.positions.end(), y_.begin());
  if (!loaded_) return;
  std::fill(loads_.force_N.begin(), loads_.force_N.end(), Eigen::Vector3d::Zero());
  std::fill(loads_.moment_N_m.begin(), loads_.moment_N_m.end(), Eigen::Vector3d::Zero());
  loaded_ = slope_known_ = false;
}

void ArticulatedSystem::add_rates(std::span<const double> change) {
  for (std::size_t j = 0; j < change.size(); ++j) state_.rates[j] += change[j];
  slope_known_ = placed_ = false;
}

void ArticulatedSystem::displace(std::span<const double> by) {
  for (const Link& l : tree_->links) {
    double* q = state_.positions.data() + l.first_coordinate;
    const double* d = by.data() + l.first_dof;
    if (l.def.is_free) {
      for (int k = 0; k < 3; ++k) q[k] += d[3 + k];
      store(turn_by(d) * load(q + 3), q + 3);
    } else if (l.dofs == 3) {
      store(load(q) * turn_by(d), q);
    } else {
      for (int k = 0; k < l.dofs; ++k) q[k] += d[k];
    }
  }
  slope_known_ = placed_ = false;
}

BodyMotion ArticulatedSystem::motion(int link) const {
  const LinkDef& d = tree_->links[static_cast<std::size_t>(link)].def;
  BodyMotion m;
  const Eigen::Matrix3d& turn = dynamics_.rotation(link);
  m.position_m = m.centre_m = dynamics_.centre_m(link);
  m.orientation = Eigen::Quaterniond(turn);
  m.velocity_m_s = dynamics_.velocity_at(link, m.centre_m);
  m.spin_rad_s = dynamics_.spin_rad_s(link);
  m.inverse_mass_1_kg = 1 / d.mass_kg;
  m.inverse_inertia = turn * d.inertia_kg_m2.inverse() * turn.transpose();
  return m;
}

}  // namespace tactus::sim::articulated
