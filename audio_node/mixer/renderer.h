// Renders strikes and contacts into samples: the pure part of the audio callback, usable without a sound card.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <tactus/presentation_t.hpp>

#include "audio_node/signal/dropout.h"
#include "audio_node/signal/edge_fade.h"
#include "audio_node/signal/level_limiter.h"
#include "audio_node/signal/limiter.h"
#include "audio_node/mixer/recording_player.h"
#include "audio_node/mixer/scheduler.h"
#include "audio_node/mixer/scrapes.h"
#include "audio_node/signal/spsc.h"
#include "audio_node/mixer/voices.h"
#include "sync/presentation/late.h"
#include "sync/node/quality.h"

namespace tactus::audio {

// Time at which the first sample of a block is physically out, and its uncertainty.
struct BlockTime {
  sync::HostTime first_sample{};
  sync::Nanoseconds uncertainty{0};
  sync::Nanoseconds render_time{0};  // rendering time of the previous block; 0: not known
  bool interrupted = false;          // the card did not play continuously before this block
};

// The quality ladder of sound.
inline constexpr std::array<VoiceLimits, 3> kQualities{{{128, 1}, {64, 2}, {32, 4}}};

// Command from the loop of the node to the callback; the newest applies.
struct RenderCommand {
  DropoutDef dropout;
  int quality = -1;  // step of the ladder to hold; -1: chosen from the block times

  bool operator==(const RenderCommand&) const = default;
};

// Accumulated cost of one method.
struct MethodCost {
  std::atomic<std::int64_t> ns{0};        // of the callback; stays 0 without a clock
  std::atomic<std::int64_t> contacts{0};  // impacts, and contacts that scrape or roll
};

// Accumulated sound exposure and current gain.
struct ExposureMeter {
  std::atomic<double> exposure_Pa2_s{0};  // A-weighted
  std::atomic<double> gain{1};            // latest gain of the level limiter
  static_assert(std::atomic<double>::is_always_lock_free);
};

// Queues and counters between the loop of the node and the callback.
struct CallbackQueues {
  Spsc<Strike> strikes{512};
  // The callback holds no strike of a scene with a lower number, and will receive none: their tables may be freed.
  std::atomic<std::int64_t> oldest_held_scene{0};
  Spsc<RenderCommand> commands{16};
  Spsc<Listener> listeners{64};  // the newest applies
  Spsc<Scrape> scrapes{kMaxQueuedUpdates * 2 * Scrapes::kMax};
  // The callback holds no scrape with a lower number, and will receive none: the data of those scrapes may be
  // freed.
  std::atomic<std::int64_t> oldest_held_scrape{0};
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
  RecordedQueues recorded;
  Spsc<presentation_t> reports{4096};
  std::atomic<std::int64_t> reports_lost{0};  // reports that did not fit
  std::atomic<int> quality{0};                // step in use
  static_assert(std::atomic<int>::is_always_lock_free);
  std::array<MethodCost, 2> costs;  // of computed sound, of recorded sound
  ExposureMeter exposure;
};

// A late sound is weaker, down to zero at the limit: at full strength the ear would take it for another impact.
inline constexpr sync::LateRule kLatePolicy = sync::LateRule::kPlayWithFade;
sync::LatePolicy late_policy(double rate_Hz, sync::Nanoseconds limit);

struct RendererDef {
  double rate_Hz = 48000;
  int period_frames = 128;  // usual length of one call
  double ceiling = 0.9;
  LevelLimiterDef level_limit = {};  // the space determines whether channels are ears
  sync::LatePolicy late = late_policy(48000, sync::Nanoseconds(30'000'000));
  Instructions instructions = available_instructions().back();
  Space space = {};
  std::int64_t (*clock_ns)() = nullptr;  // for the costs; null: costs are not measured
  bool silent = false;  // computes no samples: each strike is reported as if it were rendered, on its sample
};

// Length of the next block for the remaining frames. Blocks have almost equal lengths, because the crossfade of a
// block of one frame would be a jump.
constexpr int next_block(int frames_left) { return frames_left / ((frames_left + kMaxBlock - 1) / kMaxBlock); }

// Equal strikes, blocks and times give bit-identical samples.
class Renderer {
 public:
  Renderer(CallbackQueues& queues, const RendererDef& def);

  // Channels of the interleaved samples.
  int channels() const { return channels_; }
  // Fills `frames` frames and reports the outcome of each strike. A strike that is due before the earliest sample
  // is played immediately, weakened by the policy, and reported as late, or dropped. A strike whose onset falls
  // into a drop-out is reported as dropped by the profile. After an interruption the sound fades in. After one of more
  // than kForget, sounds of before do not return. Realtime-safe: yes.
  void render(float* out, int frames, const BlockTime& time);

  // Reports all waiting strikes as dropped and releases all scrapes. Call on the loop thread, after the callback
  // has ended.
  void abandon();

  int sounding() const { return voices_.active(); }
  int scraping() const { return scrapes_.active(); }
  int recorded() const { return recordings_.active(); }

  // Exposure of the current second beyond the floor of the level limiter, Pa^2 s, for the renderer that follows
  // (LevelLimiterDef::spent_Pa2_s). Call after the callback has ended.
  double spent_Pa2_s() const { return level_limiter_.spent_Pa2_s(); }

  // Design: a gap in which sounds end for the listener.
  static constexpr sync::Nanoseconds kForget{100'000'000};

 private:
  void resume(const BlockTime& time);
  void receive_commands();
  void adapt(int frames, sync::Nanoseconds render_time);
  void render_block(float* out, int frames, const BlockTime& time);
  void render_sound(float* out, int frames, sync::HostTime leaving);
  void receive_scrapes(sync::HostTime until);
  int frames_to_next_scrape(sync::HostTime first, int frames_left) const;
  void release_strikes();
  void release_scrapes();
  void limit(float* out, int frames);
  void begin(const Strike& strike, int frames, const BlockTime& time);
  void report(const Strike& strike, std::int8_t outcome, std::int64_t presented_ns, sync::Nanoseconds uncertainty);
  sync::Nanoseconds samples(int count) const;
  std::int64_t clock() const { return clock_ns_ ? clock_ns_() : 0; }

  CallbackQueues& queues_;
  double rate_Hz_;
  int channels_;
  int delay_;  // frames between rendering and output
  bool silent_;
  sync::LatePolicy late_;
  Scheduler scheduler_{512};
  std::int64_t newest_scene_;  // newest scene of the strikes that were taken out of the queue
  Voices voices_;
  Scrapes scrapes_;
  RecordingPlayer recordings_;
  std::int64_t (*clock_ns_)();
  std::optional<Scrape> next_scrape_;  // taken from the queue, not yet due
  std::int64_t scrapes_taken_;         // number of scrapes taken from the queue, including previous renderers
  Dropout dropout_;
  std::array<float, kMaxBlock> open_{};  // factors of the drop-out on the current samples
  Limiter limiter_;
  LevelLimiter level_limiter_;
  EdgeFade edge_;
  std::optional<sync::HostTime> next_first_;  // presentation of the next block, without an interruption
  sync::QualityLadder ladder_;
  int fixed_quality_ = -1;
  int last_frames_ = 0;        // of the previous block
  int frames_ = 0;             // rendered frames that are not yet passed to the quality ladder
  sync::Nanoseconds render_time_{0};  // rendering time of those frames
};

}  // namespace tactus::audio
