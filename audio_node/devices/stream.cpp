#include "audio_node/devices/stream.h"

#include <fcntl.h>
#include <pa_linux_alsa.h>
#include <portaudio.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <tactus/media_clock_t.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "sync/clocks/pacing.h"

namespace tactus::audio {
namespace {

static_assert(MediaPair::kStart == media_clock_t::START && MediaPair::kPeriodic == media_clock_t::PERIODIC &&
              MediaPair::kUnderflow == media_clock_t::UNDERFLOW);

constexpr sync::Nanoseconds kCallbackTimeout{500'000'000};
// A pause between callbacks of more than the buffer and this is an interruption, also where the card does not report
// an underflow: the process was stopped. Design.
constexpr double kPause_s = 0.05;
// Longest wait for the end of the sound when a stream is closed. Design: as long as a card without callbacks is not lost.
constexpr sync::Nanoseconds kEndTimeout{500'000'000};

void check(PaError error, const std::string& what) {
  if (error < 0)
    throw std::runtime_error(what + " (" + Pa_GetErrorText(error) +
                             "); choose another --audio-device or \"virtual\"");
}

constexpr int kMinChannels = 2;  // of a card that is listed by name

[[noreturn]] void reject_channels(const PaDeviceInfo& card, int channels) {
  throw std::runtime_error("the sound card \"" + std::string(card.name) + "\" has " +
                           std::to_string(card.maxOutputChannels) + " channels, but the loudspeakers need " +
                           std::to_string(channels) + "; choose another layout_file or --audio-device");
}

PaDeviceIndex find_device(const std::string& wanted, int channels) {
  if (wanted == "default") {
    const PaDeviceIndex index = Pa_GetDefaultOutputDevice();
    if (index == paNoDevice)
      throw std::runtime_error("no sound card can be opened; choose --audio-device virtual");
    return index;
  }
  std::string known;
  const PaDeviceInfo* few = nullptr;
  for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
    const PaDeviceInfo* info = Pa_GetDeviceInfo(i);
    if (info->maxOutputChannels < kMinChannels) continue;
    if (std::string(info->name).find(wanted) != std::string::npos) {
      if (info->maxOutputChannels >= channels) return i;
      few = info;
    }
    known += std::string(known.empty() ? "" : ", ") + info->name;
  }
  if (few) reject_channels(*few, channels);
  throw std::runtime_error("there is no sound card \"" + wanted + "\"; choose default, virtual" +
                           (known.empty() ? "" : " or one of: " + known));
}

// Without real-time priority a thread with short slices is scheduled sooner among busy ones: since Linux 6.12
// sched_runtime of a normal thread is its slice, 0.1 ms at least (sched(7), EEVDF). Older kernels ignore it.
void request_short_slice() {
  struct {
    std::uint32_t size, policy;
    std::uint64_t flags;
    std::int32_t nice;
    std::uint32_t priority;
    std::uint64_t runtime_ns, deadline_ns, period_ns;
  } attributes{};
  attributes.size = sizeof attributes;
  attributes.policy = SCHED_OTHER;
  attributes.nice = getpriority(PRIO_PROCESS, 0);
  attributes.runtime_ns = 100'000;
  syscall(SYS_sched_setattr, 0, &attributes, 0);
}

}  // namespace

struct Stream::PortAudio {
  PortAudio() { check(Pa_Initialize(), "PortAudio does not start"); }
  ~PortAudio() { Pa_Terminate(); }
};

std::string free_wav_name(const std::string& folder) {
  for (int n = 1;; ++n) {
    const std::string name = n == 1 ? "audio.wav" : "audio." + std::to_string(n) + ".wav";
    if (!std::filesystem::exists(std::filesystem::path(folder) / name)) return name;
  }
}

std::string recording_fault_of(const MediaPair& pair, const std::string& medium, int rate_Hz) {
  char time[32];
  std::snprintf(time, sizeof time, "%.1f s", static_cast<double>(pair.index) / rate_Hz);
  if (pair.reason == MediaPair::kSilent) return "the disk is too slow for the sound: " + std::string(time) + " of " + medium + " are silent";
  return "the disk refuses the sound (" + std::string(std::strerror(pair.underflows)) + "): " + medium + " ends after " + time;
}

Stream::Stream(const StreamOptions& options, Render render)
    : render_(std::move(render)),
      rate_Hz_(options.rate_Hz),
      channels_(options.channels),
      fifo_priority_(options.fifo_priority),
      edge_(options.rate_Hz),
      dac_(options.rate_Hz) {
  silence_sound_libraries();
  medium_ = free_wav_name(options.folder);
  const std::string wav = std::filesystem::path(options.folder) / medium_;
  if (pipe2(pairs_, O_CLOEXEC | O_NONBLOCK) != 0) throw std::runtime_error("cannot create a pipe; close some files");
  try {
    open(options, wav);
  } catch (...) {
    ::close(pairs_[0]), ::close(pairs_[1]);
    throw;
  }
}

