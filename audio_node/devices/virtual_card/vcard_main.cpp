// vcard: a virtual sound card for machines without one, as a plug-in of libasound (external I/O plug-in).
//
//   in   samples, 32-bit float, from any ALSA program
//   out  the same samples in a WAV file, and (sample, host time) pairs on a pipe
//
// It plays at a constant rate on CLOCK_MONOTONIC: a late program gets a real underflow. An underflow inserts
// nothing into the file; the next pair holds the time at which playing resumed. Configuration:
//   pcm.NAME { type vcard  file "out.wav"  rate 48000  channels 2  pairs_fd 7 }
#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <poll.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <exception>
#include <memory>
#include <string>

#include "audio_node/mixer/capture.h"
#include "audio_node/devices/virtual_card/play_clock.h"

namespace {

using tactus::audio::Capture;
using tactus::audio::MediaPair;
using tactus::audio::PlayClock;

std::int64_t now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * PlayClock::kSecond + t.tv_nsec;
}

struct Card {
  snd_pcm_ioplug_t io{};
  std::string path;
  int pairs_fd = -1;
  int timer = -1;
  std::unique_ptr<Capture>
      capture;  // made at the first prepare, because programs open a card several times to inspect it
  PlayClock clock;
  std::int64_t first_index = 0;  // index in the file of the frame that is out at clock.start_ns
  std::int64_t next_pair = 0;    // seconds since the start at which the next pair is due
  std::int32_t underflows = 0;
  bool underflowed = false;

  ~Card() {
    if (timer >= 0) ::close(timer);
  }
  void wake_at(std::int64_t at_ns) {
    const itimerspec when{{0, 0}, {at_ns / PlayClock::kSecond, at_ns % PlayClock::kSecond}};
    timerfd_settime(timer, TFD_TIMER_ABSTIME, &when, nullptr);
  }
  void mark(std::int64_t seconds, MediaPair::Reason reason) {
    capture->mark({first_index + seconds * clock.rate_Hz, clock.start_ns + seconds * PlayClock::kSecond, reason,
                   underflows});
    next_pair = seconds + 1;
  }
};

Card& card_of(snd_pcm_ioplug_t* io) { return *static_cast<Card*>(io->private_data); }

int on_prepare(snd_pcm_ioplug_t* io) try {
  Card& card = card_of(io);
  if (!card.capture)
    card.capture = std::make_unique<Capture>(card.path, static_cast<int>(io->rate), static_cast<int>(io->channels),
                                             card.pairs_fd);
  card.wake_at(1);  // releases a program that polls before it starts
  return 0;
} catch (const std::exception& e) {
  SNDERR("vcard: %s", e.what());
  return -EIO;
}

int on_start(snd_pcm_ioplug_t* io) {
  Card& card = card_of(io);
  card.clock = {now_ns(), io->rate};
  card.first_index = card.capture->frames() - static_cast<std::int64_t>(io->appl_ptr);
  card.mark(0, card.underflowed ? MediaPair::kUnderflow : MediaPair::kStart);
  card.underflowed = false;
  card.wake_at(card.clock.time_of(static_cast<std::int64_t>(io->period_size)));
  return 0;
}

int on_stop(snd_pcm_ioplug_t* io) {
  card_of(io).wake_at(1);  // wakes a program that still polls
  return 0;
}

snd_pcm_sframes_t on_pointer(snd_pcm_ioplug_t* io) {
  Card& card = card_of(io);
  if (io->state == SND_PCM_STATE_PREPARED) return 0;  // also called before the start
  const std::int64_t now = now_ns(), written = static_cast<std::int64_t>(io->appl_ptr);
  const std::int64_t played = card.clock.position(now);
  if (played > written) {
    if (io->state == SND_PCM_STATE_DRAINING) return written;
    ++card.underflows;
    card.underflowed = true;
    return -EPIPE;
  }
  if (played >= card.next_pair * card.clock.rate_Hz) card.mark(played / card.clock.rate_Hz, MediaPair::kPeriodic);
  return played;
}

snd_pcm_sframes_t on_transfer(snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas, snd_pcm_uframes_t offset,
                              snd_pcm_uframes_t size) {
  const auto* first = static_cast<const char*>(areas[0].addr) + (areas[0].first + areas[0].step * offset) / 8;
  card_of(io).capture->append(reinterpret_cast<const float*>(first), size);
  return static_cast<snd_pcm_sframes_t>(size);
}

int on_poll(snd_pcm_ioplug_t* io, pollfd* fds, unsigned count, unsigned short* events) {
  Card& card = card_of(io);
  *events = 0;
  if (count != 1 || !(fds[0].revents & POLLIN)) return 0;
  std::uint64_t expired = 0;
  if (::read(card.timer, &expired, sizeof expired) < 0) return 0;
  *events = POLLOUT;
  if (io->state == SND_PCM_STATE_RUNNING || io->state == SND_PCM_STATE_DRAINING) {
    const auto period = static_cast<std::int64_t>(io->period_size);
    card.wake_at(card.clock.time_of((card.clock.position(now_ns()) / period + 1) * period));
  } else {
    card.wake_at(1);
  }
  return 0;
}

