#include "sim_node/dual/visual_thread.h"

#include <utility>

#include "sync/clocks/pacing.h"
#include "sync/node/realtime.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sim {
namespace {

// design: below the haptic loop (50), above the nodes that only display (sync/node/node_descriptor.h).
constexpr int kPriority = 45;

}  // namespace

VisualThread::VisualThread(std::unique_ptr<VisualGroup> group)
    : group_(std::move(group)), step_(std::make_unique<VisualStep>()) {}

void VisualThread::start() {
  // In virtual time computation takes no time: request() computes the step immediately.
  if (!thread_.joinable() && !sync::VirtualTime::current()) thread_ = std::thread([this] { loop(); });
}

VisualThread::~VisualThread() {
  if (!thread_.joinable()) return;
  // Waits for a step that is being computed.
  int state = state_.load();
  while (state == kRequested || !state_.compare_exchange_strong(state, kEnd)) {
    if (state == kRequested) state_.wait(kRequested);
    state = state_.load();
  }
  state_.notify_all();
  thread_.join();
}

// An exception must not end the thread, which would end the process without a sentence.
void VisualThread::compute() {
  try {
    group_->run(task_, *step_);
  } catch (...) {
    failure_ = std::current_exception();
  }
}

void VisualThread::loop() {
  sync::FifoThread fifo;
  fifo.enter(kPriority);
  while (true) {
    const int state = state_.load(std::memory_order_acquire);
    if (state == kEnd) return;
    if (state != kRequested) {
      state_.wait(state);
      continue;
    }
    const sync::HostTime began = sync::host_now();
    compute();
    // Steps that take longer than their own length would starve the machine.
    fifo.tick(began, sync::host_now());
    state_.store(kDone, std::memory_order_release);
    state_.notify_all();
  }
}

void VisualThread::request(const VisualTask& task) {
  task_ = task;
  requested_ = true;
  if (!thread_.joinable()) {
    compute();
    state_ = kDone;
    return;
  }
  state_.store(kRequested, std::memory_order_release);
  state_.notify_all();
}

bool VisualThread::poll(std::unique_ptr<VisualStep>& step) {
  if (state_.load(std::memory_order_acquire) != kDone) return false;
  if (failure_) std::rethrow_exception(failure_);
  std::swap(step_, step);
  if (!step_) step_ = std::make_unique<VisualStep>();
  requested_ = false;
  state_.store(kIdle, std::memory_order_release);
  return true;
}

VisualStep& VisualThread::finish() {
  while (thread_.joinable() && state_.load(std::memory_order_acquire) == kRequested) state_.wait(kRequested);
  if (failure_) std::rethrow_exception(failure_);
  return *step_;
}

}  // namespace tactus::sim