void Stream::open(const StreamOptions& options, const std::string& wav) {
  const bool real = options.device != "virtual" && (options.device != "default" || has_sound_card());
  PaDeviceIndex device = paNoDevice;
  if (real) {
    try {
      portaudio_ = std::make_unique<PortAudio>();
      device = find_device(options.device, options.channels);
    } catch (const std::exception&) {
      portaudio_.reset();
      if (options.device != "default") throw;  // a card requested by name is not replaced silently
    }
  }
  if (!portaudio_) {
    virtual_card_ = std::make_unique<VirtualCard>(wav, options.rate_Hz, options.channels, pairs_[1]);
    portaudio_ = std::make_unique<PortAudio>();
    device = find_device(VirtualCard::kName, options.channels);
  }
  if (const PaDeviceInfo* info = Pa_GetDeviceInfo(device); info->maxOutputChannels < options.channels)
    reject_channels(*info, options.channels);
  card_ = virtual_card_ ? "virtual card" : Pa_GetDeviceInfo(device)->name;

  PaStreamParameters parameters{};
  parameters.device = device;
  parameters.channelCount = options.channels;
  parameters.sampleFormat = paFloat32;
  // A thread of normal priority wakes later: one period more.
  const double periods = options.latency_periods + (sync::is_realtime() ? 0 : 1);
  parameters.suggestedLatency = periods * options.period_frames / options.rate_Hz;
  check(Pa_OpenStream(&stream_, nullptr, &parameters, options.rate_Hz,
                      static_cast<unsigned long>(options.period_frames), paNoFlag, on_block, this),
        "the sound card \"" + card_ + "\" cannot be opened at " + std::to_string(options.rate_Hz) + " Hz");
  latency_s_ = Pa_GetStreamInfo(stream_)->outputLatency;
  try {
    if (!virtual_card_) tee_ = std::make_unique<Capture>(wav, options.rate_Hz, options.channels, pairs_[1]);
    last_ns_ = sync::to_ns(sync::host_now());
    check(Pa_StartStream(stream_), "the sound card \"" + card_ + "\" does not start");
  } catch (...) {
    Pa_CloseStream(stream_);
    throw;
  }
}

// The callback fades to silence; then the buffer plays. A card that is lost is silent already.
void Stream::end_quietly() {
  ends_ = true;
  sync::HostTime until = sync::host_now() + kEndTimeout;
  for (bool fades = true; alive(sync::host_now()) && sync::host_now() < until;) {
    if (fades && ended_) fades = false, until = std::min(until, sync::host_now() + sync::from_seconds(latency_s_));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

Stream::~Stream() {
  end_quietly();
  Pa_AbortStream(stream_);
  Pa_CloseStream(stream_);
  portaudio_.reset();
  virtual_card_.reset();
  tee_.reset();
  ::close(pairs_[0]), ::close(pairs_[1]);
}

bool Stream::alive(sync::HostTime now) const {
  return Pa_IsStreamActive(stream_) == 1 &&
         sync::to_ns(now) - last_ns_.load(std::memory_order_relaxed) < kCallbackTimeout.count();
}

std::optional<MediaPair> Stream::next_pair() {
  MediaPair pair;
  while (::read(pairs_[0], &pair, sizeof pair) == static_cast<ssize_t>(sizeof pair)) {
    if (pair.reason != MediaPair::kRefused && pair.reason != MediaPair::kSilent) return pair;
    recording_fault_ = recording_fault_of(pair, medium_, rate_Hz_);
  }
  return std::nullopt;
}

int Stream::on_block(const void*, void* out, unsigned long frames, const PaStreamCallbackTimeInfo* time,
                     unsigned long flags, void* self) {
  static_cast<Stream*>(self)->block(static_cast<float*>(out), static_cast<int>(frames), *time,
                                    (flags & paOutputUnderflow) != 0);
  return paContinue;
}

// The callback thread inherits the priority of the thread that opened the stream; this raises it to that of the
// callback.
void Stream::configure_thread() {
  thread_configured_ = true;
  if (!fifo_.enter(fifo_priority_)) request_short_slice();
}

void Stream::block(float* out, int frames, const PaStreamCallbackTimeInfo& time, bool underflow) {
  if (!thread_configured_) configure_thread();
  const sync::HostTime now = sync::host_now();
  const auto estimate =
      dac_.block(frames, {time.currentTime, time.outputBufferDacTime, now, underflow}, latency_s_);
  const double pause_s = sync::to_seconds(now - sync::host_time(last_ns_.load(std::memory_order_relaxed)));
  const bool interrupted = underflow || pause_s > latency_s_ + kPause_s + static_cast<double>(frames) / rate_Hz_;
  const BlockTime block_time{estimate.first_sample, estimate.uncertainty, render_time_, interrupted};
  render_(out, frames, block_time);
  if (ends_) edge_.end();
  edge_.apply(out, frames, channels_);
  if (edge_.ended()) ended_ = true;
  if (tee_) tee(out, frames, block_time, underflow);
  callbacks_.fetch_add(1, std::memory_order_relaxed);
  if (underflow) underflows_.fetch_add(1, std::memory_order_relaxed);
  last_ns_.store(sync::to_ns(now), std::memory_order_relaxed);
  const sync::HostTime done = sync::host_now();
  render_time_ = done - now;
  fifo_.tick(now, done);
}

void Stream::tee(const float* out, int frames, const BlockTime& time, bool underflow) {
  const std::int64_t index = tee_->frames();
  if (index >= next_pair_frame_ || underflow) {
    const auto reason = index == 0 ? MediaPair::kStart : underflow ? MediaPair::kUnderflow : MediaPair::kPeriodic;
    tee_->mark({index, sync::to_ns(time.first_sample), reason, static_cast<std::int32_t>(underflows())});
    next_pair_frame_ = index + rate_Hz_;
  }
  tee_->append(out, static_cast<std::size_t>(frames));
}

}  // namespace tactus::audio
