// Writes the played samples to a WAV file, without I/O on the thread that plays them.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "audio_node/signal/spsc.h"

struct sf_private_tag;

namespace tactus::audio {

// Host time at which a sample of the WAV was out. The reasons are those of media_clock_t, except two that are not published. kRefused: the
// disk refuses the samples from this index on, and `underflows` is the reason as errno. kSilent: `index` frames are silent in the file, because the disk was too slow.
struct MediaPair {
  enum Reason : std::int32_t { kStart = 0, kPeriodic = 1, kUnderflow = 2, kRefused = 3, kSilent = 4 };
  std::int64_t index;    // per channel, from 0
  std::int64_t host_ns;  // CLOCK_MONOTONIC
  std::int32_t reason;
  std::int32_t underflows;  // total until now
};

// Writes 32-bit float samples, unchanged. A separate thread of normal priority moves them from a ring to the file
// and updates the header of the file each time, so that the file is readable even after a SIGKILL. Pairs are
// written to a pipe.
class Capture {
 public:
  // Throws std::runtime_error with one sentence when the file cannot be made. pairs_fd: non-blocking write end of
  // a pipe, -1: none; a full pipe loses the pair. The caller keeps both ends.
  Capture(const std::string& path, int rate_Hz, int channels, int pairs_fd);
  ~Capture();  // writes the remaining samples
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // Realtime-safe: yes. Samples that the disk cannot take in time are replaced by silence and counted, so that
  // indices remain valid. Where the disk refuses samples, the file ends, and the rest is counted as lost.
  void append(const float* interleaved, std::size_t frames);
  // Realtime-safe: yes.
  void mark(const MediaPair& pair) { pairs_.push(pair); }
  // Index of the next sample. Call on the appending thread.
  std::int64_t frames() const { return frames_; }
  std::int64_t lost_frames() const { return late_.load(std::memory_order_relaxed) + refused_.load(std::memory_order_relaxed); }

 private:
  void run_writer();
  void write_all();
  void write(const float* samples, std::size_t count);
  void send(const MediaPair& pair) const;
  bool write_pending_silence();

  int channels_;
  int pairs_fd_;
  Spsc<float> samples_;
  Spsc<MediaPair> pairs_{64};
  std::int64_t frames_ = 0;
  // Of the writer: frames in the file, the last reported value of late_, and whether the file has ended.
  std::int64_t written_ = 0, reported_late_ = 0;
  bool ends_ = false;
  std::int64_t pending_silence_ = 0;  // lost frames that are still to be replaced by silence
  std::atomic<std::int64_t> late_{0}, refused_{0};  // lost frames: replaced by silence; behind the end of the file
  std::atomic<bool> stop_{false};
  sf_private_tag* file_ = nullptr;
  std::thread writer_;
};

}  // namespace tactus::audio
