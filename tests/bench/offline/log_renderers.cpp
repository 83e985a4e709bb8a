// Rendering of a log by the libraries of audio_node, visual_node and thermal_node on a manual clock.
#include "tests/bench/offline/log_renderers.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "audio_node/excitation/impact.h"
#include "audio_node/mixer/renderer.h"
#include "sync/resampling/contact_stream.h"
#include "sync/bus/decode.h"
#include "sync/log/log_reader.h"
#include "tests/bench/offline/offline_world.h"
#include "tests/thermal_node/support/node_config.h"
#include "thermal_node/rendering/renderer.h"
#include "thermal_node/display/ticks.h"
#include "visual_node/frame/frame_composer.h"

namespace tactus::bench {
namespace {

constexpr int kFrames = 128;  // block size
constexpr double kRate_Hz = 48000;
constexpr double kAloneBefore_s = 0.060, kAloneAfter_s = 0.025;  // as tests/measure/measure_onsets

double seconds(std::int64_t host_ns) { return static_cast<double>(host_ns - kWorldBegins_ns) * 1e-9; }

class Sound {
 public:
  explicit Sound(const scene_t& scene) : stream_(sync::OwnClock(kRun, kClock)) {
    sync::apply_settings(settings_, audio::setting_fields(), "audio_node", scene.settings,
                         std::vector<std::string>{});
    impacts_ = std::make_unique<audio::Impacts>(
        scene, [](std::int64_t) -> std::optional<audio::Extent> { return std::nullopt; }, settings_, kRate_Hz, 1);
    delay_ = sync::from_seconds(settings_.presentation_delay_s);
  }
  sync::ContactStream& stream() { return stream_; }
  double delay_s() const { return settings_.presentation_delay_s; }
  // Renders up to a host time.
  void run(sync::HostTime until, Rendered& out) {
    for (;;) {
      const auto first = sync::host_time(kWorldBegins_ns +
                                         std::llround(static_cast<double>(out.samples.size()) * 1e9 / kRate_Hz));
      if (first + sync::from_seconds(kFrames / kRate_Hz) > until) return;
      for (const contact_event_t& e : stream_.take_events(world_map().to_sim(until))) {
        out.events.push_back(e);
        if (e.kind != contact_event_t::HIT) continue;
        ++out.audio.expected;
        due_[e.event_id] = e.time_ns;
        crossing_.strikes.push(impacts_->strike(e, world_map().to_host(sync::sim_time(e.time_ns)) + delay_));
      }
      std::vector<float> block(2 * kFrames);
      renderer_->render(block.data(), kFrames, {first, sync::Nanoseconds(1000), sync::Nanoseconds(0)});
      for (int n = 0; n < kFrames; ++n) out.samples.push_back(block[2 * static_cast<std::size_t>(n)]);
      for (presentation_t r; crossing_.reports.pop(r);) {
        if (r.presented_ns < 0) continue;
        ++out.audio.presented;
        out.audio.error_s.push_back(seconds(r.presented_ns) - 1e-9 * static_cast<double>(due_[r.event_id]) -
                                    delay_s());
      }
    }
  }

 private:
  audio::Settings settings_;
  std::unique_ptr<audio::Impacts> impacts_;
  sync::Nanoseconds delay_{0};
  audio::CallbackQueues crossing_;
  std::unique_ptr<audio::Renderer> renderer_ = std::make_unique<audio::Renderer>(crossing_, audio::RendererDef{});
  sync::ContactStream stream_;
  std::map<std::int64_t, std::int64_t> due_;
};

// The first sample that leaves the preceding level by 2 % of the loudest one near it, where one stands out.
void find_onsets(Rendered& out, double delay_s) {
  std::vector<std::pair<double, std::int64_t>> hits;
  for (const contact_event_t& e : out.events)
    if (e.kind == contact_event_t::HIT) hits.emplace_back(1e-9 * static_cast<double>(e.time_ns), e.event_id);
  std::sort(hits.begin(), hits.end());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto [t, id] = hits[i];
    if (i > 0 && t - hits[i - 1].first < kAloneBefore_s) continue;
    if (i + 1 < hits.size() && hits[i + 1].first - t < kAloneAfter_s) continue;
    const double at = (t + delay_s) * kRate_Hz;
    const auto quiet = static_cast<std::ptrdiff_t>(at - 0.030 * kRate_Hz),
               begin = static_cast<std::ptrdiff_t>(at - 0.018 * kRate_Hz),
               end = static_cast<std::ptrdiff_t>(at + 0.025 * kRate_Hz);
    if (quiet < 0 || end >= static_cast<std::ptrdiff_t>(out.samples.size())) continue;
    const auto max_level = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
      float loudest = 0;
      for (auto n = from; n < to; ++n)
        loudest = std::max(loudest, std::abs(out.samples[static_cast<std::size_t>(n)]));
      return loudest;
    };
    const float level = max_level(quiet, begin) + 1e-5f, near = max_level(begin, end);
    if (near < 4 * level) continue;
    auto n = begin;
    while (std::abs(out.samples[static_cast<std::size_t>(n)]) <= 1.5f * level + 0.02f * near) ++n;
    out.onset_s[id] = static_cast<double>(n) / kRate_Hz - delay_s;
  }
}

