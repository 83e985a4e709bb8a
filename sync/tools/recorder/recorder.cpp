#include "sync/tools/recorder/recorder.h"

#include <exception>

#include "sync/log/log_header.h"
#include "sync/text/printable.h"

namespace tactus::sync {

Recorder::Recorder(Identity identity, log_info_t info, LogWriter writer, HostTime start)
    : identity_(std::move(identity)), info_(std::move(info)), writer_(std::move(writer)), start_(start) {}

void Recorder::limit(const LogLimits& limits, Next next, Prune prune) {
  limits_ = limits;
  next_ = std::move(next);
  prune_ = std::move(prune);
}

void Recorder::write(HostTime time, std::string_view channel, std::span<const std::uint8_t> data) {
  if (limits_.max_bytes > 0 && bytes_before_ + writer_.bytes() > limits_.max_bytes && !limits_.splits()) {
    ++beyond_;
    return;
  }
  writer_.write((to_ns(time) + info_.realtime_offset_ns) / 1000, channel, data);
}

void Recorder::write_live(HostTime time, std::string_view channel, std::span<const std::uint8_t> data) {
  write(time, channel, data);
  if (limits_.split_bytes == 0 || writer_.bytes() < limits_.split_bytes) return;
  // A burst of messages must not fill a part beyond its size.
  if (!failing()) writer_.flush();
  if (due_to_split(time)) split(time);
}

void Recorder::push(const MessageBatch& batch) {
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const MessageBatch::Message m = batch[i];
    if (const auto header = peek_header(m.data.data(), m.data.size())) {
      auto it = sequences_.find(m.channel);
      if (it == sequences_.end() && sequences_.size() < kMaxChannels)
        it = sequences_.emplace(m.channel, SequenceTracker()).first;
      if (it != sequences_.end()) it->second.observe(*header);
    }
    if (started_) {
      write_live(m.arrival, m.channel, m.data);
      continue;
    }
    pending_.push_back({m.arrival, std::string(m.channel), Bytes(m.data.begin(), m.data.end())});
    pending_bytes_ += sizeof(PendingMessage) + m.channel.size() + m.data.size();
    if (pending_bytes_ > kMaxPendingBytes) begin({}, m.arrival);
  }
}

void Recorder::begin(const std::vector<HeadAsset>& assets, HostTime now) {
  if (started_ && !limits_.splits()) return;
  if (!started_ || !assets.empty()) {
    scene_refs_.clear(), scene_bytes_.clear();
    for (const HeadAsset& a : assets) scene_refs_.push_back(a.ref), scene_bytes_.push_back(*a.bytes);
  }
  if (started_) return;
  started_ = true;
  part_began_ = now;
  write_head(pending_.empty() ? now : pending_.front().arrival);
  for (const PendingMessage& m : pending_) write_live(m.arrival, m.channel, m.data);
  pending_.clear();
  pending_.shrink_to_fit();
  if (limits_.splits()) return;
  scene_refs_ = {}, scene_bytes_ = {};
}

void Recorder::write_head(HostTime live_from) {
  std::vector<HeadAsset> assets;
  for (std::size_t i = 0; i < scene_refs_.size(); ++i) assets.push_back({scene_refs_[i], &scene_bytes_[i]});
  for (const HeadEvent& e : log_head(identity_, info_, assets, live_from)) write(e.time, e.channel, e.data);
}

bool Recorder::due_to_split(HostTime now) const {
  return started_ && next_ && !failing() &&
         ((limits_.split_bytes > 0 && writer_.bytes() >= limits_.split_bytes) ||
          (limits_.split_after > Nanoseconds(0) && now - part_began_ >= limits_.split_after));
}

void Recorder::split(HostTime now) {
  try {
    std::unique_ptr<LogSink> sink = next_();
    events_before_ += writer_.events();
    lost_before_ += writer_.lost();
    writer_ = LogWriter(std::move(sink));
    ++parts_;
  } catch (const std::exception& e) {
    split_error_ = e.what();  // the present part continues
    next_flush_ = now + kRetryAfter;
  }
  part_began_ = now;
  if (split_error_.empty()) write_head(now);
}

void Recorder::poll(HostTime now) {
  if (now - start_ >= kWaitForScene) begin({}, now);
  if (now < next_flush_) return;
  writer_.flush();
  next_flush_ = failing() ? now + kRetryAfter : now;
  split_error_.clear();
  if (due_to_split(now)) split(now);
  if (prune_) bytes_before_ = prune_(writer_.bytes());
}

void Recorder::finish(HostTime now) {
  begin({}, now);
  writer_.flush();
}

std::int64_t Recorder::gaps() const {
  std::int64_t sum = 0;
  for (const auto& [channel, sequence] : sequences_) sum += sequence.gaps();
  return sum;
}

std::string Recorder::status_text(std::int64_t tap_overflow, std::int64_t tap_oversized) const {
  std::string text;
  if (failing()) text = "the disk refuses the log (" + writer_.error() + split_error_ + "); ";
  text += started_ ? std::to_string(events()) + " events" : "waits for the scene";
  if (parts_ > 1) text += " in " + std::to_string(parts_) + " parts";
  if (beyond_ > 0) text += ", " + std::to_string(beyond_) + " dropped, beyond the maximum size of the log";
  if (lost() > 0) text += ", " + std::to_string(lost()) + " lost because the disk is full or too slow";
  if (tap_overflow > 0) text += ", " + std::to_string(tap_overflow) + " lost because the recorder was too slow";
  if (tap_oversized > 0)
    text += ", " + std::to_string(tap_oversized) + " dropped, larger than any Tactus message";
  if (gaps() == 0) return text;
  text += ", gaps:";
  for (const auto& [channel, sequence] : sequences_)
    if (sequence.gaps() > 0 && text.size() < 300) text += " " + printable(channel) + " " + std::to_string(sequence.gaps());
  return text;
}

}  // namespace tactus::sync
