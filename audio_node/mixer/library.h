// The database of recordings in use: read in a thread of its own, and kept as long as the callback may play it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "audio_node/samples/database.h"
#include "audio_node/mixer/recorded.h"
#include "audio_node/settings.gen.h"
#include "sync/node/background_task.h"

namespace tactus::audio {

// The folder that the setting `sounds` means.
std::string sounds_folder(const std::string& setting);

// Of the loop's thread, which never waits for it.
class Library {
 public:
  using Shared = std::shared_ptr<const Database>;

  explicit Library(RecordedQueues& crossing) : crossing_(crossing) {}

  // Begins to read when the method needs recordings and folder, rate or size are others than before. One that
  // needs none gives back what there is.
  void configure(const Settings& settings);
  // Once a tick. Those of before that nobody plays any more: freeing them may take milliseconds, not in a loop.
  // heard: there is a callback, or one is being made; false: nobody plays any.
  std::vector<Shared> step(bool heard = true);

  // Null: none has been read yet, and none is needed or it is being read.
  const Database* database() const { return now_.get(); }
  // A database is on its way. Who renders without a clock steps until it is there.
  bool reading() const { return opening_ || (wanted_ && wanted_ != read_); }
  // What whatever crosses with it carries.
  std::int64_t number() const { return told_; }
  // A sentence for people about each database that was read, once.
  std::vector<std::string> news() { return std::exchange(news_, {}); }

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
  void take_read(std::vector<Shared>& unread);
  void use(Shared database);
  bool tell(Shared next);

  RecordedQueues& crossing_;
  std::optional<Source> wanted_, reading_, read_;
  std::optional<sync::BackgroundTask<Database>> opening_;
  Shared now_, next_;
  std::int64_t told_ = 0;  // number of `now_`
  std::deque<Kept> kept_;
  std::vector<std::string> news_;
};

}  // namespace tactus::audio
