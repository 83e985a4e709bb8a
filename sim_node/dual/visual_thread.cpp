#include "sim_node/dual/visual_thread.h"

#include <utility>

#include "sync/node/realtime.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sim {
namespace {

// design: below the haptic loop (50), above all that only shows (sync/node_descriptor.h).
constexpr int kPriority = 45;

}  // namespace

VisualThread::VisualThread(std::unique_ptr<VisualGroup> group)
    : group_(std::move(group)), step_(std::make_unique<VisualStep>()) {}

void VisualThread::start() {
  // In a virtual time computing takes none: a step is done when it is asked for.
  if (!thread_.joinable() && !sync::VirtualTime::current()) thread_ = std::thread([this] { loop(); });
}

VisualThread::~VisualThread() {
  if (!thread_.joinable()) return;
  // A step that is being computed is waited for.
  int state = state_.load();
  while (state == kAsked || !state_.compare_exchange_strong(state, kEnd)) {
    if (state == kAsked) state_.wait(kAsked);
    state = state_.load();
  }
  state_.notify_all();
  thread_.join();
}

void VisualThread::loop() {
  if (sync::is_realtime()) sync::set_realtime(sync::Realtime::kTry, kPriority);
  sync::OverrunGuard guard;
  while (true) {
    const int state = state_.load(std::memory_order_acquire);
    if (state == kEnd) return;
    if (state != kAsked) {
      state_.wait(state);
      continue;
    }
    const sync::HostTime began = sync::host_now();
    group_->run(task_, *step_);
    // Steps that take longer than they last would starve the machine.
    if (guard.tick(began, sync::host_now())) sync::leave_realtime();
    state_.store(kDone, std::memory_order_release);
    state_.notify_all();
  }
}

void VisualThread::ask(const VisualTask& task) {
  task_ = task;
  asked_ = true;
  if (!thread_.joinable()) {
    group_->run(task_, *step_);
    state_ = kDone;
    return;
  }
  state_.store(kAsked, std::memory_order_release);
  state_.notify_all();
}

bool VisualThread::take(std::unique_ptr<VisualStep>& step) {
  if (state_.load(std::memory_order_acquire) != kDone) return false;
  std::swap(step_, step);
  if (!step_) step_ = std::make_unique<VisualStep>();
  asked_ = false;
  state_.store(kIdle, std::memory_order_release);
  return true;
}

VisualStep& VisualThread::finish() {
  while (thread_.joinable() && state_.load(std::memory_order_acquire) == kAsked) state_.wait(kAsked);
  return *step_;
}

}  // namespace tactus::sim