class Pictures {
 public:
  explicit Pictures(const scene_t& scene) : composer_(sync::OwnClock(kRun, kClock), settings_) {
    composer_.load(scene, {}, settings_);
  }
  visual::FrameComposer& composer() { return composer_; }
  void run(sync::HostTime until, Rendered& out) {
    for (; next() <= until; ++number_) {
      // 3 ms for the surfaces and 1 ms for the flashes, as a software renderer takes.
      const sync::HostTime now = next();
      visual::Frame frame = composer_.frame(now, number_);
      composer_.latch(frame, now + sync::Nanoseconds(3'000'000));
      for (const presentation_t& r : composer_.presented(now + sync::Nanoseconds(4'000'000))) {
        if (r.presented_ns < 0) continue;
        ++out.visual.presented;
        shown_[r.event_id] = seconds(r.presented_ns);
      }
    }
  }
  void finish(Rendered& out) const {
    for (const contact_event_t& e : out.events) {
      if (!visual::is_expected(e)) continue;
      ++out.visual.expected;
      if (const auto at = shown_.find(e.event_id); at != shown_.end())
        out.visual.error_s.push_back(at->second - 1e-9 * static_cast<double>(e.time_ns));
    }
  }

 private:
  sync::HostTime next() const { return sync::host_time(kWorldBegins_ns + number_ * 1'000'000'000 / 60); }
  visual::Settings settings_;
  visual::FrameComposer composer_;
  std::int64_t number_ = 1;
  std::map<std::int64_t, double> shown_;
};

class Warmth {
 public:
  explicit Warmth(const scene_t& scene)
      : choice_(thermal::resolve_config(scene, "", {})), stream_(sync::OwnClock(kRun, kClock)) {
    if (choice_.tool >= 0)
      renderer_ =
          std::make_unique<thermal::Renderer>(choice_.settings, scene.materials, choice_.tool, choice_.tool_body);
  }
  sync::ContactStream& stream() { return stream_; }
  int tool() const { return choice_.tool; }
  void run(sync::HostTime until, sync::HostTime newest, Rendered& out) {
    const auto period = sync::from_seconds(1 / choice_.settings.rate_Hz);
    for (; renderer_ && next_ <= until; next_ += period) {
      const thermal::Tick tick = ticks_.next(stream_, next_, newest, choice_.tool, choice_.tool_body);
      for (const contact_event_t& e : tick.events) due_[e.event_id] = e.time_ns;
      renderer_->step(tick);
      for (const presentation_t& r : renderer_->reports()) {
        if (r.presented_ns < 0) continue;
        ++out.thermal.presented;
        out.thermal.error_s.push_back(seconds(r.presented_ns) - 1e-9 * static_cast<double>(due_[r.event_id]));
      }
    }
  }

 private:
  thermal::NodeConfig choice_;
  sync::ContactStream stream_;
  thermal::Ticks ticks_;
  std::unique_ptr<thermal::Renderer> renderer_;
  sync::HostTime next_ = sync::host_time(kWorldBegins_ns);
  std::map<std::int64_t, std::int64_t> due_;
};

}  // namespace

Rendered render_log(const scene_t& scene, std::span<const std::uint8_t> log) {
  Rendered out;
  Sound sound(scene);
  Pictures pictures(scene);
  Warmth warmth(scene);
  sync::LogScanner scanner(log);
  sync::HostTime now{};
  for (sync::LogEvent e; scanner.next(e);) {
    const sync::HostTime arrival = sync::host_time(e.timestamp_us * 1000);
    if (arrival != now) {
      sound.run(now, out);
      pictures.run(now, out);
      warmth.run(now, now, out);
      now = arrival;
    }
    if (e.channel == channels::kContactEvents) {
      if (const auto m = sync::decode<contact_events_t>(e.data.data(), e.data.size())) {
        sound.stream().push(*m, now);
        warmth.stream().push(*m, now);
        pictures.composer().push(*m, now);
      }
    } else if (e.channel == channels::kContacts) {
      if (const auto m = sync::decode<contact_frame_t>(e.data.data(), e.data.size())) {
        sound.stream().push(*m, now);
        warmth.stream().push(*m, now);
      }
    } else if (e.channel == channels::kWorldState) {
      if (const auto m = sync::decode<world_state_t>(e.data.data(), e.data.size()))
        pictures.composer().push(*m, now);
    } else if (e.channel == channels::kToolState) {
      if (const auto m = sync::decode<tool_state_t>(e.data.data(), e.data.size()))
        pictures.composer().push(*m, now);
    }
  }
  pictures.finish(out);
  for (const contact_event_t& e : out.events)
    out.thermal.expected += e.tool == warmth.tool() && e.tool >= 0 && e.kind != contact_event_t::END;
  find_onsets(out, sound.delay_s());
  return out;
}

}  // namespace tactus::bench
