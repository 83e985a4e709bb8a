// Where the visual steps are computed: in a thread of its own, below the haptic loop, or at once where they are
// asked for. What goes in and out goes by value; nobody waits for the other.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "sim_node/dual/visual_group.h"

namespace tactus::sim {

class VisualThread {
 public:
  explicit VisualThread(std::unique_ptr<VisualGroup> group);
  ~VisualThread();
  VisualThread(const VisualThread&) = delete;
  VisualThread& operator=(const VisualThread&) = delete;

  // A thread of its own from now on, scheduled as the caller is, but below it. Without it steps are computed
  // within ask(), the same way every time.
  void start();

  // Call when nothing is asked for or ready. The lists of the task are copied. Realtime-safe with a thread of its
  // own once the lists have grown.
  void ask(const VisualTask& task);
  // The step that was asked for, exchanged for the caller's old one, when it is there; never waits. Realtime-safe:
  // yes.
  bool take(std::unique_ptr<VisualStep>& step);
  bool asked() const { return asked_; }

  // For what happens while the world stands still: waits for the step that was asked for; it stays to be taken.
  VisualStep& finish();
  // Not while a step is being computed.
  VisualGroup& group() { return *group_; }

 private:
  enum State { kIdle, kAsked, kDone, kEnd };
  void loop();

  std::unique_ptr<VisualGroup> group_;
  VisualTask task_;
  std::unique_ptr<VisualStep> step_;
  bool asked_ = false;
  std::atomic<int> state_{kIdle};
  std::thread thread_;
};

}  // namespace tactus::sim
