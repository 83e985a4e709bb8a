// Selects the bodies that are simulated at the haptic rate: those that a tool can touch before the next visual step
// begins, and every body that these can touch. All other bodies are simulated at the visual rate.
//
// The rule of Kim et al. 2005, section 4, sweeps the bounding spheres of the tool and of the body along their
// velocities and intersects the capsules. It misses contacts of a hand that accelerates, of bodies that are struck by
// struck bodies, and of bodies that rest on them. The sound rule compares positions at equal times, pads them by the
// largest displacement that forces and impacts can cause, and closes the group over contacts and joints. The pads are
// checked at the haptic rate; when a body leaves its pad, the group grows immediately. So no tick finds a contact
// between the groups, for any motion of the hand:
//
//   |x_i(t) - x_j(t)| >= |p + v t| - pad_i - pad_j > r_i + r_j   for every i in the group and j outside,
//
// while both stay within their pads around the straight line. Bodies outside do, because their trajectories are known
// in advance. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/group_tool.h"
#include "sim_node/dual/swept_trajectories.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

enum class GroupingRule : std::uint8_t { kSound, kKim2005 };

// The constant properties of a body.
struct GroupBody {
  double radius_m = 0;  // of the bounding sphere about the centre of mass
  double inverse_mass_1_kg = 0;
  int system = -1;  // bodies of one system of joints move between the groups together; -1: none
};

struct GroupingLimits {
  sync::Nanoseconds horizon{17'000'000};  // until the next visual step, in whole haptic ticks
  double tolerance_m = 0.001;             // a smaller gap is a contact
  // Limits that the pads are computed for; beyond them check_pads() acts.
  double tool_acceleration_m_s2 = 30;
  double tool_force_N = 20;  // on one body
  double gravity_m_s2 = 9.81;
  double restitution = 1;
  sync::Nanoseconds leave_after{34'000'000};  // two steps without being reachable
};

class Grouping {
 public:
  Grouping(std::vector<GroupBody> bodies, const GroupingLimits& limits, GroupingRule rule = GroupingRule::kSound);

  // Begins a visual step. trajectories: of the bodies that are computed ahead, from now on; they must live until the
  // next call. Bodies of the group stay or leave; bodies with a trajectory may enter. touching: pairs of bodies that
  // touch now, in addition to those of the trajectories. bodies: current motions of all bodies; only those of the
  // group and of entering bodies are read. A body leaves only when it can reach no body outside in this step, so that
  // it can be computed by itself. Cost: proportional to the group. Realtime-safe once the lists have grown.
  void begin_step(sync::SimTime now, const SweptTrajectories& trajectories, std::span<const BodyMotion> bodies,
                  std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  // The same, with trajectories of all bodies inside and outside the group: deviations_m is the maximum distance of
  // each body from its straight line.
  void begin_step(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const double> deviations_m,
                  std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  // The step is over and the next one is not ready: bodies outside stand still at their last poses. Bodies only
  // enter.
  void hold_step(sync::SimTime now, std::span<const BodyMotion> bodies,
                 std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  // Duration of the next steps, including the maximum age of tool data.
  void set_horizon(sync::Nanoseconds horizon) { limits_.horizon = horizon; }
  // Puts the body into the group at the next call and keeps it there for leave_after, even when no tool reaches it: a
  // force acts on it.
  void request_entry(int body) { requested_.push_back(body); }
  // Call in each haptic tick before contact detection. When a tool or a body is further from its straight line than
  // its pad, the group is closed again from the current motions; bodies only enter. Cost: proportional to the group,
  // not to all bodies.
  void check_pads(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);

  // Everything but the trajectories: after reading, call resume() with those of the current step. Throws
  // InvalidState.
  void archive(StateArchive& a);
  void resume(const SweptTrajectories& trajectories) {
    trajectories_ = &trajectories;
    all_have_trajectories_ = false;
  }

  bool is_haptic(int body) const { return member_[static_cast<std::size_t>(body)] != 0; }
  // Ascending. entered() and left() refer to the last call.
  std::span<const int> haptic() const { return haptic_; }
  std::span<const int> entered() const { return entered_; }
  std::span<const int> left() const { return left_; }
  // Number of times that a pad was exceeded.
  std::int64_t pad_violations() const { return pad_violations_; }

 private:
  // Maximum effect of impacts on a body: change of speed, and the time left before the horizon at the earliest
  // impact.
  struct ImpactBound {
    double speed_m_s = 0, remaining_s = 0;
  };
  double remaining_s(sync::SimTime now) const;
  SweptSphere swept(std::size_t body, const BodyMotion& m, double t_s) const;
  SweptSphere swept(const GroupTool& tool, double t_s) const;
  void close_group(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);
  void close_kim2005(std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);
  void add_reachable(const SweptSphere& from, double inverse_mass, sync::SimTime now,
                     std::span<const BodyMotion> bodies);
  void add_to_group(int body, ImpactBound bound, sync::SimTime now, std::span<const BodyMotion> bodies);
  double max_impact_speed_m_s(const SweptSphere& tool, std::size_t body, double t_s) const;
  void begin(sync::SimTime now, const SweptTrajectories& trajectories, bool includes_all, std::span<const BodyMotion> bodies,
             std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  void set_touching(std::span<const std::pair<int, int>> touching);
  void record_entered(sync::SimTime now);
  void update_leaving(sync::SimTime now, std::span<const BodyMotion> bodies);
  bool reaches_group(int body, sync::SimTime now);
  void enter_requested(sync::SimTime now, std::span<const BodyMotion> bodies);
  const SweptSphere& trajectory_of(int body) const {
    return is_departed_[static_cast<std::size_t>(body)] ? departed_trajectories_[static_cast<std::size_t>(body)] : trajectories_->of(body);
  }
  void find_outside(const Bounds& query);
  bool pad_exceeded(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) const;

  std::vector<GroupBody> bodies_;
  GroupingLimits limits_;
  GroupingRule rule_;
  std::vector<std::vector<int>> systems_;      // bodies of each
  std::vector<std::pair<int, int>> touching_;  // in both directions, sorted
  sync::SimTime step_began_{};
  const SweptTrajectories* trajectories_ = nullptr;
  SweptTrajectories own_trajectories_;
  // Bodies that have just left: their trajectories are not computed yet.
  std::vector<int> departed_;
  std::vector<SweptSphere> departed_trajectories_;
  std::vector<int> movers_, requested_;
  std::vector<SweptSphere> straight_;
  std::vector<char> is_departed_;
  bool all_have_trajectories_ = false;
  bool held_ = false;  // bodies outside stand still; they stopped held_after_s_ after the beginning of the step
  double held_after_s_ = 0;
  std::vector<char> leaves_;
  // Trajectories of the group, from watched_from_ on.
  sync::SimTime watched_from_{};
  std::vector<SweptSphere> inside_, tools_;
  std::vector<ImpactBound> impact_bounds_;
  std::vector<char> member_;
  std::vector<sync::SimTime> last_reached_;
  std::vector<int> haptic_, before_, entered_, left_, found_;
  std::int64_t pad_violations_ = 0;
};

}  // namespace tactus::sim
