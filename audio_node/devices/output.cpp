#include "audio_node/devices/output.h"

#include <cmath>
#include <exception>
#include <tactus/presentation_t.hpp>
#include <utility>

#include "audio_node/signal/sound_dose.h"
#include "audio_node/spatial/space_of.h"
#include "sync/clocks/pacing.h"
#include "sync/text/error_text.h"

namespace tactus::audio {
namespace {

// A card that has not started by then is reported; USB cards take about a second.
constexpr sync::Nanoseconds kStartTimeout{5'000'000'000};

// One until the next callback, one more for a card of normal priority.
constexpr int kCallbackPeriods = 2;
constexpr std::size_t kMaxDroppedReports = 1024;

bool same_stream(const Settings& a, const Settings& b) {
  return a.device == b.device && a.sample_rate_Hz == b.sample_rate_Hz && a.period_frames == b.period_frames &&
         a.latency_periods == b.latency_periods && a.limiter_ceiling == b.limiter_ceiling &&
         a.full_scale_level_dB == b.full_scale_level_dB && a.level_limit_dB == b.level_limit_dB &&
         a.late_limit_s == b.late_limit_s && a.instructions == b.instructions && a.spatial == b.spatial &&
         a.hrtf_file == b.hrtf_file && a.layout_file == b.layout_file;
}

// Instructions that this machine lacks are reported by the caller; the widest are used instead.
Instructions instructions_of(const Settings& settings) {
  return find_instructions(settings.instructions).value_or(available_instructions().back());
}

}  // namespace

Output::Output(std::string folder, std::string device, int fifo_priority, OpenCard open, bool silent)
    : folder_(std::move(folder)),
      device_(std::move(device)),
      fifo_priority_(fifo_priority),
      queues_(std::make_shared<CallbackQueues>()),
      strikes_(*queues_),
      scrapes_(*queues_),
      recorded_contacts_(queues_->recorded.contacts),
      library_(queues_->recorded),
      open_(std::move(open)),
      silent_(silent) {}

void Output::configure(Settings settings) {
  if (!device_.empty()) settings.device = device_;
  if (stream_ && !same_stream(settings, settings_)) close();
  settings_ = std::move(settings);
  retry_at_ = {};
  library_.configure(settings_);
}

bool Output::keep_open(sync::HostTime now) {
  strikes_.free_released();
  if (stream_ && stream_->alive(now)) {
    scrapes_.send_ends();
    recorded_contacts_.send_ends();
    stream_->play_until(now);
    return true;
  }
  if (stream_) {
    error_text_ = "the sound card \"" + stream_->card() + "\" is lost";
    close();
  }
  if (opening_)
    finish_opening(now);
  else if (now >= retry_at_)
    start_opening(now);
  return stream_ != nullptr;
}

void Output::start_opening(sync::HostTime now) {
  opening_since_ = now;
  opened_with_ = settings_;
  sent_command_.reset();
  sent_listener_.reset();
  if (open_) return use_stream(*open(settings_, folder_, fifo_priority_, queues_, open_, silent_, spent_Pa2_s_));
  opening_.emplace([settings = settings_, folder = folder_, priority = fifo_priority_, queues = queues_, silent = silent_,
                    spent = spent_Pa2_s_] { return open(settings, folder, priority, queues, {}, silent, spent); });
}

std::unique_ptr<Output::Opened> Output::open(const Settings& settings, const std::string& folder, int priority,
                                             const std::shared_ptr<CallbackQueues>& queues, const OpenCard& open, bool silent,
                                             double spent_Pa2_s) {
  RendererDef def;
  def.rate_Hz = settings.sample_rate_Hz;
  def.period_frames = settings.period_frames;
  def.ceiling = settings.limiter_ceiling;
  def.level_limit = {.full_scale_dB = settings.full_scale_level_dB, .limit_dB = settings.level_limit_dB, .spent_Pa2_s = spent_Pa2_s};
  def.late = late_policy(settings.sample_rate_Hz, sync::from_seconds(settings.late_limit_s));
  def.instructions = instructions_of(settings);
  // reading an HRTF takes a third of a second
  if (!silent) def.space = space_of(settings, settings.sample_rate_Hz);
  def.silent = silent;
  def.clock_ns = [] { return sync::to_ns(sync::host_now()); };
  const auto renderer = std::make_shared<Renderer>(*queues, def);
  const StreamOptions options{settings.device,
                              static_cast<int>(settings.sample_rate_Hz),
                              settings.period_frames,
                              settings.latency_periods,
                              folder,
                              priority,
                              renderer->channels()};
  const Card::Render render = [queues, renderer](float* out, int frames, const BlockTime& time) {
    renderer->render(out, frames, time);
  };
  auto card = open ? open(options, render) : std::make_unique<Stream>(options, render);
  return std::make_unique<Opened>(Opened{renderer, std::move(card)});
}

void Output::use_stream(Opened& opened) {
  renderer_ = std::move(opened.renderer);
  stream_ = std::move(opened.card);
  medium_ = stream_->medium();
  error_text_.clear();
}

void Output::finish_opening(sync::HostTime now) {
  if (!opening_->done()) {
    if (now - opening_since_ > kStartTimeout)
      error_text_ = "the sound card \"" + opened_with_.device +
                 "\" does not start; choose another --audio-device or \"virtual\"";
    return;
  }
  try {
    use_stream(*opening_->take());
    // The scene may have selected another card meanwhile.
    if (!same_stream(opened_with_, settings_)) close();
  } catch (const std::exception& e) {
    error_text_ = sync::error_text(e);
    retry_at_ = now + sync::from_seconds(settings_.retry_after_s);
  }
  opening_.reset();
}

void Output::close() {
  const std::int64_t callbacks = stream_->callbacks(), underflows = stream_->underflows();
  stream_.reset();
  renderer_->abandon();
  spent_Pa2_s_ = renderer_->spent_Pa2_s();
  past_callbacks_ += callbacks, past_underflows_ += underflows;
}

void Output::degrade(const DropoutDef& dropout) {
  const RenderCommand command{dropout, settings_.quality == "auto" ? -1 : std::stoi(settings_.quality)};
  if (sent_command_ != command && queues_->commands.push(command)) sent_command_ = command;
}

void Output::set_listener(const Eigen::Isometry3d& listener) {
  const Listener now{listener, static_cast<float>(settings_.nearest_m)};
  if (stream_ && sent_listener_ != now && queues_->listeners.push(now)) sent_listener_ = now;
}

void Output::submit(const Strike& strike, const StrikeQueue::Table& table) {
  if (!stream_ || !strikes_.submit(strike, table)) drop(strike.event_id, strike.scheduled);
}

void Output::drop(std::int64_t event_id, sync::HostTime scheduled) {
  if (dropped_reports_.size() >= kMaxDroppedReports) {
    ++reports_lost_;
    return;
  }
  presentation_t report{};
  report.event_id = event_id;
  report.part = presentation_t::WHOLE;
  report.scheduled_ns = sync::to_ns(scheduled);
  report.presented_ns = -1;
  report.outcome = presentation_t::DROPPED_LATE;
  dropped_reports_.push_back(report);
}

sync::Nanoseconds Output::latency() const {
  const double periods = settings_.latency_periods + kCallbackPeriods;
  const int ears = settings_.spatial == "hrtf" ? kMaxEarsLatency : 0;
  return sync::from_seconds((periods * settings_.period_frames + ears + Limiter::kDelay) /
                            settings_.sample_rate_Hz);
}

// An update waits until the first callback after its sample has been reached. Two of the updates allow for ticks
// at uneven intervals.
sync::Nanoseconds Output::update_interval(sync::Nanoseconds lead) const {
  const auto period = sync::from_seconds(settings_.period_frames / settings_.sample_rate_Hz);
  return (latency() + lead + period) / (kMaxQueuedUpdates - 2);
}

std::optional<presentation_t> Output::next_report() {
  presentation_t report;
  if (!dropped_reports_.empty()) {
    report = dropped_reports_.front();
    dropped_reports_.pop_front();
    return report;
  }
  if (!queues_->reports.pop(report)) return std::nullopt;
  return report;
}

std::optional<std::string> Output::take_status_change() {
  std::string now = stream_ ? "plays on " + stream_->card() + " into " + medium_ + recording_fault() + latency_warning() : error_text_;
  if (now == reported_status_) return std::nullopt;
  return reported_status_ = std::move(now);
}

std::string Output::status_text() const {
  if (!stream_) return (error_text_.empty() ? "sound card not opened yet" : error_text_) + loss_text();
  return stream_->card() + " at " + std::to_string(static_cast<int>(settings_.sample_rate_Hz)) + " Hz, " +
         std::to_string(settings_.period_frames) + " frames, " + std::to_string(stream_->underflows()) +
         " underflows" + cost_text() + exposure_text() + loss_text() + recording_fault() + latency_warning();
}

std::string Output::recording_fault() const {
  const std::string fault = stream_->recording_fault();
  return fault.empty() ? "" : "; " + fault;
}

std::string Output::latency_warning() const {
  if (!delay_ || latency() <= *delay_ + sync::from_seconds(settings_.late_limit_s)) return "";
  return ", too slowly for the delay of sound: most impacts are dropped as late; decrease period_frames or "
         "latency_periods, or increase the delay";
}

std::string Output::loss_text() const {
  std::string text;
  if (const std::int64_t states = scrapes_.lost() + recorded_contacts_.lost(); states > 0)
    text += ", " + std::to_string(states) + " contact updates lost";
  const std::int64_t reports = reports_lost_ + queues_->reports_lost.load(std::memory_order_relaxed);
  if (reports > 0) text += ", " + std::to_string(reports) + " reports of hits lost";
  return text;
}

std::string Output::cost_text() const {
  std::string text;
  for (std::size_t i = 0; i < queues_->costs.size(); ++i) {
    const std::int64_t contacts = queues_->costs[i].contacts.load(std::memory_order_relaxed);
    if (contacts == 0) continue;
    const double us = 1e-3 * static_cast<double>(queues_->costs[i].ns.load(std::memory_order_relaxed)) /
                      static_cast<double>(contacts);
    text +=
        std::string(", ") + (i == 0 ? "modal " : "samples ") + std::to_string(std::lround(us)) + " us a contact";
  }
  return text;
}

std::string Output::exposure_text() const {
  const ExposureMeter& meter = queues_->exposure;
  const double exposure = meter.exposure_Pa2_s.load(std::memory_order_relaxed);
  std::string text = dose_text(sound_dose_days(exposure, settings_.weekly_level_dB));
  const long down_dB = std::lround(-20 * std::log10(meter.gain.load(std::memory_order_relaxed)));
  if (down_dB > 0) text += ", reduced by " + std::to_string(down_dB) + " dB to limit the level";
  return text;
}

}  // namespace tactus::audio
