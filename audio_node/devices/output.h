// The audio output of the node: a stream with its renderer, reopened when it is lost.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "audio_node/devices/stream.h"
#include "audio_node/mixer/library.h"
#include "audio_node/samples/recorded_contact_queue.h"
#include "audio_node/mixer/scrape_queue.h"
#include "audio_node/mixer/strike_queue.h"
#include "audio_node/settings.gen.h"
#include "sync/node/background_task.h"

namespace tactus::audio {

class Output {
 public:
  // device: replaces the setting of that name unless empty. open: opens another card than a sound card; it is
  // called in keep_open(), which passes on its exceptions. silent: computes no samples, only reports.
  Output(std::string folder, std::string device, int fifo_priority, OpenCard open = {}, bool silent = false);

  // Applies the settings. A change of card, rate, period or a limit closes the stream.
  void configure(Settings settings);
  // Call once per tick: opens the stream on a background thread when there is none and it is time; closes it when
  // it is dead. True when it plays.
  bool keep_open(sync::HostTime now);

  // Call once per tick with the delay of sound after its event. status_text() and
  // take_status_change() report a card whose latency is so much longer that every impact would be dropped.
  void set_presentation_delay(sync::Nanoseconds delay) { delay_ = delay; }
  // Call once per tick with the degradation of the output by a profile.
  void degrade(const DropoutDef& dropout);

  // When nothing plays or the queue is full the strike is reported as dropped. table: the modes that the strike refers to;
  // they are kept as long as the callback may read them.
  void submit(const Strike& strike, const StrikeQueue::Table& table = nullptr);
  // Reports a hit as dropped without a strike.
  void drop(std::int64_t event_id, sync::HostTime scheduled);
  // Later scrapes use these surfaces; null: none. The previous surfaces are kept while the callback may read
  // them.
  void set_surfaces(std::shared_ptr<const AudioSurfaces> surfaces) { scrapes_.set_surfaces(std::move(surfaces)); }
  // Returns surfaces that are no longer needed. Freeing them may take milliseconds, so do not free them in the
  // loop.
  std::vector<std::shared_ptr<const AudioSurfaces>> take_released() { return scrapes_.take_released(); }
  // Pose of the listener from now on; sources count as at least nearest_m away.
  void set_listener(const Eigen::Isometry3d& listener);
  // A state that does not fit is skipped until the next one, and status_text() counts it. An end is sent later.
  void submit(const Scrape& scrape) {
    if (stream_ && !silent_) scrapes_.submit(scrape);
  }
  void submit(const RecordedContact& contact) {
    if (stream_ && !silent_) recorded_contacts_.submit(contact);
  }
  // Shortest interval of contact updates at which all waiting updates fit into the queue; each waits for latency()
  // and `lead`.
  sync::Nanoseconds update_interval(sync::Nanoseconds lead) const;
  // The recordings in use. Queued commands must refer to its newest database.
  Library& library() { return library_; }
  // Call once per tick: Library::step(), with the information whether a callback may play recordings.
  std::vector<Library::Shared> step_library() { return library_.step(stream_ || opening_); }
  std::optional<presentation_t> next_report();
  std::optional<MediaPair> next_pair() { return stream_ ? stream_->next_pair() : std::nullopt; }

  // True while the first attempt to open a card has neither succeeded nor failed; bounded by 5 s.
  bool opening() const { return !stream_ && error_text_.empty(); }

  // One line of status: the card in use, or the reason why nothing plays.
  std::string status_text() const;
  // The same line once after each change of the card or the reason.
  std::optional<std::string> take_status_change();
  const std::string& medium() const { return medium_; }
  // Since the start, over all streams.
  std::int64_t callbacks() const { return past_callbacks_ + (stream_ ? stream_->callbacks() : 0); }
  std::int64_t underflows() const { return past_underflows_ + (stream_ ? stream_->underflows() : 0); }
  // Upper bound of the time from the arrival of an event to its earliest sample: the next callback, the buffer of
  // the card, and the limiter.
  sync::Nanoseconds latency() const;
  double callback_rate_Hz() const { return settings_.sample_rate_Hz / settings_.period_frames; }
  const Settings& settings() const { return settings_; }
  // Text with the cost of each method per contact; empty while nothing has sounded.
  std::string cost_text() const;
  // Text with the sound dose and the current gain reduction; empty while nothing has sounded.
  std::string exposure_text() const;
  // Text about a card that is too slow for its delay; otherwise empty.
  std::string latency_warning() const;
  std::string recording_fault() const;  // only with a stream
  // Text about lost updates and reports; empty if there are none.
  std::string loss_text() const;
  // Step of the quality ladder in use.
  int quality() const { return queues_->quality.load(std::memory_order_relaxed); }

 private:
  void start_opening(sync::HostTime now);
  void finish_opening(sync::HostTime now);
  void close();

  std::string folder_, device_;
  int fifo_priority_;
  Settings settings_, opened_with_;
  std::string error_text_, medium_, reported_status_;
  std::optional<sync::Nanoseconds> delay_;
  sync::HostTime retry_at_{}, opening_since_{};
  std::int64_t past_callbacks_ = 0, past_underflows_ = 0;
  // The callback of the stream shares the ownership of both.
  std::shared_ptr<CallbackQueues> queues_;
  std::shared_ptr<Renderer> renderer_;
  double spent_Pa2_s_ = 0;  // of the previous renderer's level limit
  StrikeQueue strikes_;  // outlives the stream, whose callback reads its data; so do the next three
  ScrapeQueue scrapes_;
  RecordedContactQueue recorded_contacts_;
  Library library_;
  std::optional<RenderCommand> sent_command_;       // last command in the queue; empty: new renderer
  std::optional<Listener> sent_listener_;  // last listener in the queue
  OpenCard open_;                       // none: a Stream
  bool silent_;
  // A card and its renderer.
  struct Opened {
    std::shared_ptr<Renderer> renderer;
    std::unique_ptr<Card> card;
  };
  static std::unique_ptr<Opened> open(const Settings& settings, const std::string& folder, int priority,
                                      const std::shared_ptr<CallbackQueues>& queues, const OpenCard& open, bool silent,
                                      double spent_Pa2_s);
  void use_stream(Opened& opened);
  std::optional<sync::BackgroundTask<Opened>> opening_;
  std::unique_ptr<Card> stream_;
  std::deque<presentation_t> dropped_reports_;
  std::int64_t reports_lost_ = 0;
};

}  // namespace tactus::audio
