// A coroutine with its own stack, with the annotations that the sanitizers need. Not thread-safe.
#pragma once

#include <boost/context/fiber.hpp>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace tactus::sync {

class StackSwitch {
 public:
  // body starts at the first resume(); it must not throw.
  StackSwitch(std::size_t bytes, std::function<void()> body) : body_(std::move(body)) {
    boost::context::protected_fixedsize_stack allocator(bytes);
    const boost::context::stack_context stack = allocator.allocate();
    bottom_ = static_cast<char*>(stack.sp) - stack.size;
    size_ = stack.size;
    own_ = boost::context::fiber(std::allocator_arg, boost::context::preallocated(stack.sp, stack.size, stack), allocator,
                                 [this](boost::context::fiber&& other) {
                                   other_ = std::move(other);
                                   arrived(nullptr);
                                   body_();
                                   leaves(nullptr);
                                   return std::move(other_);
                                 });
#if defined(__SANITIZE_THREAD__)
    tsan_ = __tsan_create_fiber(0);
#endif
  }
  // Only when body has returned, or never started.
  ~StackSwitch() {
#if defined(__SANITIZE_THREAD__)
    __tsan_destroy_fiber(tsan_);
#endif
  }
  StackSwitch(const StackSwitch&) = delete;
  StackSwitch& operator=(const StackSwitch&) = delete;

  // Continues body until it yields or returns.
  void resume() {
#if defined(__SANITIZE_ADDRESS__)
    void* kept = nullptr;
    __sanitizer_start_switch_fiber(&kept, bottom_, size_);
#endif
#if defined(__SANITIZE_THREAD__)
    tsan_other_ = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(tsan_, 0);
#endif
    own_ = std::move(own_).resume();
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_finish_switch_fiber(kept, nullptr, nullptr);
#endif
  }
  // Called in body: continues the caller of resume().
  void yield() {
    void* kept = nullptr;
    leaves(&kept);
    other_ = std::move(other_).resume();
    arrived(kept);
  }

 private:
  // Stores the stack of the other side, which is known only after a switch from there.
  void arrived([[maybe_unused]] void* kept) {
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_finish_switch_fiber(kept, &other_bottom_, &other_size_);
#endif
  }
  void leaves([[maybe_unused]] void** kept) {
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_start_switch_fiber(kept, other_bottom_, other_size_);
#endif
#if defined(__SANITIZE_THREAD__)
    __tsan_switch_to_fiber(tsan_other_, 0);
#endif
  }

  std::function<void()> body_;
  boost::context::fiber own_, other_;
  const void* bottom_ = nullptr;
  std::size_t size_ = 0;
#if defined(__SANITIZE_ADDRESS__)
  const void* other_bottom_ = nullptr;
  std::size_t other_size_ = 0;
#endif
#if defined(__SANITIZE_THREAD__)
  void* tsan_ = nullptr;
  void* tsan_other_ = nullptr;
#endif
};

}  // namespace tactus::sync
