// Writes the samples that are played into a WAV file without doing I/O in the thread that plays them.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "audio_node/signal/spsc.h"

struct sf_private_tag;

namespace tactus::audio {

// Which sample of the WAV was out when. The reasons are those of media_clock_t.
struct MediaPair {
  enum Reason : std::int32_t { kStart = 0, kPeriodic = 1, kUnderflow = 2 };
  std::int64_t index;    // per channel, from 0
  std::int64_t host_ns;  // CLOCK_MONOTONIC
  std::int32_t reason;
  std::int32_t underflows;  // so far
};

// 32-bit float samples, exactly as given. A thread of its own, at normal priority, moves them from a ring to the
// file and corrects the file's header each time, so that it can be read even after a SIGKILL. Pairs leave through
// a pipe.
class Capture {
 public:
  // Throws std::runtime_error with one sentence when the file cannot be made. pairs_fd: non-blocking write end of
  // a pipe, -1: none; a full pipe loses the pair. Both stay the caller's.
  Capture(const std::string& path, int rate_Hz, int channels, int pairs_fd);
  ~Capture();  // writes what is left
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // Realtime-safe: yes. What the disk cannot take in time is replaced by silence and counted, so that indices
  // hold.
  void append(const float* interleaved, std::size_t frames);
  // Realtime-safe: yes.
  void mark(const MediaPair& pair) { pairs_.push(pair); }
  // Index of the next sample. Of the appending thread.
  std::int64_t frames() const { return frames_; }
  std::int64_t lost_frames() const { return lost_.load(std::memory_order_relaxed); }

 private:
  void write_on();
  void write_all();
  bool pay_silence();

  int channels_;
  int pairs_fd_;
  Spsc<float> samples_;
  Spsc<MediaPair> pairs_{64};
  std::int64_t frames_ = 0;
  std::int64_t owed_silence_ = 0;  // frames that did not fit and are still to be replaced
  std::atomic<std::int64_t> lost_{0};
  std::atomic<bool> stop_{false};
  sf_private_tag* file_ = nullptr;
  std::thread writer_;
};

}  // namespace tactus::audio
