#include "sync/log/upgrade_log.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/log/convert_message.h"
#include "sync/log/log_contract.h"
#include "sync/log/log_reader.h"
#include "sync/log/recorder_types.h"
#include "sync/log/split_page.h"

namespace tactus::sync {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::size_t kSinkBytes = 1 << 20;  // passed to the sink in one call

// True for the first page of LOG_TYPES; each part of a recording has one.
bool is_first_page(ByteSpan data) {
  return std::string_view(reinterpret_cast<const char*>(data.data()), data.size()).starts_with("tactus types, page 1 of ");
}

// Numbers the events again, because LOG_TYPES can have another number of pages.
class Output {
 public:
  explicit Output(std::unique_ptr<LogSink> sink) : sink_(std::move(sink)) {}
  void write(const LogEvent& e, ByteSpan data) {
    append_event(block_, events_++, e.timestamp_us, e.channel, data);
    if (block_.size() >= kSinkBytes) flush();
  }
  void flush() {
    const std::string reason = sink_->append(block_);
    if (!reason.empty()) throw std::runtime_error("cannot be converted: " + reason);
    block_.clear();
  }
  std::int64_t events() const { return events_; }

 private:
  std::unique_ptr<LogSink> sink_;
  std::vector<std::uint8_t> block_;
  std::int64_t events_ = 0;
};

// The fingerprint of a message; empty for fewer than 8 bytes.
ByteSpan fingerprint_of(ByteSpan message) { return message.first(std::min<std::size_t>(message.size(), 8)); }

// The fingerprints, in this release, of the types of which a converted message does not fit a datagram.
std::set<std::vector<std::uint8_t>> grown_types(ByteSpan log, const MessageConverter& converter) {
  std::set<std::vector<std::uint8_t>> grown;
  LogScanner scanner(log);
  for (LogEvent e; scanner.next(e);) {
    if (e.channel == kLogTypes) continue;
    const auto converted = converter.convert(e.data);
    if (!converted || converted->size() <= channels::kMaxMessageBytes) continue;
    const ByteSpan fingerprint = fingerprint_of(*converted);
    grown.emplace(fingerprint.begin(), fingerprint.end());
  }
  return grown;
}

}  // namespace

UpgradeCounts upgrade_log(ByteSpan log, std::unique_ptr<LogSink> sink) {
  std::vector<RecordedType> types = recorded_types(log);
  if (types.empty()) throw std::runtime_error("does not describe its message types (LOG_TYPES), so it cannot be converted");
  const MessageConverter converter(std::move(types));
  const auto grown = grown_types(log, converter);
  UpgradeCounts counts;
  Output out(std::move(sink));
  LogScanner scanner(log);
  for (LogEvent e; scanner.next(e);) {
    if (e.channel == kLogTypes) {
      if (!is_first_page(e.data)) continue;
      for (const std::string& page : log_types()) out.write(e, {reinterpret_cast<const std::uint8_t*>(page.data()), page.size()});
      continue;
    }
    const auto converted = converter.convert(e.data);
    counts.converted += converted.has_value();
    const ByteSpan fingerprint = converted ? fingerprint_of(*converted) : ByteSpan{};
    if (converted && grown.contains({fingerprint.begin(), fingerprint.end()})) {
      if (const auto halves = split_page(*converted)) {
        for (const auto& half : *halves) out.write(e, half);
        continue;
      }
    }
    out.write(e, converted ? ByteSpan(*converted) : e.data);
  }
  out.flush();
  counts.events = out.events();
  counts.damaged_regions = scanner.damaged_regions();
  return counts;
}

}  // namespace tactus::sync
