// A world in two groups (Kim, Sung, Park 2005): what a tool can reach is moved at the haptic rate, with penalty
// contact; all else in visual steps, ahead of time. Bodies go from one to the other with their joints, velocities
// and contacts.
//
// Time of a visual step n, which begins at t_n: until t_n, step n has been computed; its ways are known when the
// groups are made for it. Who is promoted takes the state that its way had at that instant, with all that it
// touches in that step. Who is let go at t_n has no part in step n: it catches up by itself, since it can reach
// nobody else in it, and takes part in step n + 1, whose computation begins now.
#pragma once

#include <memory>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/behaviour/mechanics.h"
#include "sim_node/dual/grouping.h"
#include "sim_node/dual/visual_rate.h"
#include "sim_node/dual/visual_thread.h"

namespace tactus::sim {

class DualGroups : public Mechanics {
 public:
  // ids: how the contacts of the haptic group are named, every other number of which is the visual group's. Throws
  // std::runtime_error with one sentence when the world cannot be simulated.
  DualGroups(const WorldDef& world, const Settings& settings, Ids& ids,
             const std::shared_ptr<MeshTrees>& trees = std::make_shared<MeshTrees>());

  void start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;
  // Bodies that are acted on are in the haptic group from then on.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) override;
  void add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) override;
  // Never waits for the visual group.
  void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;

  // Of the haptic group as it is, of the visual group as it was when its step began.
  std::span<BodyMotion> motions() override { return motions_; }
  std::optional<std::span<const int>> near_tools() const override { return grouping_.haptic(); }
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) override {
    return world_->mobility(body, point_m, n);
  }
  void contacts(std::vector<contact_t>& out) override;
  const Ahead* ahead() override;

  bool apply(const impulse::SceneChange& change) override;
  // Who is put somewhere, or thrown, comes into the haptic group first.
  bool set_pose(int body, const Eigen::Isometry3d& pose) override;
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s) override;
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s) override;

  void archive(StateArchive& a) override;
  void rename(std::int64_t incarnation) override;

  std::span<const int> haptic() const { return grouping_.haptic(); }
  bool is_haptic(int body) const { return grouping_.is_haptic(body); }
  const Grouping& grouping() const { return grouping_; }
  // The visual step that is going on, and when it ends.
  const VisualStep* step() const { return step_.get(); }
  sync::SimTime step_ends() const { return ends_; }
  // Steps that were not there in time; sum of the ticks for which bodies stood still.
  std::int64_t late_steps() const { return late_steps_; }
  std::int64_t held_ticks() const { return held_ticks_; }
  void set_visual_rate(double rate_Hz) override { rate_.set(rate_Hz); }

 private:
  struct Load {
    int body;
    Eigen::Vector3d force_N, point_m, torque_N_m;
    bool at_centre;  // point_m is not
  };
  void act(const Load& load);
  // To be set when the body is in the haptic group.
  struct Wish {
    enum Kind { kPose, kVelocity, kSpin };
    int kind, body;
    Eigen::Vector3d vector;
    Eigen::Quaterniond turn;
  };
  bool wish(const Wish& w);
  void grant_wishes();
  void begin_step(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events);
  void ask_for_next();
  void hold(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events);
  void promote(sync::SimTime now, std::vector<contact_event_t>& events);
  void release();
  void activate();
  void read_motions(std::span<const int> bodies);
  void find_contacts(double h_s);
  void note_touching();
  void gather_units(std::span<const int> bodies);
  void catch_up(std::span<const int> units, sync::SimTime from, sync::SimTime to,
                std::vector<contact_event_t>& events);
  void reconcile(sync::SimTime from, sync::SimTime to, std::vector<contact_event_t>& events);
  void mark(std::span<const int> units, char as);
  void tell_due(sync::SimTime until, std::vector<contact_event_t>& events);

  Settings settings_;
  std::unique_ptr<impulse::World> world_;  // of the haptic group
  SceneContacts source_;
  impulse::Advance advance_;
  impulse::SceneSettings scene_;
  Ids& ids_;
  ContactTracker tracker_, catching_up_;
  Grouping grouping_;
  VisualThread visual_;
  VisualRate rate_;

  std::unique_ptr<VisualStep> step_;
  VisualTask task_;  // of the next step
  sync::SimTime begins_{}, ends_{}, held_until_{};
  sync::Nanoseconds ahead_{};  // the clock of the simulation, less that of the visual group
  Handover late_;              // who left when the step began
  std::size_t told_ = 0;       // of the step's events
  std::int64_t number_ = 0, late_steps_ = 0, held_ticks_ = 0;
  bool began_ = false, holds_ = false, stale_ = true;

  std::vector<BodyMotion> motions_;
  std::vector<Manifold> contacts_, solved_;
  std::vector<std::pair<int, int>> touching_;
  std::vector<int> units_, from_late_, from_step_, promoted_, released_, list_;
  std::vector<char> mask_;
  std::vector<LiveContact> moved_;
  std::vector<Load> loads_;
  std::vector<Wish> wishes_;
  std::vector<impulse::SceneChange> changes_;  // not asked for yet
  struct Told {
    std::int64_t contact;
    int body_a, body_b;
    bool known;
  };
  std::vector<Told> open_;  // contacts of who is promoted that have been told of and not ended
  std::vector<contact_event_t> unheard_;
  // To tell of what is computed ahead.
  Ahead ahead_now_;
  std::vector<int> ahead_bodies_, ahead_waiting_;
  std::vector<BodyMotion> ahead_motions_;
};

}  // namespace tactus::sim