int on_close(snd_pcm_ioplug_t* io) {
  delete &card_of(io);
  return 0;
}

const snd_pcm_ioplug_callback_t* callbacks() {
  static const snd_pcm_ioplug_callback_t table = [] {
    snd_pcm_ioplug_callback_t t{};
    t.start = on_start, t.stop = on_stop, t.pointer = on_pointer, t.transfer = on_transfer, t.close = on_close;
    t.prepare = on_prepare, t.poll_revents = on_poll;
    return t;
  }();
  return &table;
}

// Parameters that a program may choose: float, interleaved, the configured rate and channels, 2 to 32 periods of
// 16 to 8192 frames.
int limit(snd_pcm_ioplug_t* io, unsigned rate, unsigned channels) {
  const unsigned access[] = {SND_PCM_ACCESS_MMAP_INTERLEAVED, SND_PCM_ACCESS_RW_INTERLEAVED};
  const unsigned format[] = {SND_PCM_FORMAT_FLOAT};
  const unsigned frame_bytes = channels * sizeof(float);
  int error = snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_ACCESS, 2, access);
  if (!error) error = snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_FORMAT, 1, format);
  const auto bound = [&](int what, unsigned low, unsigned high) {
    if (!error) error = snd_pcm_ioplug_set_param_minmax(io, what, low, high);
  };
  bound(SND_PCM_IOPLUG_HW_CHANNELS, channels, channels);
  bound(SND_PCM_IOPLUG_HW_RATE, rate, rate);
  bound(SND_PCM_IOPLUG_HW_PERIOD_BYTES, 16 * frame_bytes, 8192 * frame_bytes);
  bound(SND_PCM_IOPLUG_HW_PERIODS, 2, 32);
  bound(SND_PCM_IOPLUG_HW_BUFFER_BYTES, 32 * frame_bytes, 65536 * frame_bytes);
  return error;
}

struct Config {
  std::string file;
  long rate = 48000, channels = 2, pairs_fd = -1;
};

int read_config(snd_config_t* node, Config& config) {
  snd_config_iterator_t i, next;
  snd_config_for_each(i, next, node) {
    snd_config_t* entry = snd_config_iterator_entry(i);
    const char* key = nullptr;
    const char* text = nullptr;
    if (snd_config_get_id(entry, &key) < 0) continue;
    const std::string id = key;
    int error = 0;
    if (id == "comment" || id == "type" || id == "hint") continue;
    if (id == "file" && (error = snd_config_get_string(entry, &text)) == 0)
      config.file = text;
    else if (id == "rate")
      error = snd_config_get_integer(entry, &config.rate);
    else if (id == "channels")
      error = snd_config_get_integer(entry, &config.channels);
    else if (id == "pairs_fd")
      error = snd_config_get_integer(entry, &config.pairs_fd);
    else if (id != "file")
      error = -EINVAL;
    if (error < 0) {
      SNDERR("vcard: cannot use \"%s\"", key);
      return error;
    }
  }
  const bool ok = !config.file.empty() && config.rate >= 1000 && config.rate <= 384000 && config.channels >= 1 &&
                  config.channels <= 64;
  if (!ok) SNDERR("vcard: needs a file, 1000 <= rate <= 384000 and 1 <= channels <= 64");
  return ok ? 0 : -EINVAL;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) SND_PCM_PLUGIN_DEFINE_FUNC(vcard) {
  (void)root;
  Config config;
  if (const int error = read_config(conf, config); error < 0) return error;
  if (stream != SND_PCM_STREAM_PLAYBACK) return -ENODEV;

  auto card = std::make_unique<Card>();
  card->path = config.file;
  card->pairs_fd = static_cast<int>(config.pairs_fd);
  card->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  if (card->timer < 0) return -errno;
  card->io.version = SND_PCM_IOPLUG_VERSION;
  card->io.name = "Tactus virtual card";
  card->io.flags = SND_PCM_IOPLUG_FLAG_MONOTONIC | SND_PCM_IOPLUG_FLAG_BOUNDARY_WA;
  card->io.poll_fd = card->timer;
  card->io.poll_events = POLLIN;
  card->io.mmap_rw = 0;
  card->io.callback = callbacks();
  card->io.private_data = card.get();
  if (const int error = snd_pcm_ioplug_create(&card->io, name, stream, mode); error < 0) return error;
  if (const int error =
          limit(&card->io, static_cast<unsigned>(config.rate), static_cast<unsigned>(config.channels));
      error < 0) {
    snd_pcm_ioplug_delete(&card->io);  // calls on_close, which deletes the card
    card.release();
    return error;
  }
  *pcmp = card.release()->io.pcm;
  return 0;
}

__attribute__((visibility("default"))) SND_PCM_PLUGIN_SYMBOL(vcard);

}  // extern "C"
