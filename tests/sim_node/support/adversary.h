// A small world of balls and an adversarial tool, to test grouping: in every tick it checks all pairs between the
// groups, which grouping itself never does.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "sim_node/dual/grouping.h"

namespace tactus::sim::test {

struct AdversaryDef {
  int balls = 60;
  double room_m = 0.6;                  // balls and tool stay in a cube of this side
  double tool_acceleration_m_s2 = 100;  // bang-bang: always this magnitude, in a direction that jumps
  double tool_speed_m_s = 1;            // upper limit
  double gravity_m_s2 = 9.81;
  double ball_speed_m_s = 1;  // maximum speed of each at the start
  int steps = 60;             // number of visual steps
  unsigned seed = 1;
};

struct AdversaryResult {
  long contacts = 0;  // of the group with any body, in distinct visual steps
  long missed = 0;    // of these, with a ball outside the group
  double deepest_missed_m = 0;
  double group = 0;  // mean size per tick
  double touched =
      0;  // balls per step that the group really touched: the optimum in hindsight
  long alarms = 0;
};

class Adversary {
 public:
  Adversary(const AdversaryDef& def, GroupingRule rule, const GroupingLimits& limits)
      : def_(def), random_(def.seed), grouping_(make_balls(), limits, rule) {
    tool_.radius_m = 0.01;
    tool_.centre_m = point();
    tool_.velocity_m_s.setZero();
  }

  AdversaryResult run() {
    for (int n = 0; n < def_.steps; ++n) step(n);
    const double ticks = static_cast<double>(tick_);
    result_.group /= ticks;
    result_.touched /= def_.steps;
    result_.alarms = grouping_.pad_violations();
    return result_;
  }

 private:
  static constexpr double kTick_s = 0.001;
  static sync::SimTime at(long tick) { return sync::sim_time(tick * std::int64_t{1'000'000}); }

  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  Eigen::Vector3d point() {
    const double h = def_.room_m / 2 - 0.06;
    return {between(-h, h), between(-h, h), between(-h, h)};
  }
  Eigen::Vector3d direction() {
    Eigen::Vector3d d;
    do d = {between(-1, 1), between(-1, 1), between(-1, 1)};
    while (d.squaredNorm() > 1 || d.squaredNorm() < 0.01);
    return d.normalized();
  }

  std::vector<GroupBody> make_balls() {
    std::vector<GroupBody> balls;
    for (int i = 0; i < def_.balls; ++i) {
      const double r = between(0.01, 0.05);
      balls.push_back({r, 1 / (4.0 / 3 * M_PI * r * r * r * 700), -1});  // wood
      BodyMotion m;
      m.centre_m = point();
      m.velocity_m_s = direction() * between(0, def_.ball_speed_m_s);
      m.inverse_mass_1_kg = balls.back().inverse_mass_1_kg;
      motions_.push_back(m);
    }
    return balls_ = balls;
  }

  // One tick of free flight between reflecting walls.
  void fly(Eigen::Vector3d& x, Eigen::Vector3d& v, double radius, double gravity) const {
    v.z() -= gravity * kTick_s;
    x += v * kTick_s;
    const double h = def_.room_m / 2 - radius;
    for (int k = 0; k < 3; ++k)
      if (std::abs(x[k]) > h && x[k] * v[k] > 0) v[k] = -v[k];
  }

  void move_tool() {
    if (random_() % 4 == 0) push_ = direction();
    tool_.velocity_m_s += push_ * def_.tool_acceleration_m_s2 * kTick_s;
    const double speed = tool_.velocity_m_s.norm();
    if (speed > def_.tool_speed_m_s) tool_.velocity_m_s *= def_.tool_speed_m_s / speed;
    fly(tool_.centre_m, tool_.velocity_m_s, tool_.radius_m, 0);
  }

