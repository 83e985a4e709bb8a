// A PortAudio stream that calls a renderer: the sound card of this machine, or the virtual one.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "audio_node/devices/card.h"
#include "audio_node/devices/dac_clock.h"
#include "audio_node/devices/sound_system.h"
#include "audio_node/signal/edge_fade.h"
#include "sync/node/realtime.h"

struct PaStreamCallbackTimeInfo;  // of PortAudio, whose header is included in stream.cpp only

namespace tactus::audio {

// One stream, from opening to closing; its WAV file holds everything that it plays.
class Stream : public Card {
 public:
  // Throws std::runtime_error with one sentence. render is called on the callback thread and must be
  // realtime-safe.
  Stream(const StreamOptions& options, Render render);
  ~Stream() override;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  // False when the card is lost or its callbacks have stopped for half a second.
  bool alive(sync::HostTime now) const override;
  std::int64_t callbacks() const override { return callbacks_.load(std::memory_order_relaxed); }
  std::int64_t underflows() const override { return underflows_.load(std::memory_order_relaxed); }
  const std::string& card() const override { return card_; }
  const std::string& medium() const override { return medium_; }
  std::optional<MediaPair> next_pair() override;
  std::string recording_fault() const override { return recording_fault_; }

 private:
  struct PortAudio;  // keeps PortAudio initialised while it exists
  void open(const StreamOptions& options, const std::string& wav);
  static int on_block(const void*, void* out, unsigned long frames, const PaStreamCallbackTimeInfo* time,
                      unsigned long flags, void* self);
  void block(float* out, int frames, const PaStreamCallbackTimeInfo& time, bool underflow);
  void end_quietly();
  void tee(const float* out, int frames, const BlockTime& time, bool underflow);
  void configure_thread();

  Render render_;
  int rate_Hz_, channels_;
  int fifo_priority_;
  std::string card_, medium_, recording_fault_;
  int pairs_[2] = {-1, -1};
  std::unique_ptr<VirtualCard> virtual_card_;
  std::unique_ptr<PortAudio> portaudio_;
  std::unique_ptr<Capture> tee_;  // of a real card; the virtual one captures by itself
  void* stream_ = nullptr;
  double latency_s_ = 0;
  std::atomic<std::int64_t> callbacks_{0}, underflows_{0}, last_ns_{0};

  std::atomic<bool> ends_{false}, ended_{false};  // requested by the destructor, and done by the callback

  // Used on the callback thread only.
  EdgeFade edge_;
  DacClock dac_;
  sync::FifoThread fifo_;
  bool thread_configured_ = false;
  std::int64_t next_pair_frame_ = 0;
  sync::Nanoseconds render_time_{0};  // by the previous block
};

// "audio.wav", or "audio.2.wav" and so on where that exists: a restarted node overwrites nothing.
std::string free_wav_name(const std::string& folder);

// Missing part of a file, from a pair with the reason kRefused or kSilent: "the disk refuses the sound (File too large): audio.wav ends after 1.0 s".
std::string recording_fault_of(const MediaPair& pair, const std::string& medium, int rate_Hz);

}  // namespace tactus::audio
