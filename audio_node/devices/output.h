// The output of the node: a stream with its renderer, opened again when it is lost.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "audio_node/devices/stream.h"
#include "audio_node/mixer/library.h"
#include "audio_node/samples/rub_line.h"
#include "audio_node/mixer/scrape_line.h"
#include "audio_node/mixer/strike_line.h"
#include "audio_node/settings.gen.h"
#include "sync/node/background_task.h"

namespace tactus::audio {

class Output {
 public:
  // device: replaces the setting of that name unless empty. open: what it plays on instead of a sound card; opened
  // at once, and what it throws leaves keep_open(). silent: what it plays is not computed, only told of.
  Output(std::string folder, std::string device, int fifo_priority, OpenCard open = {}, bool silent = false);

  // What a scene or the command line says. A change of card, rate or period closes the stream; so does one of the
  // limits.
  void configure(Settings settings);
  // Once a tick: opens the stream, in a thread of its own, when there is none and it is time; closes it when it is
  // dead. True when it plays.
  bool keep_open(sync::HostTime now);

  // Once a tick: how long after its event a sound is due. A card that takes so much longer that every blow would be
  // dropped is told of in note() and news().
  void allow(sync::Nanoseconds delay) { delay_ = delay; }
  // Once a tick: what is wrong with the output on purpose.
  void degrade(const DropoutDef& dropout);

  // When nothing plays or the queue is full the strike will never sound, and is reported as dropped. table: what it refers
  // to; it is kept as long as the callback may read it.
  void submit(const Strike& strike, const StrikeLine::Table& table = nullptr);
  // One that is never made: it is reported as dropped.
  void drop(std::int64_t event_id, sync::HostTime scheduled);
  // Scrapes from now on are of these surfaces; null: of none. It keeps those before as long as the callback may
  // read them.
  void hear(std::shared_ptr<const HeardSurfaces> surfaces) { scrapes_.change(std::move(surfaces)); }
  // Those that it need not keep any more. Freeing them may take milliseconds: not in a loop.
  std::vector<std::shared_ptr<const HeardSurfaces>> take_unread() { return scrapes_.take_unread(); }
  // Where the ear is, from now on, and how near a source may come.
  void hear_from(const Eigen::Isometry3d& listener);
  // A state that does not fit is not heard, the next one is; note() counts it. An end is told later.
  void submit(const Scrape& scrape) {
    if (stream_ && !silent_) scrapes_.submit(scrape);
  }
  void submit(const RecordedContact& rub) {
    if (stream_ && !silent_) rubs_.submit(rub);
  }
  // How often contacts may be told so that all fit that wait for their sample, latency() and `lead` later.
  sync::Nanoseconds tell_every(sync::Nanoseconds lead) const;
  // The recordings that are played. What crosses must be of its newest database.
  Library& library() { return library_; }
  // Once a tick: its step(), which knows whether a callback may play any.
  std::vector<Library::Shared> step_library() { return library_.step(stream_ || opening_); }
  std::optional<presentation_t> next_report();
  std::optional<MediaPair> next_pair() { return stream_ ? stream_->next_pair() : std::nullopt; }

  // One line for people: what it plays on, or why it does not.
  std::string note() const;
  // The same once, whenever it plays on another card or has another reason not to.
  std::optional<std::string> news();
  const std::string& medium() const { return medium_; }
  // Since the start, over all streams.
  std::int64_t callbacks() const { return past_callbacks_ + (stream_ ? stream_->callbacks() : 0); }
  std::int64_t underflows() const { return past_underflows_ + (stream_ ? stream_->underflows() : 0); }
  // From the arrival of an event to the sample that it may start on, at the most: the callback's turn, what the
  // card holds, and the limiter.
  sync::Nanoseconds latency() const;
  double callback_rate_Hz() const { return settings_.sample_rate_Hz / settings_.period_frames; }
  const Settings& settings() const { return settings_; }
  // What each way of making sound costs a contact, in words; empty while nothing has sounded.
  std::string costs() const;
  // What ears have had, and by how much it is turned down for them, in words; empty while nothing has sounded.
  std::string hearing() const;
  // Of a card that is too slow for its delay, in words; empty: it is not.
  std::string too_slow() const;
  // What did not fit, in words; empty while nothing has been lost.
  std::string losses() const;
  // Step of the quality ladder in use.
  int quality() const { return crossing_->quality.load(std::memory_order_relaxed); }

 private:
  void begin_to_open(sync::HostTime now);
  void end_opening(sync::HostTime now);
  void close();

  std::string folder_, device_;
  int fifo_priority_;
  Settings settings_, opened_with_;
  std::string trouble_, medium_, told_;
  std::optional<sync::Nanoseconds> delay_;
  sync::HostTime retry_at_{}, opening_since_{};
  std::int64_t past_callbacks_ = 0, past_underflows_ = 0;
  // The stream's callback owns its share of both.
  std::shared_ptr<CallbackQueues> crossing_;
  std::shared_ptr<Renderer> renderer_;
  StrikeLine strikes_;  // goes after the stream, whose callback reads what it keeps; so do the next three
  ScrapeLine scrapes_;
  RubLine rubs_;
  Library library_;
  std::optional<RenderCommand> ordered_;       // what the renderer has been told; nothing: it is new
  std::optional<Listener> heard_from_;  // likewise
  OpenCard open_;                       // none: a Stream
  bool silent_;
  // A card and what renders for it.
  struct Opened {
    std::shared_ptr<Renderer> renderer;
    std::unique_ptr<Card> card;
  };
  static std::unique_ptr<Opened> open(const Settings& settings, const std::string& folder, int priority,
                                      const std::shared_ptr<CallbackQueues>& crossing, const OpenCard& open, bool silent);
  void take(Opened& opened);
  std::optional<sync::BackgroundTask<Opened>> opening_;
  std::unique_ptr<Card> stream_;
  std::deque<presentation_t> unsounded_;
  std::int64_t reports_lost_ = 0;
};

}  // namespace tactus::audio