  // Trajectories of the balls through the next 17 ticks, as a visual step computes them.
  void look_ahead(int ticks) {
    ways_.assign(motions_.size(), {});
    strays_.assign(motions_.size(), 0);
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      Eigen::Vector3d x = motions_[i].centre_m, v = motions_[i].velocity_m_s;
      for (int k = 1; k <= ticks; ++k) {
        fly(x, v, balls_[i].radius_m, def_.gravity_m_s2);
        ways_[i].push_back({x, v});
        const Eigen::Vector3d straight = motions_[i].centre_m + motions_[i].velocity_m_s * (k * kTick_s);
        strays_[i] = std::max(strays_[i], (x - straight).norm());
      }
    }
  }

  // A ball of the group bounces elastically off the other body; the tool has infinite mass.
  void bounce(BodyMotion& a, Eigen::Vector3d centre, Eigen::Vector3d& velocity, double inverse_mass) const {
    const Eigen::Vector3d n = (a.centre_m - centre).normalized();
    const double closing = n.dot(a.velocity_m_s - velocity);
    if (closing >= 0) return;
    const double impulse = -2 * closing / (a.inverse_mass_1_kg + inverse_mass);
    a.velocity_m_s += impulse * a.inverse_mass_1_kg * n;
    velocity -= impulse * inverse_mass * n;
  }

  // Checks all pairs.
  void check(std::set<std::pair<int, int>>& met, std::set<int>& touched) {
    const int n = static_cast<int>(motions_.size());
    for (int i = -1; i < n; ++i) {
      if (i >= 0 && !grouping_.is_haptic(i)) continue;
      const Eigen::Vector3d centre = i < 0 ? tool_.centre_m : motions_[static_cast<std::size_t>(i)].centre_m;
      const double radius = i < 0 ? tool_.radius_m : balls_[static_cast<std::size_t>(i)].radius_m;
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        BodyMotion& other = motions_[static_cast<std::size_t>(j)];
        const double overlap =
            radius + balls_[static_cast<std::size_t>(j)].radius_m - (other.centre_m - centre).norm();
        if (overlap <= 0) continue;
        const bool first = met.insert({i, j}).second;
        result_.contacts += first;
        if (i < 0 || touched.contains(i)) touched.insert(j);
        if (grouping_.is_haptic(j)) {
          Eigen::Vector3d hand = tool_.velocity_m_s;
          if (i < 0)
            bounce(other, centre, hand, 0);
          else
            bounce(other, centre, motions_[static_cast<std::size_t>(i)].velocity_m_s,
                   motions_[static_cast<std::size_t>(i)].inverse_mass_1_kg);
        } else {
          result_.missed += first;
          result_.deepest_missed_m = std::max(result_.deepest_missed_m, overlap);
        }
      }
    }
  }

  void step(int n) {
    const long end = (1000L * (n + 1) + 59) / 60;
    const int ticks = static_cast<int>(end - tick_);
    look_ahead(17);
    const std::vector<GroupTool> before{tool_};
    grouping_.begin_step(at(tick_), motions_, strays_, {}, before);
    std::set<std::pair<int, int>> met;
    std::set<int> touched;
    for (int k = 0; k < ticks; ++k) {
      ++tick_;
      move_tool();
      for (std::size_t i = 0; i < motions_.size(); ++i) {
        BodyMotion& m = motions_[i];
        if (grouping_.is_haptic(static_cast<int>(i)))
          fly(m.centre_m, m.velocity_m_s, balls_[i].radius_m, def_.gravity_m_s2);
        else
          std::tie(m.centre_m, m.velocity_m_s) = ways_[i][static_cast<std::size_t>(k)];
      }
      const std::vector<GroupTool> tools{tool_};
      grouping_.check_pads(at(tick_), motions_, tools);
      check(met, touched);
      result_.group += static_cast<double>(grouping_.haptic().size());
    }
    result_.touched += static_cast<double>(touched.size());
  }

  AdversaryDef def_;
  std::mt19937 random_;
  std::vector<GroupBody> balls_;
  std::vector<BodyMotion> motions_;
  Grouping grouping_;
  GroupTool tool_;
  Eigen::Vector3d push_ = Eigen::Vector3d::UnitX();
  std::vector<std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>> ways_;
  std::vector<double> strays_;
  long tick_ = 0;
  AdversaryResult result_;
};

}  // namespace tactus::sim::test
