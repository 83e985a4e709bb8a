// A bounded lock-free queue from one thread to another: the only connection with the audio callback.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace tactus::audio {

// Elements are copied. One thread pushes, one pops. Realtime-safe: yes, except the constructor.
template <class T>
class Spsc {
  static_assert(std::is_trivially_destructible_v<T>);  // owns nothing: copying it allocates nothing

 public:
  explicit Spsc(std::size_t min_capacity) : slots_(std::bit_ceil(std::max<std::size_t>(min_capacity, 2))) {}
  Spsc(const Spsc&) = delete;
  Spsc& operator=(const Spsc&) = delete;

  // False, without a change, when it does not fit.
  bool push(const T& value) { return push(&value, 1); }
  bool push(const T* values, std::size_t count) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (count > slots_.size() - (head - tail_.load(std::memory_order_acquire))) return false;
    for (std::size_t i = 0; i < count; ++i) slots_[(head + i) & (slots_.size() - 1)] = values[i];
    head_.store(head + count, std::memory_order_release);
    return true;
  }

  // Number of elements taken, 0 when empty.
  bool pop(T& value) { return pop(&value, 1) == 1; }
  std::size_t pop(T* values, std::size_t max_count) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(max_count, head_.load(std::memory_order_acquire) - tail);
    for (std::size_t i = 0; i < count; ++i) values[i] = slots_[(tail + i) & (slots_.size() - 1)];
    tail_.store(tail + count, std::memory_order_release);
    return count;
  }

  std::size_t capacity() const { return slots_.size(); }
  // Free room for the pushing thread; it can only grow until its next push.
  std::size_t room() const {
    return slots_.size() - (head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire));
  }

 private:
  static_assert(std::atomic<std::size_t>::is_always_lock_free);
  std::vector<T> slots_;
  // On separate cache lines, so that the two threads do not contend for one.
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace tactus::audio
