// Values with the time since which each holds, the newest kValues of them. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace tactus::haptic {

template <class T>
class History {
 public:
  // At 4 kHz the last 0.25 s: more than the longest delay of a device.
  static constexpr std::size_t kValues = 1024;
  struct Entry {
    double time_s = 0;
    T value{};
  };

  void clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  // time_s: before the previous one, it counts as the same time. Realtime-safe: yes.
  void record(double time_s, const T& value) {
    entries_[next_] = {empty() ? time_s : std::max(time_s, entry(count_ - 1).time_s), value};
    next_ = (next_ + 1) % kValues;
    count_ = count_ < kValues ? count_ + 1 : kValues;
  }
  // Number of entries that began at or before a time. Realtime-safe: yes.
  std::size_t count_until(double time_s) const {
    std::size_t low = 0, high = count_;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      (entry(middle).time_s <= time_s ? low : high) = (entry(middle).time_s <= time_s) ? middle + 1 : middle;
    }
    return low;
  }
  // Entry i of the stored ones, the oldest first.
  const Entry& entry(std::size_t i) const { return entries_[(next_ + kValues - count_ + i) % kValues]; }
  std::size_t size() const { return count_; }
  // The value that held at a time; before the first entry: a value of T{}.
  T at(double time_s) const {
    const std::size_t count = count_until(time_s);
    return count > 0 ? entry(count - 1).value : T{};
  }

 private:
  std::array<Entry, kValues> entries_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace tactus::haptic
