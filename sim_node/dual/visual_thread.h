// Runs the visual steps: on a thread with a priority below the haptic loop, or synchronously in request(). Tasks and
// steps are passed by value; neither side waits for the other.
#pragma once

#include <atomic>
#include <exception>
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

  // Starts the thread, with the scheduling of the caller but a lower priority. Without it, request() computes each
  // step itself, which is deterministic.
  void start();

  // Call only when no step is requested or ready. Copies the lists of the task. Realtime-safe with a running thread
  // once the lists have grown.
  void request(const VisualTask& task);
  // Exchanges the finished step for the caller's previous one; false when it is not ready. Never waits.
  // Realtime-safe: yes. Throws what the group threw while it computed the step.
  bool poll(std::unique_ptr<VisualStep>& step);
  bool requested() const { return requested_; }

  // Waits for the requested step; poll() still returns it. For use while the world is paused. Throws as poll().
  VisualStep& finish();
  // Not while a step is being computed.
  VisualGroup& group() { return *group_; }

 private:
  enum State { kIdle, kRequested, kDone, kEnd };
  void loop();
  void compute();

  std::unique_ptr<VisualGroup> group_;
  VisualTask task_;
  std::unique_ptr<VisualStep> step_;
  bool requested_ = false;
  std::exception_ptr failure_;  // of the step; written before the state is kDone
  std::atomic<int> state_{kIdle};
  std::thread thread_;
};

}  // namespace tactus::sim
