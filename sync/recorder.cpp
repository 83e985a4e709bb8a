#include "sync/recorder.h"

#include "sync/log_header.h"

namespace tactus::sync {

Recorder::Recorder(Identity identity, log_info_t info, LogWriter writer, HostTime start)
    : identity_(std::move(identity)), info_(std::move(info)), writer_(std::move(writer)), start_(start) {}

void Recorder::write(HostTime time, std::string_view channel, std::span<const std::uint8_t> data) {
  writer_.write((to_ns(time) + info_.realtime_offset_ns) / 1000, channel, data);
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
    if (begun_) {
      write(m.arrival, m.channel, m.data);
      continue;
    }
    held_.push_back({m.arrival, std::string(m.channel), Bytes(m.data.begin(), m.data.end())});
    held_bytes_ += sizeof(Held) + m.channel.size() + m.data.size();
    if (held_bytes_ > kMaxHeldBytes) begin({}, m.arrival);
  }
}

void Recorder::begin(const std::vector<HeadAsset>& assets, HostTime now) {
  if (begun_) return;
  begun_ = true;
  const HostTime live_from = held_.empty() ? now : held_.front().arrival;
  for (const HeadEvent& e : log_head(identity_, info_, assets, live_from)) write(e.time, e.channel, e.data);
  for (const Held& m : held_) write(m.arrival, m.channel, m.data);
  held_.clear();
  held_.shrink_to_fit();
}

void Recorder::poll(HostTime now) {
  if (now - start_ >= kWaitForScene) begin({}, now);
  if (now < next_flush_) return;
  writer_.flush();
  next_flush_ = failing() ? now + kRetryAfter : now;
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

std::string Recorder::note(std::int64_t tap_overflow, std::int64_t tap_oversized) const {
  std::string text;
  if (failing()) text = "the disk refuses the log (" + writer_.trouble() + "); ";
  text += begun_ ? std::to_string(writer_.events()) + " events" : "waits for the scene";
  if (writer_.lost() > 0) text += ", " + std::to_string(writer_.lost()) + " lost for want of disk";
  if (tap_overflow > 0) text += ", " + std::to_string(tap_overflow) + " lost for want of time";
  if (tap_oversized > 0)
    text += ", " + std::to_string(tap_oversized) + " left out, larger than any message of ours";
  if (gaps() == 0) return text;
  text += ", gaps:";
  for (const auto& [channel, sequence] : sequences_)
    if (sequence.gaps() > 0 && text.size() < 300) text += " " + channel + " " + std::to_string(sequence.gaps());
  return text;
}

}  // namespace tactus::sync
