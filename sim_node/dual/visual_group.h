// Bodies that no tool can reach: moved by impulses in visual steps of about 16 ms, each divided into sub-steps, ahead
// of time. The group has its own clock; the caller decides when a step begins. Contains no threads.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/behaviour/impulse/build_world.h"
#include "sim_node/behaviour/impulse_solver.h"
#include "sim_node/dual/sleeping_islands.h"
#include "sim_node/dual/visual_step.h"

namespace tactus::sim {

class VisualGroup {
 public:
  // radii_m: radius of the bounding sphere of each body about its centre of mass. ids: names its contacts and events.
  // Throws std::runtime_error with one sentence when the world cannot be simulated. Initially the group contains all
  // units.
  VisualGroup(const WorldDef& world, const Settings& settings, std::vector<double> radii_m, Ids ids,
              const std::shared_ptr<MeshTrees>& trees);

  // Adds entering units, removes leaving units, and computes the step. Deterministic: the same tasks give the same
  // steps to the bit. Realtime-safe once the lists have grown. Throws StateNotFinite (sim_node/model/finite_motion.h).
  void run(const VisualTask& task, VisualStep& out);

  const impulse::World& world() const { return *world_; }
  sync::SimTime now() const { return now_; }
  // Everything that the next steps depend on. Throws InvalidState.
  void archive(StateArchive& a);
  void rename(std::int64_t incarnation);
  // Call before the first step.
  void restart(std::int64_t incarnation) { ids_.restart(incarnation); }

 private:
  void activate();
  void mark(std::span<const int> units, char value);
  void remove_leaving(const VisualTask& task);
  void add_entering(const VisualTask& task, VisualStep& out);
  void wake(std::span<const int> woken);
  void update_sleeping(sync::Nanoseconds length);
  // Contacts of the awake bodies. A resting body takes part when an awake body is near it; it is treated as fixed.
  class Contacts : public impulse::ContactSource {
   public:
    explicit Contacts(VisualGroup& group) : group_(group) {}
    void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
              std::vector<Manifold>& out) override;

   private:
    VisualGroup& group_;
    std::vector<int> checked_bodies_;
    std::vector<SweptSphere> straight_;
  };
  bool wake_struck(double h_s);
  void sub_steps(ContactTracker& tracker, sync::SimTime begin, sync::Nanoseconds length, VisualStep& out,
                 bool record);
  bool is_about_to_strike(const Manifold& m, int awake, double h_s) const;
  void read_motions();
  void record_touching(int a, int b);
  void record_sub_step(std::size_t k, sync::Nanoseconds passed, VisualStep& out);
  void add_sleeping(std::vector<LiveContact>& live) const;
  void record_trajectories(VisualStep& out);

  Settings settings_;
  std::vector<double> radii_m_;
  impulse::BodyFrames frames_;
  std::unique_ptr<impulse::World> world_;
  ContactFinder finder_;
  Contacts source_;
  impulse::AdaptiveStepper stepper_;
  impulse::SceneSettings scene_;
  Ids ids_;
  ContactTracker tracker_, entering_tracker_;         // of the awake bodies, and of those that catch up
  std::vector<LiveContact> sleeping_contacts_;        // of the resting bodies
  SleepingIslands sleeping_;
  sync::SimTime now_{};
  bool found_ = false;  // contacts_ are valid for the current poses and for steps up to found_for_s_
  double found_for_s_ = 0, before_s_ = 0;  // length of the previous sub-step
  std::vector<int> units_, awake_;            // ascending
  std::vector<char> mask_, supported_;        // per body
  std::vector<BodyMotion> motions_, contact_motions_;  // at present, and at the last contact detection
  std::vector<Manifold> contacts_, solved_;
  std::vector<LiveContact> moved_;
  std::vector<int> list_;
  std::vector<SweptSphere> straight_;
  std::vector<std::pair<int, int>> touching_;
  std::vector<Eigen::Vector3d> centres_m_;  // of the group's bodies at the end of each sub-step
};

}  // namespace tactus::sim
