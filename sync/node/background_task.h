// Runs a factory function on a background thread, because construction may take long or block forever: PortAudio 19.6 waits
// without limit for the first callback of a card that opens but does not start; a file may lie on a network. The owner polls
// done(); no loop blocks. In virtual time the factory runs immediately: its duration depends on the machine.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {

template <class T>
class BackgroundTask {
 public:
  // make runs in the new thread and owns everything that it uses: it may outlive this object.
  explicit BackgroundTask(std::function<std::unique_ptr<T>()> make) : state_(std::make_shared<State>()) {
    auto opens = [state = state_, make = std::move(make)] {
      try {
        state->made = make();
      } catch (...) {
        state->error = std::current_exception();
      }
      state->done.store(true, std::memory_order_release);
    };
    if (VirtualTime::current())
      opens();
    else
      std::thread(std::move(opens)).detach();
  }

  // True once make has returned or thrown.
  bool done() const { return state_->done.load(std::memory_order_acquire); }
  // The result; rethrows the exception of make. Call it once, only when done().
  std::unique_ptr<T> take() {
    if (state_->error) std::rethrow_exception(state_->error);
    return std::move(state_->made);
  }

 private:
  struct State {
    std::atomic<bool> done{false};
    std::unique_ptr<T> made;
    std::exception_ptr error;
  };
  std::shared_ptr<State> state_;
};

}  // namespace tactus::sync
