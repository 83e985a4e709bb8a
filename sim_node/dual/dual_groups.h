// A world in two groups (Kim, Sung, Park 2005): bodies in reach of a tool are stepped at the haptic rate with penalty
// contact; all other bodies are stepped at the visual rate, ahead of time. Bodies move between the groups with their
// joints, velocities and contacts.
//
// Timing of a visual step n, which begins at t_n: step n is complete at t_n, so its trajectories are available when
// the groups are formed for it. A body that is promoted takes the state of its trajectory at that instant, together
// with the bodies that it touches in that step. A body that is released at t_n is not part of step n: it catches up
// by itself, since it can reach no other body during step n, and joins step n + 1, whose computation begins at t_n.
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
  // ids: names the contacts of the haptic group; the visual group uses every other number. Throws std::runtime_error
  // with one sentence when the world cannot be simulated.
  DualGroups(const WorldDef& world, const Settings& settings, Ids& ids,
             const std::shared_ptr<MeshTrees>& trees = std::make_shared<MeshTrees>());

  void start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;
  // A body that a force acts on belongs to the haptic group from then on.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) override;
  void add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) override;
  // Never waits for the visual group.
  void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;

  // Haptic group: current motions. Visual group: motions at the beginning of its step.
  std::span<BodyMotion> motions() override { return motions_; }
  std::optional<std::span<const int>> near_tools() const override { return grouping_.haptic(); }
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) override {
    return world_->mobility(body, point_m, n);
  }
  void contacts(std::vector<contact_t>& out) override;
  const LookAhead* look_ahead() override;

  bool apply(const impulse::SceneChange& change) override;
  // A body whose pose or velocity is set enters the haptic group first.
  bool set_pose(int body, const Eigen::Isometry3d& pose) override;
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s) override;
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s) override;

  void archive(StateArchive& a) override;
  void rename(std::int64_t incarnation) override;

  std::span<const int> haptic() const { return grouping_.haptic(); }
  bool is_haptic(int body) const { return grouping_.is_haptic(body); }
  // The current visual step, and the time at which it ends.
  const VisualStep* step() const { return step_.get(); }
  sync::SimTime step_ends() const { return ends_; }
  // Number of visual steps that were not ready in time; total of the ticks for which bodies were held.
  std::int64_t late_steps() const { return late_steps_; }
  std::int64_t held_ticks() const { return held_ticks_; }
  void set_visual_rate(double rate_Hz) override { rate_.set(rate_Hz); }

 private:
  struct Load {
    int body;
    Eigen::Vector3d force_N, point_m, torque_N_m;
    bool at_centre;  // point_m is unused
  };
  void apply_load(const Load& load);
  // A change that is applied as soon as the body is in the haptic group.
  struct QueuedChange {
    enum Kind { kPose, kVelocity, kSpin };
    int kind, body;
    Eigen::Vector3d vector;
    Eigen::Quaterniond orientation;
  };
  bool queue_change(const QueuedChange& w);
  void apply_queued_changes();
  void begin_step(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events);
  void request_next_step();
  void hold(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events);
  void promote(sync::SimTime now, std::vector<contact_event_t>& events);
  void release();
  void activate();
  void read_motions(std::span<const int> bodies);
  void find_contacts(double h_s);
  void record_touching();
  void gather_units(std::span<const int> bodies);
  void catch_up(std::span<const int> units, sync::SimTime from, sync::SimTime to,
                std::vector<contact_event_t>& events);
  void reconcile(sync::SimTime from, sync::SimTime to, std::vector<contact_event_t>& events);
  void mark(std::span<const int> units, char value);
  void publish_due_events(sync::SimTime until, std::vector<contact_event_t>& events);

  Settings settings_;
  std::unique_ptr<impulse::World> world_;  // of the haptic group
  SceneContacts source_;
  impulse::AdaptiveStepper stepper_;
  impulse::SceneSettings scene_;
  Ids& ids_;
  ContactTracker tracker_, catching_up_;
  Grouping grouping_;
  VisualThread visual_;
  VisualRate rate_;

  std::unique_ptr<VisualStep> step_;
  VisualTask task_;  // of the next step
  sync::SimTime begins_{}, ends_{}, held_until_{};
  sync::Nanoseconds clock_offset_{};  // clock of the simulation minus clock of the visual group
  UnitTransfer departed_;           // units that left the haptic group when the step began
  std::size_t published_events_ = 0;  // number of the step's events already published
  std::int64_t number_ = 0, late_steps_ = 0, held_ticks_ = 0;
  bool began_ = false, holding_ = false, stale_ = true;

  std::vector<BodyMotion> motions_;
  std::vector<Manifold> contacts_, solved_;
  std::vector<std::pair<int, int>> touching_;
  std::vector<int> units_, from_late_, from_step_, promoted_, released_, list_;
  std::vector<char> mask_;
  std::vector<LiveContact> moved_;
  std::vector<Load> loads_;
  std::vector<QueuedChange> queued_changes_;
  std::vector<impulse::SceneChange> changes_;  // not yet sent to the visual group
  struct OpenContact {
    std::int64_t contact;
    int body_a, body_b;
    bool matched;
  };
  std::vector<OpenContact> open_;  // published contacts of the promoted bodies that have not ended
  std::vector<contact_event_t> discarded_events_;
  // The state computed ahead, for the publisher.
  LookAhead look_ahead_;
  std::vector<int> look_ahead_bodies_, look_ahead_waiting_;
  std::vector<BodyMotion> look_ahead_motions_;
};

}  // namespace tactus::sim
