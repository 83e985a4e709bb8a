// Reads the log of a finished run.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "sync/bus/decode.h"
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"

namespace tactus::cluster {

// A span of CLOCK_MONOTONIC, ns.
struct Span {
  std::int64_t from_ns, to_ns;
  // Of an empty loop of 1000 Hz in the same time: its rate, and the 99th percentile of its steps. 0: not measured.
  double machine_Hz = 0, machine_p99_ms = 0;
  bool contains(std::int64_t ns) const { return ns >= from_ns && ns < to_ns; }
  double seconds() const { return static_cast<double>(to_ns - from_ns) * 1e-9; }
};

class RunLog {
 public:
  explicit RunLog(const std::filesystem::path& out) : file_(out / "run.lcmlog") {}

  // Every message of a channel, in the order of the log.
  template <class Message>
  void for_each(const char* channel, const auto& handle) const {
    sync::LogScanner scanner(file_.bytes());
    for (sync::LogEvent e; scanner.next(e);)
      if (e.channel == channel)
        if (const auto m = sync::decode<Message>(e.data.data(), e.data.size())) handle(*m);
  }
  // The messages that were sent within a span.
  template <class Message>
  void for_each(const char* channel, const Span& span, const auto& handle) const {
    for_each<Message>(channel, [&](const Message& m) {
      if (span.contains(m.header.publish_time_ns)) handle(m);
    });
  }

 private:
  sync::MappedLog file_;
};

// The value at or below which a share q of x lies; 0: x is empty.
inline double quantile(std::vector<double> x, double q) {
  if (x.empty()) return 0;
  const auto at = std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())));
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(at), x.end());
  return x[at];
}

// Differences of consecutive times, ms.
inline std::vector<double> steps_ms(const std::vector<std::int64_t>& times_ns) {
  std::vector<double> out;
  for (std::size_t i = 1; i < times_ns.size(); ++i)
    out.push_back(static_cast<double>(times_ns[i] - times_ns[i - 1]) * 1e-6);
  return out;
}

}  // namespace tactus::cluster
