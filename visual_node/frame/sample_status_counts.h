// Counts how the poses of the drawn bodies were obtained: by reception, interpolation or prediction. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "sync/resampling/sample_status.h"

namespace tactus::visual {

class SampleStatusCounts {
 public:
  void add(sync::SampleStatus status) { ++counts_[static_cast<std::size_t>(status)]; }
  std::int64_t of(sync::SampleStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  // One line, in percent of all; empty: no samples.
  std::string text() const {
    std::int64_t all = 0;
    for (const std::int64_t n : counts_) all += n;
    std::string line;
    for (std::size_t i = 0; i < counts_.size() && all > 0; ++i)
      if (counts_[i] > 0)
        line += (line.empty() ? "" : ", ") + std::to_string(100 * counts_[i] / all) + " % " +
                sync::to_string(static_cast<sync::SampleStatus>(i));
    return line;
  }

 private:
  std::array<std::int64_t, 6> counts_{};  // by sync::SampleStatus
};

}  // namespace tactus::visual
