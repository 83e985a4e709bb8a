#include "sync/log/upgrade_log.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "sync/log/convert_message.h"
#include "sync/log/log_contract.h"
#include "sync/log/log_reader.h"
#include "sync/log/recorder_types.h"

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

}  // namespace

UpgradeCounts upgrade_log(ByteSpan log, std::unique_ptr<LogSink> sink) {
  std::vector<RecordedType> types = recorded_types(log);
  if (types.empty()) throw std::runtime_error("does not describe its message types (LOG_TYPES), so it cannot be converted");
  const MessageConverter converter(std::move(types));
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
    out.write(e, converted ? ByteSpan(*converted) : e.data);
  }
  out.flush();
  counts.events = out.events();
  counts.damaged_regions = scanner.damaged_regions();
  return counts;
}

}  // namespace tactus::sync
