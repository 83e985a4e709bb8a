// Which bodies are simulated at the haptic rate: those that a tool can touch before the next visual step begins,
// and whatever these can touch. All others are simulated at the visual rate.
//
// The rule of Kim et al. 2005, section 4, sweeps the tool's and the body's bounding spheres along their velocities
// and intersects the capsules. It misses contacts: of a hand that accelerates, of bodies that are struck by bodies
// that were struck, of what rests on them. The sound rule compares positions at equal times, pads them by what
// forces and impacts can do, and closes the group over contacts and joints; the pads are watched at the haptic
// rate, and where one is left the group grows at once. So whatever the hand does, no tick finds a contact between
// the groups:
//
//   |x_i(t) - x_j(t)| >= |p + v t| - pad_i - pad_j > r_i + r_j   for every i in the group and j outside,
//
// as long as both stay within their pads of the straight way; those outside do, for their way is known beforehand.
// Pure.
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

// What does not change of a body.
struct GroupBody {
  double radius_m = 0;  // of a sphere about the centre of mass that holds it
  double inverse_mass_1_kg = 0;
  int system = -1;  // bodies of one system, joined by joints, move between the groups together; -1: none
};

struct GroupingLimits {
  sync::Nanoseconds horizon{17'000'000};  // until the next visual step, in whole haptic ticks
  double tolerance_m = 0.001;             // nearer is a contact
  // What pads are made for; beyond it the watchdog acts.
  double tool_acceleration_m_s2 = 30;
  double tool_force_N = 20;  // on one body
  double gravity_m_s2 = 9.81;
  double restitution = 1;
  sync::Nanoseconds leave_after{34'000'000};  // not reachable for two steps
};

class Grouping {
 public:
  Grouping(std::vector<GroupBody> bodies, const GroupingLimits& limits, GroupingRule rule = GroupingRule::kSound);

  // A visual step begins. ways: of the bodies that are computed ahead, from now on; they must live until the next
  // call. Bodies of the group stay or leave; bodies with a way may enter. touching: pairs of bodies that touch
  // now, apart from those of the ways. bodies: all, as they are now; read are those of the group, and those that
  // enter. may_leave: false: there is nobody who would take them. A body leaves only when it can reach nothing
  // outside in this step, so that it may be computed by itself. Cost: of the group. Realtime-safe once its lists
  // have grown.
  void begin_step(sync::SimTime now, const SweptTrajectories& ways, std::span<const BodyMotion> bodies,
                  std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools,
                  bool may_leave = true);
  // The same with the ways of all bodies in the group and outside, by how far each will be at most from its
  // straight way.
  void begin_step(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const double> strays_m,
                  std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  // The step is over and the next is not there: what is outside stands still where it came to. Bodies only enter.
  void hold_step(sync::SimTime now, std::span<const BodyMotion> bodies,
                 std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools);
  // How long the next steps last, with all that a word of a tool may be old.
  void set_horizon(sync::Nanoseconds horizon) { limits_.horizon = horizon; }
  // From the next call on the body is in the group for a while, whatever reaches it: something acts on it.
  void want(int body) { asked_.push_back(body); }
  // A haptic tick, before its contacts are sought: where something is further from its straight way than its pad,
  // the group is closed anew from what is true now; bodies only enter. Cost: of the group, not of all bodies.
  void watch(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);

  // All but the ways: after reading, resume() with those of the step that is going on. Throws BadState.
  void archive(StateArchive& a);
  void resume(const SweptTrajectories& ways) {
    ways_ = &ways;
    all_have_ways_ = false;
  }

  bool is_haptic(int body) const { return member_[static_cast<std::size_t>(body)] != 0; }
  // Ascending; entered and left: in the last call.
  std::span<const int> haptic() const { return haptic_; }
  std::span<const int> entered() const { return entered_; }
  std::span<const int> left() const { return left_; }
  // How often a pad was left.
  std::int64_t alarms() const { return alarms_; }

 private:
  // What impacts may do to a body: change its speed so much, at the earliest so long before the horizon.
  struct Kick {
    double speed_m_s = 0, left_s = 0;
  };
  double left_s(sync::SimTime now) const;
  SweptSphere swept(std::size_t body, const BodyMotion& m, double t_s) const;
  SweptSphere swept(const GroupTool& tool, double t_s) const;
  void close(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);
  void close_as_kim(std::span<const BodyMotion> bodies, std::span<const GroupTool> tools);
  void reach(const SweptSphere& from, double inverse_mass, sync::SimTime now, std::span<const BodyMotion> bodies);
  void enter(int body, Kick kick, sync::SimTime now, std::span<const BodyMotion> bodies);
  double kick_m_s(const SweptSphere& tool, std::size_t body, double t_s) const;
  void begin(sync::SimTime now, const SweptTrajectories& ways, bool of_all, std::span<const BodyMotion> bodies,
             std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools, bool may_leave);
  void note(std::span<const std::pair<int, int>> touching);
  void tell(sync::SimTime now);
  void stay_or_leave(sync::SimTime now, std::span<const BodyMotion> bodies);
  bool reaches_what_stays(int body, sync::SimTime now);
  void enter_asked(sync::SimTime now, std::span<const BodyMotion> bodies);
  const SweptSphere& way_of(int body) const {
    return is_late_[static_cast<std::size_t>(body)] ? late_ways_[static_cast<std::size_t>(body)] : ways_->of(body);
  }
  void find_outside(const Bounds& query);
  bool strayed(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) const;

  std::vector<GroupBody> bodies_;
  GroupingLimits limits_;
  GroupingRule rule_;
  std::vector<std::vector<int>> systems_;      // bodies of each
  std::vector<std::pair<int, int>> touching_;  // both ways round, sorted
  sync::SimTime step_began_{};
  const SweptTrajectories* ways_ = nullptr;
  SweptTrajectories own_ways_;
  // Bodies that have just left: nobody has computed their ways yet.
  std::vector<int> late_;
  std::vector<SweptSphere> late_ways_;
  std::vector<int> movers_, asked_;
  std::vector<SweptSphere> straight_;
  std::vector<char> is_late_;
  bool all_have_ways_ = false;
  bool held_ = false;  // what is outside stands still, where it was so long after the step had begun
  double held_after_s_ = 0;
  std::vector<char> leaves_;
  // Of the group, from watched_from_ on.
  sync::SimTime watched_from_{};
  std::vector<SweptSphere> inside_, tools_;
  std::vector<Kick> kicks_;
  std::vector<char> member_;
  std::vector<sync::SimTime> wanted_at_;
  std::vector<int> haptic_, before_, entered_, left_, found_;
  std::int64_t alarms_ = 0;
};

}  // namespace tactus::sim
