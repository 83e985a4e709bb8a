// Renders strikes into samples: the pure heart of the audio callback, usable without a sound card.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <tactus/presentation_t.hpp>

#include "audio_node/signal/dropout.h"
#include "audio_node/signal/level_limiter.h"
#include "audio_node/signal/limiter.h"
#include "audio_node/mixer/recorded.h"
#include "audio_node/mixer/scheduler.h"
#include "audio_node/mixer/scrapes.h"
#include "audio_node/signal/spsc.h"
#include "audio_node/mixer/voices.h"
#include "sync/presentation/late.h"
#include "sync/node/quality.h"

namespace tactus::audio {

// When the first sample of a block is physically out, and how surely that is known.
struct BlockTime {
  sync::HostTime first_sample{};
  sync::Nanoseconds uncertainty{0};
  sync::Nanoseconds used{0};  // what rendering the block before took; 0: not known
};

// The quality ladder of sound.
inline constexpr std::array<VoiceLimits, 3> kQualities{{{128, 1}, {64, 2}, {32, 4}}};

// What the node's loop wants of the callback; the newest counts.
struct RenderCommand {
  DropoutDef dropout;
  int quality = -1;  // step of the ladder to hold; -1: by the time that blocks take

  bool operator==(const RenderCommand&) const = default;
};

// What one way of making sound has cost so far.
struct MethodCost {
  std::atomic<std::int64_t> ns{0};        // of the callback's time; stays 0 without a clock
  std::atomic<std::int64_t> contacts{0};  // impacts, and contacts that scrape or roll
};

// What ears were given so far.
struct ExposureMeter {
  std::atomic<double> exposure_Pa2_s{0};  // A-weighted
  std::atomic<double> gain{1};            // by which it was turned down last
  static_assert(std::atomic<double>::is_always_lock_free);
};

// What crosses between the node's loop and the callback.
struct CallbackQueues {
  Spsc<Strike> strikes{512};
  // The callback holds no strike of a scene of a number below this, and will never again: its table may go.
  std::atomic<std::int64_t> strikes_let_go{0};
  Spsc<RenderCommand> orders{16};
  Spsc<Listener> listeners{64};  // the newest counts
  Spsc<Scrape> scrapes{kTellings * 2 * Scrapes::kMax};
  // The callback holds no scrape of a number below this, and will never again: what only they point to may go.
  std::atomic<std::int64_t> scrapes_let_go{0};
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
  RecordedQueues recorded;
  Spsc<presentation_t> reports{4096};
  std::atomic<std::int64_t> reports_lost{0};  // which did not fit
  std::atomic<int> quality{0};                // step in use
  static_assert(std::atomic<int>::is_always_lock_free);
  std::array<MethodCost, 2> costs;  // of what is computed, of what is recorded
  ExposureMeter heard;
};

// A sound that comes late is weaker, to nothing at the limit: the ear would take its full strength for another
// impact.
inline constexpr sync::Late kLate = sync::Late::kPlayWithFade;
sync::LatePolicy late_policy(double rate_Hz, sync::Nanoseconds limit);

struct RendererDef {
  double rate_Hz = 48000;
  int period_frames = 128;  // of one call, usually
  double ceiling = 0.9;
  HearingDef hearing = {};  // whether channels are ears says the space
  sync::LatePolicy late = late_policy(48000, sync::Nanoseconds(30'000'000));
  Instructions instructions = available_instructions().back();
  Space space = {};
  std::int64_t (*clock_ns)() = nullptr;  // to tell costs by; null: nobody asks
  bool silent = false;  // no sample is computed: each strike is reported as if it were, on its sample
};

// How many of the frames that are left are rendered next: blocks as even as can be, since what goes over within a
// block would leap in one of a single frame.
constexpr int next_block(int frames_left) { return frames_left / ((frames_left + kMaxBlock - 1) / kMaxBlock); }

// Same strikes, same blocks, same times: the same samples to the bit.
class Renderer {
 public:
  Renderer(CallbackQueues& crossing, const RendererDef& def);

  // Of the samples, interleaved.
  int channels() const { return channels_; }
  // Fills `frames` frames and reports what became of each strike. A strike that is due before what can
  // still be changed is played at once, as weak as the policy says, and called late, or dropped; one whose onset a
  // drop-out silences was dropped by the profile. Realtime-safe: yes.
  void render(float* out, int frames, const BlockTime& time);

  // What waits will never sound: reports all strikes as dropped, and holds no scrape. Of the loop's thread, once
  // the callback has ended.
  void abandon();

  int sounding() const { return voices_.active(); }
  int scraping() const { return scrapes_.active(); }
  int recorded() const { return recorded_.active(); }

 private:
  void take_orders();
  void adapt(int frames, sync::Nanoseconds used);
  void render_some(float* out, int frames, const BlockTime& time);
  void sound_some(float* out, int frames, sync::HostTime leaving);
  void take_scrapes(sync::HostTime until);
  void let_go_of_strikes();
  void let_go_of_scrapes();
  void limit(float* out, int frames);
  void begin(const Strike& strike, int frames, const BlockTime& time);
  void report(const Strike& strike, std::int8_t outcome, std::int64_t presented_ns, sync::Nanoseconds uncertainty);
  sync::Nanoseconds samples(int count) const;
  std::int64_t clock() const { return clock_ns_ ? clock_ns_() : 0; }

  CallbackQueues& crossing_;
  double rate_Hz_;
  int channels_;
  int delay_;  // frames from what is rendered to what leaves
  bool silent_;
  sync::LatePolicy late_;
  Scheduler scheduler_{512};
  std::int64_t newest_scene_;  // of the strikes that were taken out of the queue
  Voices voices_;
  Scrapes scrapes_;
  Recorded recorded_;
  std::int64_t (*clock_ns_)();
  std::optional<Scrape> next_scrape_;  // taken, but not yet to be heard
  std::int64_t scrapes_taken_;         // out of the queue, with those of the renderers before
  Dropout dropout_;
  std::array<float, kMaxBlock> open_{};  // factors of the drop-out on the samples that are being rendered
  Limiter limiter_;
  LevelLimiter level_limiter_;
  sync::QualityLadder ladder_;
  int pinned_ = -1;
  int last_frames_ = 0;        // of the block before
  int frames_ = 0;             // that the ladder has not been told of,
  sync::Nanoseconds used_{0};  // and what they took
};

}  // namespace tactus::audio
