#include "audio_node/mixer/capture.h"

#include <pthread.h>
#include <sndfile.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "audio_node/mixer/sound_writer.h"

namespace tactus::audio {
namespace {

constexpr int kRingSeconds = 5;  // longest stall of the disk without loss
constexpr std::chrono::milliseconds kWritePeriod{20};

}  // namespace

Capture::Capture(const std::string& path, int rate_Hz, int channels, int pairs_fd)
    : channels_(channels),
      pairs_fd_(pairs_fd),
      samples_(static_cast<std::size_t>(kRingSeconds) * static_cast<std::size_t>(rate_Hz) *
               static_cast<std::size_t>(channels)) {
  SF_INFO info{};
  info.samplerate = rate_Hz;
  info.channels = channels;
  info.format = kFloatWav;
  file_ = open_for_writing(path, info, "--out");
  // The peak chunk holds the time of day, which would make two equal runs differ.
  sf_command(file_, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
  sf_command(file_, SFC_UPDATE_HEADER_NOW, nullptr, 0);
  writer_ = std::thread([this] { run_writer(); });
}

Capture::~Capture() {
  stop_ = true;
  writer_.join();
  sf_close(file_);
}

void Capture::append(const float* interleaved, std::size_t frames) {
  frames_ += static_cast<std::int64_t>(frames);
  if (write_pending_silence() && samples_.push(interleaved, frames * static_cast<std::size_t>(channels_))) return;
  pending_silence_ += static_cast<std::int64_t>(frames);
  late_.fetch_add(static_cast<std::int64_t>(frames), std::memory_order_relaxed);
}

// Replaces lost frames by silence. True when none remain.
bool Capture::write_pending_silence() {
  static constexpr std::array<float, 1024> kZeros{};
  while (pending_silence_ > 0) {
    const std::int64_t frames =
        std::min<std::int64_t>(pending_silence_, static_cast<std::int64_t>(kZeros.size()) / channels_);
    if (!samples_.push(kZeros.data(), static_cast<std::size_t>(frames * channels_))) return false;
    pending_silence_ -= frames;
  }
  return true;
}

void Capture::run_writer() {
  // The thread that opens a card may be a real-time one; this one must not be.
  const sched_param normal{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &normal);
  while (!stop_) {
    std::this_thread::sleep_for(kWritePeriod);
    write_all();
  }
  write_all();
}

void Capture::write_all() {
  std::array<float, 4096> buffer;
  const std::size_t whole =
      buffer.size() / static_cast<std::size_t>(channels_) * static_cast<std::size_t>(channels_);
  bool wrote = false;
  while (const std::size_t count = samples_.pop(buffer.data(), whole)) {
    write(buffer.data(), count);
    wrote = true;
  }
  if (const std::int64_t late = late_.load(std::memory_order_relaxed); late != reported_late_) {
    send({late, 0, MediaPair::kSilent, 0});
    reported_late_ = late;
  }
  if (wrote) sf_command(file_, SFC_UPDATE_HEADER_NOW, nullptr, 0);
  for (MediaPair pair; pairs_.pop(pair);) send(pair);
}

// The file ends where the disk refuses samples: later ones would have other indices in it.
void Capture::write(const float* samples, std::size_t count) {
  const auto wanted = static_cast<sf_count_t>(count);
  errno = 0;
  const sf_count_t written = ends_ ? 0 : sf_write_float(file_, samples, wanted);
  const int reason = errno != 0 ? errno : ENOSPC;
  written_ += written / channels_;
  if (written == wanted) return;
  refused_.fetch_add((wanted - written) / channels_, std::memory_order_relaxed);
  if (!std::exchange(ends_, true)) send({written_, 0, MediaPair::kRefused, reason});
}

void Capture::send(const MediaPair& pair) const {
  if (pairs_fd_ >= 0 && ::write(pairs_fd_, &pair, sizeof pair) != static_cast<ssize_t>(sizeof pair)) return;
}

}  // namespace tactus::audio
