// The bodies that no tool can reach: moved by impulses in visual steps of some 16 ms, each divided into sub-steps,
// ahead of time. Its clock is its own: whoever asks for a step says when it is to be. Knows no threads.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/behaviour/impulse/build_world.h"
#include "sim_node/behaviour/impulse_solver.h"
#include "sim_node/dual/resting.h"
#include "sim_node/dual/visual_step.h"

namespace tactus::sim {

class VisualGroup {
 public:
  // radii_m: of a sphere about the centre of mass that holds each body. ids: how its contacts and events are
  // named. Throws std::runtime_error with one sentence when the world cannot be simulated. All units are its own
  // at first.
  VisualGroup(const WorldDef& world, const Settings& settings, std::vector<double> radii_m, Ids ids,
              const std::shared_ptr<MeshTrees>& trees);

  // Takes over who enters, lets go who leaves, and computes the step. Deterministic: the same tasks give the same
  // steps to the bit. Realtime-safe once the lists have grown.
  void run(const VisualTask& task, VisualStep& out);

  const impulse::World& world() const { return *world_; }
  sync::SimTime now() const { return now_; }
  // All that the next steps depend on. Throws BadState.
  void archive(StateArchive& a);
  void rename(std::int64_t incarnation);
  // Before the first step.
  void restart(std::int64_t incarnation) { ids_.restart(incarnation); }

 private:
  void activate();
  void mark(std::span<const int> units, char as);
  void let_go(const VisualTask& task);
  void take_over(const VisualTask& task, VisualStep& out);
  void wake(std::span<const int> woken);
  void settle(sync::Nanoseconds length);
  // Contacts of what is awake. What rests is there where something awake is near: it stands as if fixed.
  class Contacts : public impulse::ContactSource {
   public:
    explicit Contacts(VisualGroup& group) : group_(group) {}
    void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
              std::vector<Manifold>& out) override;

   private:
    VisualGroup& group_;
    std::vector<int> looked_after_;
    std::vector<SweptSphere> straight_;
  };
  bool wake_struck(double h_s);
  void sub_steps(ContactTracker& tracker, sync::SimTime begin, sync::Nanoseconds length, VisualStep& out,
                 bool noted);
  bool meets(const Manifold& m, int awake, double h_s) const;
  void read_motions();
  void note_touching(int a, int b);
  void note_sub_step(std::size_t k, sync::Nanoseconds passed, VisualStep& out);
  void add_resting(std::vector<LiveContact>& live) const;
  void note_ways(VisualStep& out);

  Settings settings_;
  std::vector<double> radii_m_;
  impulse::BodyFrames frames_;
  std::unique_ptr<impulse::World> world_;
  ContactFinder finder_;
  Contacts source_;
  impulse::Advance advance_;
  impulse::SceneSettings scene_;
  Ids ids_;
  ContactTracker tracker_, newcomers_;         // of those that are awake, and of those that catch up
  std::vector<LiveContact> resting_contacts_;  // of those that rest
  Resting resting_;
  sync::SimTime now_{};
  bool found_ = false;  // contacts_ are those of the present poses, sought for steps of found_for_s_
  double found_for_s_ = 0, before_s_ = 0;  // and the length of the sub-step before
  std::vector<int> units_, awake_;            // ascending
  std::vector<char> mask_, supported_;        // of each body
  std::vector<BodyMotion> motions_, sought_;  // as they are, and as contacts were last sought for
  std::vector<Manifold> contacts_, solved_;
  std::vector<LiveContact> moved_;
  std::vector<int> list_;
  std::vector<SweptSphere> straight_;
  std::vector<std::pair<int, int>> touching_;
  std::vector<Eigen::Vector3d> places_;  // centres of the group's bodies at the end of each sub-step
};

}  // namespace tactus::sim
