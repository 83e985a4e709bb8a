// The database of recordings in use: read on a background thread, and kept while the callback may play it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "audio_node/samples/database.h"
#include "audio_node/mixer/recording_player.h"
#include "audio_node/settings.gen.h"
#include "sync/node/background_task.h"

namespace tactus::audio {

// The folder of the setting `sounds`.
std::string sounds_folder(const std::string& setting);

// Used on the thread of the loop, which never waits for it.
class Library {
 public:
  using Shared = std::shared_ptr<const Database>;

  explicit Library(RecordedQueues& queues) : queues_(queues) {}

  // Begins to read when the method needs recordings and folder, rate or size have changed. A method without
  // recordings releases the database.
  void configure(const Settings& settings);
  // Call once per tick. Returns previous databases that are no longer in use: freeing them may take milliseconds,
  // so do not free them in the loop. has_callback: a callback exists or is being opened; false: no database
  // is in use.
  std::vector<Shared> step(bool has_callback = true);

  // Returns null while no database has been read: none is needed, or it is being read.
  const Database* database() const { return now_.get(); }
  // True while a database is being read. A renderer without a clock repeats step() until it is ready.
  bool reading() const { return opening_ || (requested_ && requested_ != read_); }
  // Number that all queued commands of this database carry.
  std::int64_t number() const { return number_; }
  // A message about each database that was read, once.
  std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

 private:
  struct Source {
    std::string folder;
    double rate_Hz = 0, size_m = 0;
    bool operator==(const Source&) const = default;
  };
  struct Kept {
    std::int64_t number;
    Shared database;
  };
  void receive_database(std::vector<Shared>& released);
  void set_next(Shared database);
  bool publish_database(Shared next);

  RecordedQueues& queues_;
  std::optional<Source> requested_, reading_, read_;
  std::optional<sync::BackgroundTask<Database>> opening_;
  Shared now_, next_;
  std::int64_t number_ = 0;  // number of `now_`
  std::deque<Kept> kept_;
  std::vector<std::string> messages_;
};

}  // namespace tactus::audio
