// The core of the recorder: holds received messages back until the scene has arrived, then writes them, and counts losses.
// Pure, apart from the given sink.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tactus/asset_ref_t.hpp>
#include <tactus/log_info_t.hpp>

#include "sync/log/log_parts.h"
#include "sync/log/log_writer.h"
#include "sync/bus/message_batch.h"
#include "sync/tools/recorder/recorder_head.h"
#include "sync/bus/sequence.h"

namespace tactus::sync {

class Recorder {
 public:
  // The log begins without a scene after this time, or when this amount of data waits.
  static constexpr Nanoseconds kWaitForScene{5'000'000'000};
  static constexpr std::size_t kMaxPendingBytes = 32 << 20;
  // Number of channels in which gaps are counted; other channels are recorded all the same.
  static constexpr std::size_t kMaxChannels = 256;
  // Interval between attempts after a write error.
  static constexpr Nanoseconds kRetryAfter{1'000'000'000};

  // info: all but header and live_from_ns.
  Recorder(Identity identity, log_info_t info, LogWriter writer, HostTime start);
  // Splits and bounds the log. next opens the file of the next part (it may throw). prune receives the size of the present
  // part in bytes and removes the oldest parts beyond the limits; it returns the bytes of the kept parts before it.
  using Next = std::function<std::unique_ptr<LogSink>()>;
  using Prune = std::function<std::int64_t(std::int64_t)>;
  void limit(const LogLimits& limits, Next next, Prune prune);

  void push(const MessageBatch& batch);
  // The scene is complete: it is written to the head of the log, if that is not written yet, and to the heads of later parts.
  void begin(const std::vector<HeadAsset>& assets, HostTime now);
  // Call it every 100 ms or more often: begins the log when the wait for the scene is over, and writes pending data to disk.
  void poll(HostTime now);
  // Begins the log if it has not begun, and writes all data.
  void finish(HostTime now);

  bool started() const { return started_; }
  bool failing() const { return !writer_.error().empty() || !split_error_.empty(); }
  std::int64_t lost() const { return lost_before_ + writer_.lost(); }
  // Messages beyond the maximum size of the log.
  std::int64_t beyond() const { return beyond_; }
  int parts() const { return parts_; }
  // Messages missing in the numbering of their sender, over all channels.
  std::int64_t gaps() const;
  // One line: written data, and missing messages by channel.
  std::string status_text(std::int64_t tap_overflow, std::int64_t tap_oversized) const;

 private:
  struct PendingMessage {
    HostTime arrival;
    std::string channel;
    Bytes data;
  };
  void write(HostTime time, std::string_view channel, std::span<const std::uint8_t> data);
  void write_live(HostTime time, std::string_view channel, std::span<const std::uint8_t> data);
  void write_head(HostTime live_from);
  bool due_to_split(HostTime now) const;
  void split(HostTime now);
  std::int64_t events() const { return events_before_ + writer_.events(); }

  Identity identity_;
  log_info_t info_;
  LogWriter writer_;
  HostTime start_;
  bool started_ = false;
  std::vector<PendingMessage> pending_;
  std::size_t pending_bytes_ = 0;
  HostTime next_flush_{};
  LogLimits limits_;
  Next next_;
  Prune prune_;
  // The scene of the head, kept where later heads are possible.
  std::vector<asset_ref_t> scene_refs_;
  std::vector<Bytes> scene_bytes_;
  HostTime part_began_{};
  std::string split_error_;
  std::int64_t bytes_before_ = 0, events_before_ = 0, lost_before_ = 0, beyond_ = 0;
  int parts_ = 1;
  std::map<std::string, SequenceTracker, std::less<>> sequences_;
};

}  // namespace tactus::sync
